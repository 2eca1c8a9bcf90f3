// relievo skinning/morph_weights: generated from kernels/skinning/morph_weights.wgsl

struct ClipEntry {
    first_timeline: u32,
    timelines: u32,
    duration: f32,
    first_row: u32
}

struct Timeline {
    first_time: u32,
    keys: u32
}

struct KeyframeCursor {
    key: u32,
    fraction: f32
}

fn cursor_of_words(words: vec2<u32>) -> KeyframeCursor {
    return KeyframeCursor(words.x, bitcast<f32>(words.y));
}

struct SetTrack {
    words: vec2<u32>
}

const CONSTANT: u32 = 1073741823u;

fn timeline_of(track: SetTrack) -> u32 {
    return track_timeline(track.words.x);
}

fn interpolation_of(track: SetTrack) -> u32 {
    return track_interpolation(track.words.x);
}

fn first_value_of(track: SetTrack) -> u32 {
    return track.words.y;
}

fn track_word(timeline: u32, interpolation: u32) -> u32 {
    return timeline | (interpolation << 30u);
}

fn track_timeline(word: u32) -> u32 {
    return word & 1073741823u;
}

fn track_interpolation(word: u32) -> u32 {
    return word >> 30u;
}

const WRAP_CLAMP = 1u;

const MAX_TURNS: f32 = 16777216.0;

fn inside_clip(wrap: u32, duration: f32, time: f32) -> f32 {
    if duration <= 0.0 {
        return 0.0;
    }
    if wrap == WRAP_CLAMP {
        return min(max(time, 0.0), duration);
    }
    if !(abs(time) < MAX_TURNS * duration) {
        return 0.0;
    }
    var inside = time - floor(time / duration) * duration;
    if inside < 0.0 {
        inside += duration;
    }
    if inside >= duration {
        inside -= duration;
    }
    return inside;
}

struct AnimationInstance {
    clip: u32,
    wrap_code: u32,
    start: f32,
    rate: f32
}

const INTERPOLATION_STEP: u32 = 0u;

const INTERPOLATION_LINEAR: u32 = 1u;

const INTERPOLATION_SPLINE: u32 = 2u;

@group(0) @binding(4)
var<storage, read> times: array<f32>;

fn keyframe_cursor(timeline: Timeline, time: f32) -> KeyframeCursor {
    let first = timeline.first_time;
    let last = timeline.keys - 1u;
    let start = times[first];
    if time < start {
        return KeyframeCursor(0u, 0.0);
    }
    let end_time = times[first + last];
    if time >= end_time {
        return KeyframeCursor(last, 0.0);
    }
    let evenly = (time - start) / (end_time - start) * f32(last);
    var key = min(u32(evenly), last - 1u);
    var before = times[first + key];
    var after = times[first + key + 1u];
    if before > time || after <= time {
        var end = last;
        key = 0u;
        while (end - key > 1u) {
            let middle = (key + end) / 2u;
            if times[first + middle] <= time {
                key = middle;
            }
            else {
                end = middle;
            }
        }
        before = times[first + key];
        after = times[first + key + 1u];
    }
    return KeyframeCursor(key, (time - before) / (after - before));
}

struct InstanceLod {
    influence_fade: f32,
    max_influences: u32,
    mesh_lod: u32,
    tier: u32
}

const MAX_LEVELS: u32 = 16u;

struct MorphWeightsParams {
    targets: u32,
    pairs: u32,
    elapsed: f32
}

struct WeightEntry {
    duration: f32,
    first_time: u32,
    keys: u32,
    first_value: u32,
    interpolation: u32
}

@group(0) @binding(0)
var<uniform> params: MorphWeightsParams;

@group(0) @binding(1)
var<storage, read> instances: array<AnimationInstance>;

@group(0) @binding(2)
var<storage, read> entries: array<WeightEntry>;

@group(0) @binding(3)
var<storage, read> instance_lods: array<InstanceLod>;

@group(0) @binding(5)
var<storage, read> values: array<f32>;

@group(0) @binding(6)
var<storage, read_write> weights: array<f32>;

fn spline(first: u32, key: u32, t: f32, seconds: f32) -> f32 {
    let at = first + 3u * key * params.targets;
    let start = values[at + params.targets];
    let leaving = values[at + 2u * params.targets];
    let arriving = values[at + 3u * params.targets];
    let end = values[at + 4u * params.targets];
    let square = t * t;
    let cube = square * t;
    let of_end = 3.0 * square - 2.0 * cube;
    return (1.0 - of_end) * start + (cube - 2.0 * square + t) * (seconds * leaving) + of_end * end + (cube - square) * (seconds * arriving);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pair = id.y * groups.x * 64u + id.x;
    if pair >= params.pairs {
        return;
    }
    let index = pair / params.targets;
    if instance_lods[index].max_influences == 0u {
        return;
    }
    let instance = instances[index];
    let entry = entries[instance.clip];
    let time = inside_clip(instance.wrap_code, entry.duration, instance.start + instance.rate * params.elapsed);
    let found = keyframe_cursor(Timeline(entry.first_time, entry.keys), time);
    let t = found.fraction;
    let first = entry.first_value + pair - index * params.targets;
    let is_between = t > 0.0;
    var weight = 0.0;
    if entry.interpolation == INTERPOLATION_SPLINE {
        weight = values[first + (3u * found.key + 1u) * params.targets];
        if is_between {
            let at = entry.first_time + found.key;
            weight = spline(first, found.key, t, times[at + 1u] - times[at]);
        }
    }
    else {
        weight = values[first + found.key * params.targets];
        if is_between && entry.interpolation == INTERPOLATION_LINEAR {
            weight += (values[first + (found.key + 1u) * params.targets] - weight) * t;
        }
    }
    weights[pair] = weight;
}
