// Culling and level of detail of instances: which are seen, how far their influences fade, and which level of
// detail each has. A thread decides for one instance.
import package::wgsl::skinning::instance_lod::{InstanceLod, MAX_LEVELS};

struct LodParams {
    // Planes of the view volume: unit normals that point inwards, and distances.
    planes: array<vec4<f32>, 6>,
    // The position of the eye; w: the distance at which fading begins.
    eye: vec4<f32>,
    // The unit vector ahead, with w = 1; w = 0 for a parallel view.
    ahead: vec4<f32>,
    // A bounding sphere of the model in all of its clips: center and radius.
    bounding_sphere: vec4<f32>,
    // The distance from which on vertices are rigid.
    fade_end: f32,
    // Number of steps of the fade.
    steps: f32,
    instances: u32,
    // The largest number of influences.
    max_influences: u32,
    // The distances from which on levels 1, 2 … are used, not descending, and the number of these levels.
    distances: array<vec4<f32>, MAX_LEVELS / 4u>,
    coarser: u32,
    // Words from one level's list of instances to the next.
    stride: u32,
    // −1 if the view mirrors, else 1.
    side: f32,
}

// The arguments of an indexed indirect draw.
struct Draw {
    indices: u32,
    instances: atomic<u32>,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
}

// The draws of one level: that of its whole list, and that of the mirrored instances, which runs through the
// list up to the last of these.
struct Arguments {
    listed: Draw,
    mirrored: Draw,
}

@group(0) @binding(0) var<uniform> params: LodParams;
// Three rows per instance: the transform from the model's space into the world.
@group(0) @binding(1) var<storage, read> placements: array<vec4<f32>>;
// The decisions; instances that are not seen have 0 influences.
@group(0) @binding(2) var<storage, read_write> instance_lods: array<InstanceLod>;
// Indices of the instances that are seen, level by level.
@group(0) @binding(3) var<storage, read_write> drawn: array<u32>;
// One entry per level.
@group(0) @binding(4) var<storage, read_write> arguments: array<Arguments>;

// An upper bound on how much a matrix with these rows stretches: the square root of the largest row sum of
// the products of columns (Gershgorin), or of the sum of their squares, whichever is less.
fn stretch(x: vec3<f32>, y: vec3<f32>, z: vec3<f32>) -> f32 {
    let squares = x * x + y * y + z * z;
    // Products of the first and second column, the second and third, and the third and first.
    let mixed = abs(x * x.yzx + y * y.yzx + z * z.yzx);
    let sums = squares + mixed + mixed.zxy;
    return sqrt(min(max(max(sums.x, sums.y), sums.z), squares.x + squares.y + squares.z));
}

// The smallest normal f32, 2^-126, exactly; devices may flush smaller values to zero.
const LEAST_NORMAL: f32 = 1.1754943508222875e-38;

// The determinant of unit rows below which a matrix is nearly singular.
const NEARLY_SINGULAR: f32 = 1e-5;

// Whether an instance with these rows may appear mirrored in a view of side 1 or −1. A nearly singular
// matrix may count as either, and the draw call decides.
fn may_mirror(x: vec3<f32>, y: vec3<f32>, z: vec3<f32>, side: f32) -> bool {
    return side * dot(x, cross(y, z)) < NEARLY_SINGULAR * (length(x) * length(y) * length(z));
}

// The distance at which a point counts, given its offset from the eye: its distance if it is straight ahead,
// less to the side.
fn projected_distance_of(towards: vec3<f32>) -> f32 {
    let distance = length(towards);
    let depth = max(dot(params.ahead.xyz, towards), 0.0);
    return select(distance, depth * (depth / max(distance, LEAST_NORMAL)), params.ahead.w > 0.0);
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let instance = (group.y * groups.x + group.x) * 64u + lane;
    if instance >= params.instances {
        return;
    }
    let x = placements[3u * instance];
    let y = placements[3u * instance + 1u];
    let z = placements[3u * instance + 2u];
    let middle = vec4<f32>(params.bounding_sphere.xyz, 1.0);
    let center = vec3<f32>(dot(x, middle), dot(y, middle), dot(z, middle));
    let radius = params.bounding_sphere.w * stretch(x.xyz, y.xyz, z.xyz);
    var is_seen = true;
    for (var plane = 0u; plane < 6u; plane++) {
        let side = params.planes[plane];
        is_seen = is_seen && dot(side.xyz, center) + side.w >= -radius;
    }
    var instance_lod = InstanceLod(0.0, 0u, 0u);
    if is_seen {
        let projected_distance = projected_distance_of(center - params.eye.xyz);
        let fade_fraction = clamp((projected_distance - params.eye.w) / (params.fade_end - params.eye.w), 0.0, 1.0);
        var level = 0u;
        while level < params.coarser && projected_distance >= params.distances[level >> 2u][level & 3u] {
            level++;
        }
        instance_lod = InstanceLod(floor(fade_fraction * params.steps) / params.steps, params.max_influences, level);
        let slot = atomicAdd(&arguments[level].listed.instances, 1u);
        drawn[level * params.stride + slot] = instance;
        if may_mirror(x.xyz, y.xyz, z.xyz, params.side) {
            atomicMax(&arguments[level].mirrored.instances, slot + 1u);
        }
    }
    instance_lods[instance] = instance_lod;
}
