// Which instances are seen, how far their influences fade, and with which level of detail. A thread decides for one
// instance.
import package::wgsl::skinning::instance_lod::InstanceLod;

struct LodParams {
    // Of the view's volume: unit normals inwards, and distances.
    planes: array<vec4<f32>, 6>,
    // The eye, and from where on fading begins.
    eye: vec4<f32>,
    // A unit vector and 1, or 0 where the view is parallel.
    ahead: vec4<f32>,
    // A ball around the model in all of its clips: middle and radius.
    bounding_sphere: vec4<f32>,
    // From where on vertices are rigid.
    far: f32,
    // Steps of the fade.
    steps: f32,
    instances: u32,
    // The most influences.
    most: u32,
    // From where on levels 1, 2 … are used, not descending; how many.
    distances: array<vec4<f32>, 4>,
    coarser: u32,
    // From one level's list of instances to the next one's.
    stride: u32,
    // −1 where the view mirrors, else 1.
    side: f32,
}

// Of an indirect draw.
struct Draw {
    indices: u32,
    instances: atomic<u32>,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
}

// Of a level: the draw of its list, and that of the mirrored ones in it, which goes through the list up to the last of
// these.
struct Arguments {
    listed: Draw,
    mirrored: Draw,
}

@group(0) @binding(0) var<uniform> params: LodParams;
// Three rows an instance: from the model's space into the world.
@group(0) @binding(1) var<storage, read> placements: array<vec4<f32>>;
// With no influences of those that are not seen.
@group(0) @binding(2) var<storage, read_write> instance_lods: array<InstanceLod>;
// The instances that are seen, level by level.
@group(0) @binding(3) var<storage, read_write> drawn: array<u32>;
// One a level.
@group(0) @binding(4) var<storage, read_write> arguments: array<Arguments>;

// At least as much as a matrix of these rows stretches: the root of its columns' products' largest row sum (Gershgorin),
// or of their squares' sum.
fn stretch(x: vec3<f32>, y: vec3<f32>, z: vec3<f32>) -> f32 {
    let squares = x * x + y * y + z * z;
    // First with second, second with third, third with first.
    let mixed = abs(x * x.yzx + y * y.yzx + z * z.yzx);
    let sums = squares + mixed + mixed.zxy;
    return sqrt(min(max(max(sums.x, sums.y), sums.z), squares.x + squares.y + squares.z));
}

// The least normal f32, 2^-126, exactly: what is less may be flushed to zero.
const LEAST_NORMAL = 1.1754943508222875e-38;

// Whether an instance of these rows may be a mirror image, a view of side 1 or −1 considered: what is nearly flat may be
// either, and whoever draws it decides.
fn may_mirror(x: vec3<f32>, y: vec3<f32>, z: vec3<f32>, side: f32) -> bool {
    return side * dot(x, cross(y, z)) < 1e-5 * (length(x) * length(y) * length(z));
}

// How far away a place counts, which lies so from the eye: as far as it is, straight ahead; less to the side.
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
        let fade_fraction = clamp((projected_distance - params.eye.w) / (params.far - params.eye.w), 0.0, 1.0);
        var level = 0u;
        while level < params.coarser && projected_distance >= params.distances[level >> 2u][level & 3u] {
            level++;
        }
        instance_lod = InstanceLod(floor(fade_fraction * params.steps) / params.steps, params.most, level);
        let place = atomicAdd(&arguments[level].listed.instances, 1u);
        drawn[level * params.stride + place] = instance;
        if may_mirror(x.xyz, y.xyz, z.xyz, params.side) {
            atomicMax(&arguments[level].mirrored.instances, place + 1u);
        }
    }
    instance_lods[instance] = instance_lod;
}
