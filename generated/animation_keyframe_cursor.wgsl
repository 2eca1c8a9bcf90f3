// relievo animation/keyframe_cursor: generated from kernels/animation/keyframe_cursor.wgsl

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

override COMPACTED: bool = false;

struct KeyframeCursorParams {
    entries: u32,
    instances: u32,
    timelines: u32,
    elapsed: f32
}

@group(0) @binding(0)
var<uniform> params: KeyframeCursorParams;

@group(0) @binding(1)
var<storage, read> instances: array<AnimationInstance>;

@group(0) @binding(2)
var<storage, read> clips: array<ClipEntry>;

@group(0) @binding(3)
var<storage, read> timelines: array<Timeline>;

@group(0) @binding(5)
var<storage, read_write> cursors: array<KeyframeCursor>;

@group(0) @binding(6)
var<storage, read> updated_instances: array<u32>;

@group(0) @binding(7)
var<storage, read> dispatches: array<vec4<u32>>;

@group(0) @binding(8)
var<storage, read> history: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    let at = index / params.timelines;
    var entry = at;
    if COMPACTED {
        let layers = params.entries / params.instances + 1u;
        let listed = at / layers;
        if listed >= dispatches[0].w {
            return;
        }
        entry = updated_instances[listed] + (at - listed * layers) * params.instances;
    }
    let is_ahead = entry >= params.entries;
    if is_ahead && !COMPACTED {
        return;
    }
    let playing = select(entry, entry - params.entries, is_ahead);
    let instance = instances[playing];
    let clip = clips[instance.clip];
    let timeline_index = index - at * params.timelines;
    if timeline_index >= clip.timelines {
        return;
    }
    let timeline = timelines[clip.first_timeline + timeline_index];
    var time = inside_clip(instance.wrap_code, clip.duration, instance.start + instance.rate * params.elapsed);
    if COMPACTED && (is_ahead || entry < params.instances) {
        let seen = history[playing];
        if is_ahead && seen.w == seen.z {
            return;
        }
        time = bitcast<f32>(select(seen.z, seen.w, is_ahead));
    }
    cursors[entry * params.timelines + timeline_index] = keyframe_cursor(timeline, time);
}
