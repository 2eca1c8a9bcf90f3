// Sets the level of detail of each instance of a character from what the views of a frame allow: for gates, and for skinning.
// Bones and influences each get a fraction of the allowed displacement, or a level by distance. The mesh is skinned at the finest
// level that a view draws. A thread handles one instance.
import package::wgsl::animation::gate_state::{FULL_WEIGHT, LOD_HIDDEN, Lod, OMEGA_ONE, lod_flags_tier, lod_flags_word};
import package::wgsl::lod::allowed::Allowed;
import package::wgsl::lod::instance::{INSTANCE_CARRIES, INSTANCE_WHOLE, SceneInstance};
import package::wgsl::skinning::instance_lod::InstanceLod;

// Number of steps to which the influence fade is rounded, so that an instance that hardly moves keeps its fade.
const FADE_STEPS: f32 = 64.0;
// Largest `Lod::allowed`. It is exact in an f32, and below the motion of a whole clip, 2^30.
const MAX_UNITS: f32 = 1073741760.0;
// Largest number of skeleton tiers.
const MAX_TIERS: u32 = 4u;
// An instance changes to a coarser tier only if the tier's error is below this fraction of its limit (hysteresis).
const TIER_HYSTERESIS: f32 = 0.8;

// Parameters of the kernel `lod/assign`.
struct AssignParams {
    // Index in `allowed` of the object's first instance.
    first: u32,
    // Number of instances.
    instances: u32,
    // Fraction of the allowed displacement that unsampled bones may use, 0 to 1.
    bone_fraction: f32,
    // Fraction of the allowed displacement that influence fades may use, 0 to 1.
    influence_fraction: f32,
    // Unit of the gate's table in model units, above 0.
    unit: f32,
    // Largest displacement of a vertex whose influences have faded completely, in model units, at least 0.
    stray: f32,
    // Largest number of influences of a visible instance, 1 to 8.
    max_influences: u32,
    // Distance in world units up to which Ω is 1.
    omega_start: f32,
    // Decrease of Ω per world unit beyond `omega_start`; 0 if Ω is always 1.
    omega_rate: f32,
    // Distance in world units up to which influences have their full weight.
    fade_start: f32,
    // Increase of the influence fade per world unit beyond `fade_start`; 0 if influences do not fade by distance.
    fade_rate: f32,
    // Allowed displacement up to which an instance's motion has full weight, in model units, above 0.
    full_weight_allowed: f32,
    // Largest error of a skeleton tier, as a fraction of the displacement that bones may use, 0 to 1. The rest is for bones that
    // the gate skips.
    tier_fraction: f32,
    // Error of each skeleton tier in model units, ascending from 0. A tier that does not exist has an error that nothing allows.
    tier_errors: vec4<f32>,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: AssignParams;
// Per instance of the scene: the displacement that the frame's views allow, and the distance of the nearest eye.
// length: instances
@group(0) @binding(1) var<storage, read> allowed: array<Allowed>;
// Per instance of the object: the level of detail for gates. In: that of the last frame.
// length: instances
@group(0) @binding(2) var<storage, read_write> lods: array<Lod>;
// Out, per instance of the object: the level of detail for skinning.
// length: instances
@group(0) @binding(3) var<storage, read_write> instance_lods: array<InstanceLod>;
// All instances of the scene.
// length: instances
@group(0) @binding(4) var<storage, read> instances: array<SceneInstance>;
// Per instance of the scene: the finest level that the frame's views draw.
// length: instances
@group(0) @binding(5) var<storage, read> finest: array<u32>;

// Rounds a fade down to a multiple of 1/FADE_STEPS.
fn in_steps(fade: f32) -> f32 {
    return floor(FADE_STEPS * fade) / FADE_STEPS;
}

// Largest influence fade, 0 to 1, that displaces vertices by at most `influence_fraction` times `within`. `within` is the
// allowed displacement in model units. The result is 1 if a complete fade displaces nothing.
fn fade_within(within: f32) -> f32 {
    let faded = in_steps(min(params.influence_fraction * within / params.stray, 1.0));
    return select(faded, 1.0, params.stray <= 0.0);
}

// Coarsest tier whose error is at most `limit`.
fn tier_within(limit: f32) -> u32 {
    var tier = 0u;
    for (var next = 1u; next < MAX_TIERS; next++) {
        tier = select(tier, next, params.tier_errors[next] <= limit);
    }
    return tier;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let instance = id.y * groups.x * 64u + id.x;
    if instance >= params.instances {
        return;
    }
    let seen = allowed[params.first + instance];
    let within = seen.displacement;
    if within < 0.0 {
        lods[instance] = Lod(OMEGA_ONE, 0u, FULL_WEIGHT, LOD_HIDDEN);
        instance_lods[instance] = InstanceLod(0.0, 0u, 0u, 0u);
        return;
    }
    let flags = instances[params.first + instance].flags;
    // An attached mesh may reach further from its bone than the vertices that the gate's table covers. Therefore, the allowed
    // displacement of bones is 0 for a character with an attached mesh.
    let carries = (flags & INSTANCE_CARRIES) != 0u;
    let of_bones = params.bone_fraction * within;
    let limit = params.tier_fraction * of_bones;
    let coarsest = tier_within(limit);
    let last = lod_flags_tier(lods[instance].flags);
    let held = clamp(last, tier_within(TIER_HYSTERESIS * limit), coarsest);
    let tier = select(held, 0u, (flags & (INSTANCE_CARRIES | INSTANCE_WHOLE)) != 0u);
    let units = u32(min(floor((of_bones - params.tier_errors[tier]) / params.unit), MAX_UNITS));
    let falling = clamp((seen.distance - params.omega_start) * params.omega_rate, 0.0, 1.0);
    let omega = OMEGA_ONE - u32(round(falling * f32(OMEGA_ONE)));
    let weight = u32(f32(FULL_WEIGHT) * min(params.full_weight_allowed / max(within, params.full_weight_allowed), 1.0));
    lods[instance] = Lod(omega, select(units, 0u, carries), weight, lod_flags_word(0u, tier));
    let fade = in_steps(clamp((seen.distance - params.fade_start) * params.fade_rate, 0.0, 1.0));
    instance_lods[instance] = InstanceLod(
        max(fade_within(within), fade), params.max_influences, finest[params.first + instance], tier);
}
