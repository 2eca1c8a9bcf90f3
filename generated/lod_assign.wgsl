// relievo lod/assign: generated from kernels/lod/assign.wgsl

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

const ALLOWED_MARGIN: f32 = 0.9999;

const MAX_ALLOWED: f32 = 1000000000.0;

const LEAST_SCALE: f32 = 1e-9;

struct Allowed {
    displacement: f32,
    distance: f32
}

const UNSEEN_ALLOWED: f32 = -1.0;

fn camera_allows(camera: LodCamera, center: vec3<f32>, radius: f32) -> f32 {
    if camera.perspective == 0.0 {
        return ALLOWED_MARGIN * (camera.pixels / camera.focal);
    }
    let towards = center - camera.eye;
    let ahead = dot(camera.ahead, towards);
    let aside = length(towards - ahead * camera.ahead);
    let around = radius + POSITION_SLACK * (length(center) + length(camera.eye) + radius);
    let is_behind = ahead + around < 0.0;
    let depth = select(ahead, length(towards), is_behind) - around;
    let across = select(aside + around, 0.0, is_behind);
    if depth <= camera.near {
        return 0.0;
    }
    let cosine = depth / sqrt(depth * depth + across * across);
    let allowed = ALLOWED_MARGIN * (camera.pixels * cosine * depth / (camera.focal + camera.pixels * cosine));
    return select(allowed, 0.0, depth - allowed <= camera.near);
}

fn allowed_in_model(allowed: f32, scale: f32) -> f32 {
    return min(allowed / max(scale, LEAST_SCALE), MAX_ALLOWED);
}

const CELL_SIZE: f32 = 256.0;

const INSTANCE_ALIVE = 1u;

const INSTANCE_CASTS = 2u;

const INSTANCE_CARRIES = 4u;

const INSTANCE_FOLLOWS = 8u;

const INSTANCE_WHOLE = 16u;

struct SceneInstance {
    cell: vec3<i32>,
    flags: u32,
    offset: vec3<f32>,
    user_data: u32,
    rotation: vec4<f32>,
    scale: vec3<f32>,
    tint: u32,
    bounding_sphere: vec4<f32>
}

struct Axes {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>
}

fn instance_axes(instance: SceneInstance) -> Axes {
    let q = instance.rotation;
    let s = instance.scale;
    let x = vec3<f32>(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3<f32>(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let z = vec3<f32>(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return Axes(s.x * x, s.y * y, s.z * z);
}

fn instance_position(instance: SceneInstance, cell: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(instance.cell - cell) * CELL_SIZE + instance.offset;
}

fn instance_flags_word(bits: u32, mask: u32) -> u32 {
    return bits | (mask << 16u);
}

fn instance_flags_bits(word: u32) -> u32 {
    return word & 65535u;
}

fn instance_flags_mask(word: u32) -> u32 {
    return word >> 16u;
}

const VIEW_CAMERAS = 4u;

struct LodCamera {
    eye: vec3<f32>,
    focal: f32,
    ahead: vec3<f32>,
    pixels: f32,
    near: f32,
    perspective: f32,
    pixel_count: f32,
    unused: f32
}

struct SelectView {
    planes: array<vec4<f32>, 6>,
    cameras: array<LodCamera, 4>,
    cell: vec3<i32>,
    mask: u32,
    camera_count: u32,
    is_first: u32,
    casters: u32,
    blocks: u32,
    is_next: u32,
    seconds: f32,
    unused_a: u32,
    unused_b: u32,
    clip_rows: array<vec4<f32>, 3>,
    last_clip_rows: array<vec4<f32>, 3>
}

const POSITION_SLACK: f32 = 3e-6;

struct InstanceLod {
    influence_fade: f32,
    max_influences: u32,
    mesh_lod: u32,
    tier: u32
}

const MAX_LEVELS: u32 = 16u;

const FADE_STEPS: f32 = 64.0;

const MAX_UNITS: f32 = 1073741760.0;

const MAX_TIERS: u32 = 4u;

const TIER_HYSTERESIS: f32 = 0.8;

struct AssignParams {
    first: u32,
    instances: u32,
    bone_fraction: f32,
    influence_fraction: f32,
    unit: f32,
    stray: f32,
    max_influences: u32,
    omega_start: f32,
    omega_rate: f32,
    fade_start: f32,
    fade_rate: f32,
    full_weight_allowed: f32,
    tier_fraction: f32,
    tier_errors: vec4<f32>
}

@group(0) @binding(0)
var<uniform> params: AssignParams;

@group(0) @binding(1)
var<storage, read> allowed: array<Allowed>;

@group(0) @binding(2)
var<storage, read_write> lods: array<Lod>;

@group(0) @binding(3)
var<storage, read_write> instance_lods: array<InstanceLod>;

@group(0) @binding(4)
var<storage, read> instances: array<SceneInstance>;

@group(0) @binding(5)
var<storage, read> finest: array<u32>;

fn in_steps(fade: f32) -> f32 {
    return floor(FADE_STEPS * fade) / FADE_STEPS;
}

fn fade_within(within: f32) -> f32 {
    let faded = in_steps(min(params.influence_fraction * within / params.stray, 1.0));
    return select(faded, 1.0, params.stray <= 0.0);
}

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
    instance_lods[instance] = InstanceLod(max(fade_within(within), fade), params.max_influences, finest[params.first + instance], tier);
}
