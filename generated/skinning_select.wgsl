// relievo skinning/select: generated from kernels/skinning/select.wgsl

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

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

override FINISH: bool = false;

override CLEAR: bool = false;

override KEEP: bool = false;

const SKINNED_WORDS: u32 = 5u;

struct SelectParams {
    instances: u32,
    clusters: u32,
    words: u32,
    most: u32,
    vertices: u32,
    targets: u32,
    levels: array<vec4<u32>, MAX_LEVELS / 4u>
}

struct Dispatched {
    x: u32,
    y: u32,
    z: u32,
    pairs: u32,
    count: atomic<u32>
}

@group(0) @binding(0)
var<uniform> params: SelectParams;

@group(0) @binding(1)
var<storage, read> masks: array<u32>;

@group(0) @binding(2)
var<storage, read_write> updated_bones: array<u32>;

@group(0) @binding(3)
var<storage, read> instance_lods: array<InstanceLod>;

@group(0) @binding(4)
var<storage, read> weights: array<u32>;

@group(0) @binding(5)
var<storage, read> offsets: array<u32>;

@group(0) @binding(6)
var<storage, read_write> skinned: array<u32>;

@group(0) @binding(7)
var<storage, read_write> pairs: array<u32>;

@group(0) @binding(8)
var<storage, read_write> dispatched: Dispatched;

fn clusters_of(level: u32) -> u32 {
    let at = min(level, MAX_LEVELS - 1u);
    return params.levels[at >> 2u][at & 3u];
}

fn finish(index: u32) {
    if index < params.instances {
        let to = index * (SKINNED_WORDS + params.targets);
        let now = instance_lods[index];
        skinned[to] = bitcast<u32>(now.influence_fade);
        skinned[to + 1u] = now.max_influences;
        skinned[to + 2u] = now.mesh_lod;
        skinned[to + 3u] = now.tier;
        skinned[to + 4u] = select(min(skinned[to + 4u] + 1u, 2u), 0u, now.max_influences == 0u);
        for (var target_index = 0u; target_index < params.targets; target_index++) {
            skinned[to + SKINNED_WORDS + target_index] = weights[index * params.targets + target_index];
        }
        if CLEAR {
            for (var word = 0u; word < params.words; word++) {
                updated_bones[index * params.words + word] = 0u;
            }
        }
    }
    if index == 0u {
        let all = atomicExchange(&dispatched.count, 0u);
        let groups = rows_of_workgroups(all, params.most);
        dispatched.x = groups.x;
        dispatched.y = groups.y;
        dispatched.z = groups.z;
        dispatched.pairs = all;
    }
}

fn is_morphed_anew(cluster: u32, instance: u32, last: u32) -> bool {
    let first = CLUSTER * cluster;
    if offsets[first] == offsets[min(first + CLUSTER, params.vertices)] {
        return false;
    }
    var found = false;
    for (var target_index = 0u; target_index < params.targets && !found; target_index++) {
        found = weights[instance * params.targets + target_index] != skinned[last + SKINNED_WORDS + target_index];
    }
    return found;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if FINISH {
        finish(index);
        return;
    }
    let cluster = index / params.instances;
    if cluster >= params.clusters {
        return;
    }
    let instance = index - cluster * params.instances;
    let now = instance_lods[instance];
    if now.max_influences == 0u || cluster >= clusters_of(now.mesh_lod) {
        return;
    }
    let last = instance * (SKINNED_WORDS + params.targets);
    var found = bitcast<u32>(now.influence_fade) != skinned[last] || now.max_influences != skinned[last + 1u] || cluster >= clusters_of(skinned[last + 2u]) || now.tier != skinned[last + 3u];
    for (var word = 0u; word < params.words && !found; word++) {
        found = (masks[(now.tier * params.clusters + cluster) * params.words + word] & updated_bones[instance * params.words + word]) != 0u;
    }
    if params.targets > 0u && !found {
        found = is_morphed_anew(cluster, instance, last);
    }
    if KEEP {
        let state = params.clusters * params.instances + index;
        let was_moved = pairs[state] == CLUSTER_MOVED;
        let is_fresh = skinned[last + 1u] == 0u || cluster >= clusters_of(skinned[last + 2u]);
        pairs[state] = select(CLUSTER_STILL, select(CLUSTER_MOVED, CLUSTER_FRESH, is_fresh), found);
        found = found || was_moved;
    }
    if found {
        pairs[atomicAdd(&dispatched.count, 1u)] = index;
    }
}
