// relievo animation/sample: generated from kernels/animation/sample.wgsl

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

const INTERPOLATION_STEP: u32 = 0u;

const INTERPOLATION_LINEAR: u32 = 1u;

const INTERPOLATION_SPLINE: u32 = 2u;

const SLERP_REST: f32 = 1.15;

const SLERP_U = array<f32, 5>(1.0 / 3.0, 1.0 / 10.0, 1.0 / 21.0, 1.0 / 36.0, SLERP_REST / 55.0);

const SLERP_V = array<f32, 5>(1.0 / 3.0, 2.0 / 5.0, 3.0 / 7.0, 4.0 / 9.0, SLERP_REST * 5.0 / 11.0);

fn slerp_weights(t: vec2<f32>, less_one: f32) -> vec2<f32> {
    let square = t * t;
    var sum = 1.0 + (SLERP_U[4] * square - SLERP_V[4]) * less_one;
    sum = 1.0 + (SLERP_U[3] * square - SLERP_V[3]) * less_one * sum;
    sum = 1.0 + (SLERP_U[2] * square - SLERP_V[2]) * less_one * sum;
    sum = 1.0 + (SLERP_U[1] * square - SLERP_V[1]) * less_one * sum;
    sum = 1.0 + (SLERP_U[0] * square - SLERP_V[0]) * less_one * sum;
    return t * sum;
}

fn slerp(a: vec4<f32>, b: vec4<f32>, t: f32) -> vec4<f32> {
    let cosine = dot(a, b);
    let inverse = inverseSqrt(2.0 + 2.0 * cosine);
    let less_one = (1.0 + cosine) * inverse - 1.0;
    let is_first = t < 0.5;
    let way = select(2.0 - 2.0 * t, 2.0 * t, is_first);
    let weights = slerp_weights(vec2<f32>(way, 1.0 - way), less_one);
    let of_middle = weights.x * inverse;
    let of_nearer = weights.y + of_middle;
    return select(b, a, is_first) * of_nearer + select(a, b, is_first) * of_middle;
}

fn unit_quaternion(q: vec4<f32>) -> vec4<f32> {
    return q * inverseSqrt(dot(q, q));
}

override COMPACTED: bool = false;

override LAYERED: bool = false;

override NLERP: bool = false;

override SPLINES: bool = true;

struct SampleParams {
    bones: u32,
    timelines: u32,
    pairs: u32,
    instances: u32,
    layers: u32
}

@group(0) @binding(0)
var<uniform> params: SampleParams;

@group(0) @binding(1)
var<storage, read> instances: array<AnimationInstance>;

@group(0) @binding(2)
var<storage, read> tracks: array<SetTrack>;

@group(0) @binding(3)
var<storage, read> values: array<vec4<f32>>;

@group(0) @binding(4)
var<storage, read> cursors: array<vec2<u32>>;

@group(0) @binding(5)
var<storage, read> pairs: array<u32>;

@group(0) @binding(6)
var<storage, read> dispatched: vec4<u32>;

@group(0) @binding(7)
var<storage, read_write> locals: array<vec4<f32>>;

@group(0) @binding(8)
var<storage, read> layer_weights: array<f32>;

const VANISHING: f32 = 1e-12;

struct Between {
    value: u32,
    code: u32,
    fraction: f32
}

fn cursor_of(track: SetTrack, first_cursor: u32) -> KeyframeCursor {
    let timeline = timeline_of(track);
    if timeline == CONSTANT {
        return KeyframeCursor(0u, 0.0);
    }
    return cursor_of_words(cursors[first_cursor + timeline]);
}

fn is_elsewhere(track: SetTrack, before: SetTrack) -> bool {
    return timeline_of(track) != timeline_of(before);
}

fn between(track: SetTrack, cursor: KeyframeCursor) -> Between {
    if timeline_of(track) == CONSTANT {
        return Between(first_value_of(track), INTERPOLATION_STEP, 0.0);
    }
    let fraction = cursor.fraction;
    let code = interpolation_of(track);
    if SPLINES && code > INTERPOLATION_LINEAR {
        return Between(first_value_of(track) + 3u * cursor.key + 1u, select(INTERPOLATION_STEP, code, fraction > 0.0), fraction);
    }
    return Between(first_value_of(track) + cursor.key, select(INTERPOLATION_STEP, code, fraction > 0.0), fraction);
}

