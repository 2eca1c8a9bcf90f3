// Samples the local transforms of bones at the keyframe cursors of their instances (glTF 2.0, appendix C). A thread samples one
// bone of one instance. With COMPACTED, only the listed bones are sampled. With LAYERED, a thread blends the clips of further
// layers over the base layer, by weight and mask.
import package::wgsl::animation::clip::{CONSTANT, KeyframeCursor, SetTrack, cursor_of_words, first_value_of, interpolation_of, timeline_of};
import package::wgsl::animation::gate_state::PAIR_AHEAD;
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::interpolation::{INTERPOLATION_LINEAR, INTERPOLATION_STEP};
import package::wgsl::animation::rotation::{slerp, unit_quaternion};

// Whether only the listed pairs of instance and bone are sampled.
override COMPACTED: bool = false;
// Whether the clips of further layers are blended over the base layer.
override LAYERED: bool = false;
// Whether rotations are interpolated linearly and then normalized, instead of spherically.
override NLERP: bool = false;
// Whether any track is a spline. Without splines, threads need not wait for the loads of the spline branch.
override SPLINES: bool = true;

// Parameters of the kernel `animation/sample`.
struct SampleParams {
    // Number of bones per instance.
    bones: u32,
    // Number of cursors allocated per instance and layer.
    timelines: u32,
    // Number of bones of all instances together.
    pairs: u32,
    // Number of instances.
    instances: u32,
    // Number of layers, the base layer included.
    layers: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: SampleParams;
// Clip and playback of each instance, layer by layer. Cursors have the same order.
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
// Three tracks per bone and clip: translation, rotation and scale.
@group(0) @binding(2) var<storage, read> tracks: array<SetTrack>;
// Values of the keys of all tracks.
@group(0) @binding(3) var<storage, read> values: array<vec4<f32>>;
// Cursor words (`cursor_of_words`), layer by layer. After all layers: the base layer's cursors at the look-ahead time.
@group(0) @binding(4) var<storage, read> cursors: array<vec2<u32>>;
// Pairs of instance and bone to be sampled: instance * bones + bone. Pairs with PAIR_AHEAD are sampled at the look-ahead time.
@group(0) @binding(5) var<storage, read> pairs: array<u32>;
// Numbers of workgroups of the dispatch (xyz), and the number of pairs (w).
@group(0) @binding(6) var<storage, read> dispatched: vec4<u32>;
// Out: local transforms, three vectors per bone: translation and scale x; rotation; scale y and z.
@group(0) @binding(7) var<storage, read_write> locals: array<vec4<f32>>;
// Weights of the layers above the base layer: one weight per instance, layer by layer. Then a mask for each of these layers,
// with one value per bone.
@group(0) @binding(8) var<storage, read> layer_weights: array<f32>;

// Smallest squared length at which a quaternion from a spline has a direction. For a shorter quaternion, the rotation is the
// value of the key before the position.
const VANISHING: f32 = 1e-12;

// Position between two values of a track.
struct Between {
    // Index of the value before the position.
    value: u32,
    // Interpolation to the next value; INTERPOLATION_STEP where nothing is interpolated.
    code: u32,
    // Fraction of the interval to the next value, 0 to below 1.
    fraction: f32,
}

// Cursor of a track. `first_cursor` is the index of the first cursor of the track's instance.
fn cursor_of(track: SetTrack, first_cursor: u32) -> KeyframeCursor {
    let timeline = timeline_of(track);
    if timeline == CONSTANT {
        return KeyframeCursor(0u, 0.0);
    }
    return cursor_of_words(cursors[first_cursor + timeline]);
}

// Whether two tracks have different timelines. Most tracks of a bone share one timeline, so its cursor is loaded once.
fn is_elsewhere(track: SetTrack, before: SetTrack) -> bool {
    return timeline_of(track) != timeline_of(before);
}

// Position of a cursor between two values of a track.
fn between(track: SetTrack, cursor: KeyframeCursor) -> Between {
    if timeline_of(track) == CONSTANT {
        return Between(first_value_of(track), INTERPOLATION_STEP, 0.0);
    }
    let fraction = cursor.fraction;
    let code = interpolation_of(track);
    if SPLINES && code > INTERPOLATION_LINEAR {
        // Splines have three values per key.
        return Between(first_value_of(track) + 3u * cursor.key + 1u, select(INTERPOLATION_STEP, code, fraction > 0.0), fraction);
    }
    return Between(first_value_of(track) + cursor.key, select(INTERPOLATION_STEP, code, fraction > 0.0), fraction);
}

// Value of a cubic Hermite spline at the fraction `t` of the interval between two values. `start` is the first of the two
// values, and `value` its index.
fn spline(start: vec4<f32>, value: u32, t: f32) -> vec4<f32> {
    let square = t * t;
    let cube = square * t;
    let of_end = 3.0 * square - 2.0 * cube;
    return (1.0 - of_end) * start
        + (cube - 2.0 * square + t) * values[value + 1u]
        + of_end * values[value + 3u]
        + (cube - square) * values[value + 2u];
}

// Translation or scale at a position between two values.
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

// Rotation at a position between two values, as a unit quaternion.
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

// Local transform of a bone.
struct Local {
    // Translation.
    moved: vec3<f32>,
    // Rotation, a unit quaternion.
    turned: vec4<f32>,
    // Scale factors.
    scaled: vec3<f32>,
}

// Local transform of a bone in the clip of one layer. `slot` is layer * instances + instance. `cursor_slot` selects the
// cursors. For the base layer at the look-ahead time, it is layers * instances + instance; otherwise it equals `slot`.
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

// Blends two transforms. Rotations are blended linearly and normalized; of the quaternions q and -q, the nearer one is used.
fn blend(below: Local, over: Local, weight: f32) -> Local {
    let rest = 1.0 - weight;
    let nearer = select(weight, -weight, dot(below.turned, over.turned) < 0.0);
    return Local(
        below.moved * rest + over.moved * weight,
        unit_quaternion(below.turned * rest + over.turned * nearer),
        below.scaled * rest + over.scaled * weight,
    );
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
