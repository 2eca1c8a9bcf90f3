// Transforms of bones in their parents' spaces at the places where instances stand in their clips (glTF 2.0, appendix
// C). A thread samples one bone of one instance: every one, or with COMPACTED those of a list.
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::rotation::{slerp, unit_quaternion};

override COMPACTED: bool = false;
override NLERP: bool = false;
// Whether any track is a spline: lanes that need none would wait for the loads of its branches.
override SPLINES: bool = true;

struct SampleParams {
    bones: u32,
    // Room of an instance for its places.
    timelines: u32,
    // Bones of all instances.
    pairs: u32,
}

@group(0) @binding(0) var<uniform> params: SampleParams;
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
// Three a bone and clip: timeline (30 bits) and interpolation, first value.
@group(0) @binding(2) var<storage, read> tracks: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> values: array<vec4<f32>>;
// Key and, as bits, fraction.
@group(0) @binding(4) var<storage, read> places: array<vec2<u32>>;
// instance * bones + bone, of each pair that is to be sampled.
@group(0) @binding(5) var<storage, read> pairs: array<u32>;
// Workgroups of the dispatch, and how many pairs.
@group(0) @binding(6) var<storage, read> dispatched: vec4<u32>;
// Translation and scale x; rotation; scale y and z.
@group(0) @binding(7) var<storage, read_write> locals: array<vec4<f32>>;

const CONSTANT = 0x3fffffffu;
const STEP = 0u;
const LINEAR = 1u;
const VANISHING = 1e-12;

struct Between {
    // The value's index, and the interpolation to the next: STEP where there is nothing to interpolate.
    value: u32,
    code: u32,
    fraction: f32,
}

fn place_of(track: vec2<u32>, first_place: u32) -> vec2<u32> {
    let timeline = track.x & CONSTANT;
    if timeline == CONSTANT {
        return vec2<u32>(0u);
    }
    return places[first_place + timeline];
}

// Tracks of a bone mostly share a timeline: its place is loaded once.
fn is_elsewhere(track: vec2<u32>, before: vec2<u32>) -> bool {
    return ((track.x ^ before.x) & CONSTANT) != 0u;
}

fn between(track: vec2<u32>, place: vec2<u32>) -> Between {
    let timeline = track.x & CONSTANT;
    if timeline == CONSTANT {
        return Between(track.y, STEP, 0.0);
    }
    let fraction = bitcast<f32>(place.y);
    let code = track.x >> 30u;
    if SPLINES && code > LINEAR {
        // Three values a key.
        return Between(track.y + 3u * place.x + 1u, select(STEP, code, fraction > 0.0), fraction);
    }
    return Between(track.y + place.x, select(STEP, code, fraction > 0.0), fraction);
}

fn spline(start: vec4<f32>, value: u32, t: f32) -> vec4<f32> {
    let square = t * t;
    let cube = square * t;
    let of_end = 3.0 * square - 2.0 * cube;
    return (1.0 - of_end) * start
        + (cube - 2.0 * square + t) * values[value + 1u]
        + of_end * values[value + 3u]
        + (cube - square) * values[value + 2u];
}

fn vector(at: Between) -> vec3<f32> {
    let start = values[at.value];
    if at.code == STEP {
        return start.xyz;
    }
    if !SPLINES || at.code == LINEAR {
        return start.xyz + (values[at.value + 1u].xyz - start.xyz) * at.fraction;
    }
    return spline(start, at.value, at.fraction).xyz;
}

fn rotation(at: Between, is_spline: bool) -> vec4<f32> {
    let start = values[at.value];
    if SPLINES && is_spline {
        var q = start;
        if at.code != STEP {
            q = spline(start, at.value, at.fraction);
            q = select(q, start, dot(q, q) < VANISHING);
        }
        return unit_quaternion(q);
    }
    if at.code == STEP {
        return start;
    }
    let end = values[at.value + 1u];
    if NLERP {
        return unit_quaternion(start + (end - start) * at.fraction);
    }
    return slerp(start, end, at.fraction);
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    var pair = (group.y * groups.x + group.x) * 64u + lane;
    if COMPACTED {
        if pair >= dispatched.w {
            return;
        }
        pair = pairs[pair];
    }
    if pair >= params.pairs {
        return;
    }
    let instance = pair / params.bones;
    let bone = pair - instance * params.bones;
    let track = 3u * (instances[instance].clip * params.bones + bone);
    let first_place = instance * params.timelines;
    let moving = tracks[track];
    let turning = tracks[track + 1u];
    let scaling = tracks[track + 2u];
    var place = place_of(moving, first_place);
    let moved = vector(between(moving, place));
    if is_elsewhere(turning, moving) {
        place = place_of(turning, first_place);
    }
    let turned = rotation(between(turning, place), turning.x >> 30u > LINEAR);
    if is_elsewhere(scaling, turning) {
        place = place_of(scaling, first_place);
    }
    let scaled = vector(between(scaling, place));
    locals[3u * pair] = vec4<f32>(moved, scaled.x);
    locals[3u * pair + 1u] = turned;
    locals[3u * pair + 2u] = vec4<f32>(scaled.yz, 0.0, 0.0);
}