fn spline(start: vec4<f32>, value: u32, t: f32) -> vec4<f32> {
    let square = t * t;
    let cube = square * t;
    let of_end = 3.0 * square - 2.0 * cube;
    return (1.0 - of_end) * start + (cube - 2.0 * square + t) * values[value + 1u] + of_end * values[value + 3u] + (cube - square) * values[value + 2u];
}

fn vector(at: Between) -> vec3<f32> {
    let start = values[at.value];
    if at.code == INTERPOLATION_STEP {
        return start.xyz;
    }
    if !SPLINES || at.code == INTERPOLATION_LINEAR {
        return start.xyz + (values[at.value + 1u].xyz - start.xyz) * at.fraction;
    }
    return spline(start, at.value, at.fraction).xyz;
}

fn rotation(at: Between, is_spline: bool) -> vec4<f32> {
    let start = values[at.value];
    if SPLINES && is_spline {
        var q = start;
        if at.code != INTERPOLATION_STEP {
            q = spline(start, at.value, at.fraction);
            q = select(q, start, dot(q, q) < VANISHING);
        }
        return unit_quaternion(q);
    }
    if at.code == INTERPOLATION_STEP {
        return start;
    }
    let end = values[at.value + 1u];
    if NLERP {
        return unit_quaternion(start + (end - start) * at.fraction);
    }
    return slerp(start, end, at.fraction);
}

struct Local {
    moved: vec3<f32>,
    turned: vec4<f32>,
    scaled: vec3<f32>
}

fn local_at(slot: u32, bone: u32, cursor_slot: u32) -> Local {
    let track = 3u * (instances[slot].clip * params.bones + bone);
    let first_cursor = cursor_slot * params.timelines;
    let moving = tracks[track];
    let turning = tracks[track + 1u];
    let scaling = tracks[track + 2u];
    var cursor = cursor_of(moving, first_cursor);
    let moved = vector(between(moving, cursor));
    if is_elsewhere(turning, moving) {
        cursor = cursor_of(turning, first_cursor);
    }
    let turned = rotation(between(turning, cursor), interpolation_of(turning) > INTERPOLATION_LINEAR);
    if is_elsewhere(scaling, turning) {
        cursor = cursor_of(scaling, first_cursor);
    }
    let scaled = vector(between(scaling, cursor));
    return Local(moved, turned, scaled);
}

fn blend(below: Local, over: Local, weight: f32) -> Local {
    let rest = 1.0 - weight;
    let nearer = select(weight, -weight, dot(below.turned, over.turned) < 0.0);
    return Local(below.moved * rest + over.moved * weight, unit_quaternion(below.turned * rest + over.turned * nearer), below.scaled * rest + over.scaled * weight);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    var pair = id.y * groups.x * 64u + id.x;
    var is_ahead = false;
    if COMPACTED {
        if pair >= dispatched.w {
            return;
        }
        pair = pairs[pair];
        is_ahead = (pair & PAIR_AHEAD) != 0u;
        pair &= ~PAIR_AHEAD;
    }
    if pair >= params.pairs {
        return;
    }
    let instance = pair / params.bones;
    let bone = pair - instance * params.bones;
    var local = local_at(instance, bone, select(0u, params.layers * params.instances, is_ahead) + instance);
    if LAYERED {
        let masks = (params.layers - 1u) * params.instances;
        for (var over = 0u; over + 1u < params.layers; over++) {
            let weight = layer_weights[over * params.instances + instance] * layer_weights[masks + over * params.bones + bone];
            if weight > 0.0 {
                let slot = (over + 1u) * params.instances + instance;
                local = blend(local, local_at(slot, bone, slot), weight);
            }
        }
    }
    locals[3u * pair] = vec4<f32>(local.moved, local.scaled.x);
    locals[3u * pair + 1u] = local.turned;
    locals[3u * pair + 2u] = vec4<f32>(local.scaled.yz, 0.0, 0.0);
}
