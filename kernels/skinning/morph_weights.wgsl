// Weights of morph targets at each instance's time in its clip (glTF 2.0, section 3.11). The kernel runs before
// skinning/select. A thread computes the weight of one target of one instance. Invisible instances keep their weights.
import package::wgsl::animation::clip::Timeline;
import package::wgsl::animation::clock::inside_clip;
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::interpolation::{INTERPOLATION_LINEAR, INTERPOLATION_SPLINE};
import package::wgsl::animation::timeline::{keyframe_cursor, times};
import package::wgsl::skinning::instance_lod::InstanceLod;

// Parameters of the kernel `skinning/morph_weights`.
struct MorphWeightsParams {
    // Number of morph targets.
    targets: u32,
    // Number of targets times number of instances.
    pairs: u32,
    // Elapsed time in seconds, the same for all instances. At elapsed time 0, the clip time of an instance is its `start`.
    elapsed: f32,
}

// Location of a clip's morph weights in a set of clips.
struct WeightEntry {
    // The clip's duration in seconds.
    duration: f32,
    // Index of the clip's first key time.
    first_time: u32,
    // Number of keys, at least 1.
    keys: u32,
    // Index of the clip's first value.
    first_value: u32,
    // INTERPOLATION_STEP, INTERPOLATION_LINEAR or INTERPOLATION_SPLINE. A spline key has in-tangents, values and out-tangents.
    interpolation: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: MorphWeightsParams;
// Clip and playback of each instance.
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
// Location of each clip's morph weights.
@group(0) @binding(2) var<storage, read> entries: array<WeightEntry>;
// Level of detail of each instance, which tells whether the instance is visible.
@group(0) @binding(3) var<storage, read> instance_lods: array<InstanceLod>;
// Binding 4 holds the key times: `times` in wgsl/animation/timeline.wgsl.
// Values of the keys of all clips, key by key, one value per target.
@group(0) @binding(5) var<storage, read> values: array<f32>;
// Out: weights of the targets, instance by instance.
@group(0) @binding(6) var<storage, read_write> weights: array<f32>;

// Value of a cubic Hermite spline between two keys. `t` is the fraction of the interval from `key` to the next key, and
// `seconds` the duration of the interval.
fn spline(first: u32, key: u32, t: f32, seconds: f32) -> f32 {
    // Each key has in-tangents, values and out-tangents, in this order. The data of the next key follows.
    let at = first + 3u * key * params.targets;
    let start = values[at + params.targets];
    let leaving = values[at + 2u * params.targets];
    let arriving = values[at + 3u * params.targets];
    let end = values[at + 4u * params.targets];
    let square = t * t;
    let cube = square * t;
    let of_end = 3.0 * square - 2.0 * cube;
    return (1.0 - of_end) * start + (cube - 2.0 * square + t) * (seconds * leaving) + of_end * end
        + (cube - square) * (seconds * arriving);
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
    // The fraction is 0 at the last key.
    let is_between = t > 0.0;
    var weight = 0.0;
    if entry.interpolation == INTERPOLATION_SPLINE {
        weight = values[first + (3u * found.key + 1u) * params.targets];
        if is_between {
            let at = entry.first_time + found.key;
            weight = spline(first, found.key, t, times[at + 1u] - times[at]);
        }
    } else {
        weight = values[first + found.key * params.targets];
        if is_between && entry.interpolation == INTERPOLATION_LINEAR {
            weight += (values[first + (found.key + 1u) * params.targets] - weight) * t;
        }
    }
    weights[pair] = weight;
}
