// relievo animation/clip_clock: generated from kernels/animation/clip_clock.wgsl

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

struct Lod {
    omega: u32,
    allowed: u32,
    weight: u32,
    flags: u32
}

const LOD_HIDDEN: u32 = 1u;

const LOD_FORCED: u32 = 2u;

const OMEGA_ONE: u32 = 65536u;

const FULL_WEIGHT: u32 = 65535u;

struct ClipClock {
    row: u32,
    fraction_and_reason: u32,
    clip: u32,
    ahead_row: u32,
    ahead_fraction: u32
}

const FRACTION_ONE: u32 = 65536u;

const UPDATE_REASON_FREE: u32 = 0u;

const UPDATE_REASON_HIDDEN: u32 = 1u;

const UPDATE_REASON_FORCED: u32 = 2u;

const UPDATE_REASON_BLENDED: u32 = 3u;

fn update_reason_of(clip_clock: ClipClock) -> u32 {
    return progress_reason(clip_clock.fraction_and_reason);
}

fn is_ahead(clip_clock: ClipClock) -> bool {
    return clip_clock.ahead_row != clip_clock.row || clip_clock.ahead_fraction != fraction_of(clip_clock);
}

fn fraction_of(clip_clock: ClipClock) -> u32 {
    return progress_fraction(clip_clock.fraction_and_reason);
}

const PAIR_AHEAD: u32 = 2147483648u;

fn progress_word(fraction: u32, reason: u32) -> u32 {
    return fraction | (reason << 20u);
}

fn progress_fraction(word: u32) -> u32 {
    return word & 1048575u;
}

fn progress_reason(word: u32) -> u32 {
    return word >> 20u;
}

fn lod_flags_word(bits: u32, tier: u32) -> u32 {
    return bits | (tier << 8u);
}

fn lod_flags_bits(word: u32) -> u32 {
    return word & 255u;
}

fn lod_flags_tier(word: u32) -> u32 {
    return (word >> 8u) & 255u;
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

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

struct ClipClockParams {
    instances: u32,
    elapsed: f32,
    layers: u32,
    ahead: f32
}

@group(0) @binding(0)
var<uniform> params: ClipClockParams;

@group(0) @binding(1)
var<storage, read> instances: array<AnimationInstance>;

@group(0) @binding(2)
var<storage, read> clips: array<ClipEntry>;

@group(0) @binding(3)
var<storage, read> timelines: array<Timeline>;

@group(0) @binding(5)
var<storage, read> lods: array<Lod>;

@group(0) @binding(6)
var<storage, read> layer_weights: array<f32>;

@group(0) @binding(7)
var<storage, read_write> history: array<vec4<u32>>;

@group(0) @binding(8)
var<storage, read_write> clip_clocks: array<ClipClock>;

const BLENDED: u32 = 2147483648u;

const TIER_SHIFT: u32 = 24u;

const CLIP_HASH_FACTOR: u32 = 31u;

fn clips_above(instance: u32) -> u32 {
    var clips = 0u;
    let layers = nonuniform(params.layers, instance);
    for (var layer = 0u; layer < layers; layer++) {
        let is_heard = layer_weights[layer * params.instances + instance] > 0.0;
        let clip = instances[(layer + 1u) * params.instances + instance].clip;
        clips = CLIP_HASH_FACTOR * clips + select(0u, clip + 1u, is_heard);
    }
    return clips;
}

fn whole_fraction(cursor: KeyframeCursor) -> u32 {
    return u32(clamp(cursor.fraction, 0.0, 1.0) * f32(FRACTION_ONE));
}

fn clip_clock_of(index: u32, flags: u32) -> ClipClock {
    let instance = instances[index];
    let clip = clips[instance.clip];
    let time = inside_clip(instance.wrap_code, clip.duration, instance.start + instance.rate * params.elapsed);
    let timeline = timelines[clip.first_timeline];
    let found = keyframe_cursor(timeline, time);
    let seconds = params.elapsed + params.ahead;
    let then = inside_clip(instance.wrap_code, clip.duration, instance.start + instance.rate * seconds);
    let later = select(time, then, params.ahead != 0.0);
    let ahead = keyframe_cursor(timeline, later);
    let above = clips_above(index);
    let tier = lod_flags_tier(flags) << TIER_SHIFT;
    let base = (instance.clip + 1u) | tier | select(0u, BLENDED, above != 0u);
    let known = vec4<u32>(base, above, bitcast<u32>(time), bitcast<u32>(later));
    let last = history[index];
    var reason = UPDATE_REASON_FREE;
    if (flags & LOD_HIDDEN) != 0u {
        reason = UPDATE_REASON_HIDDEN;
        history[index] = vec4<u32>(0u);
    }
    else {
        if (flags & LOD_FORCED) != 0u || last.x != known.x || last.y != known.y {
            reason = UPDATE_REASON_FORCED;
        }
        else if above != 0u {
            reason = UPDATE_REASON_BLENDED;
        }
        history[index] = known;
    }
    let own = progress_word(whole_fraction(found), reason);
    return ClipClock(clip.first_row + found.key, own, instance.clip, clip.first_row + ahead.key, whole_fraction(ahead));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index < params.instances {
        clip_clocks[index] = clip_clock_of(index, lods[index].flags);
    }
}
