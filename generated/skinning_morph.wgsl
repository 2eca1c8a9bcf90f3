// relievo skinning/morph: generated from kernels/skinning/morph.wgsl

const CLUSTER: u32 = 64u;

const CLUSTER_STILL: u32 = 0u;

const CLUSTER_MOVED: u32 = 1u;

const CLUSTER_FRESH: u32 = 2u;

struct InstanceLod {
    influence_fade: f32,
    max_influences: u32,
    mesh_lod: u32,
    tier: u32
}

const MAX_LEVELS: u32 = 16u;

const NO_PAGE: u32 = 4294967295u;

override PAGED: bool = false;

const LOD_WORDS: u32 = 4u;

struct MorphParams {
    vertices: u32,
    targets: u32,
    instances: u32,
    pairs: u32,
    levels: array<vec4<u32>, MAX_LEVELS / 4u>
}

@group(0) @binding(0)
var<uniform> params: MorphParams;

@group(0) @binding(1)
var<storage, read> vertices: array<vec2<f32>>;

@group(0) @binding(2)
var<storage, read> offsets: array<u32>;

@group(0) @binding(3)
var<storage, read> deltas: array<vec4<f32>>;

@group(0) @binding(4)
var<storage, read> weights: array<f32>;

@group(0) @binding(5)
var<storage, read> seen: array<u32>;

@group(0) @binding(6)
var<storage, read> pairs: array<u32>;

@group(0) @binding(7)
var<storage, read> dispatched: vec4<u32>;

@group(0) @binding(8)
var<storage, read_write> morphed: array<vec2<f32>>;

fn is_seen(instance: u32, cluster: u32) -> bool {
    let lod = LOD_WORDS * instance;
    let level = min(seen[lod + 2u], MAX_LEVELS - 1u);
    return seen[lod + 1u] != 0u && cluster < params.levels[level >> 2u][level & 3u];
}

@compute @workgroup_size(CLUSTER)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let listed = group.y * groups.x + group.x;
    if listed >= dispatched.w {
        return;
    }
    let pair = pairs[listed];
    let cluster = pair / params.instances;
    let instance = pair - cluster * params.instances;
    let vertex = CLUSTER * cluster + lane;
    if pair >= params.pairs || vertex >= params.vertices {
        return;
    }
    var to = 5u * (instance * params.vertices + vertex);
    if PAGED {
        let page = seen[instance * ((params.vertices + CLUSTER - 1u) / CLUSTER) + cluster];
        if page == NO_PAGE {
            return;
        }
        to = 5u * (CLUSTER * page + lane);
    }
    else if !is_seen(instance, cluster) {
        return;
    }
    let first = 5u * vertex;
    let a = vertices[first];
    let b = vertices[first + 1u];
    let c = vertices[first + 2u];
    let d = vertices[first + 3u];
    var position = vec3<f32>(a, b.x);
    var normal = vec3<f32>(b.y, c);
    var tangent = vec3<f32>(d, vertices[first + 4u].x);
    let end = offsets[vertex + 1u];
    for (var at = offsets[vertex]; at < end; at++) {
        let moved = deltas[3u * at];
        let weight = weights[instance * params.targets + bitcast<u32>(moved.w)];
        position += weight * moved.xyz;
        normal += weight * deltas[3u * at + 1u].xyz;
        tangent += weight * deltas[3u * at + 2u].xyz;
    }
    morphed[to] = position.xy;
    morphed[to + 1u] = vec2<f32>(position.z, normal.x);
    morphed[to + 2u] = normal.yz;
    morphed[to + 3u] = tangent.xy;
    morphed[to + 4u] = vec2<f32>(tangent.z, vertices[first + 4u].y);
}
