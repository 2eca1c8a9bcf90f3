// Selects the clusters to be skinned, among the clusters of visible instances at their level of detail. A thread decides for
// one cluster. A cluster is selected if one of its bones was updated, or if the influences of its instance changed. It is also
// selected if the last frame's level did not contain it. With morph targets, a change of the instance's weights also selects
// the clusters that the targets move. With KEEP, the clusters of the last frame are skinned once more, so that their last
// positions become their current positions.
//
// With FINISH, a thread stores the InstanceLod and weights of one instance for the next frame. With CLEAR, the thread also
// clears the instance's updated bones. The first thread writes the arguments of the dispatch.
import package::wgsl::dispatch::rows_of_workgroups;
import package::wgsl::skinning::cluster::{CLUSTER, CLUSTER_FRESH, CLUSTER_MOVED, CLUSTER_STILL};
import package::wgsl::skinning::instance_lod::{InstanceLod, MAX_LEVELS};

// Whether the dispatch stores the instances' state for the next frame, instead of selecting clusters.
override FINISH: bool = false;
// With FINISH, whether the updated bones are cleared.
override CLEAR: bool = false;
// Whether the positions of the last frame are kept.
override KEEP: bool = false;

// Number of words per instance in `skinned` before the instance's weights.
const SKINNED_WORDS: u32 = 5u;

// Parameters of the kernel `skinning/select`.
struct SelectParams {
    // Number of instances.
    instances: u32,
    // Number of clusters of the mesh.
    clusters: u32,
    // Number of words of a bone set, with one bit per bone.
    words: u32,
    // Largest number of workgroups along x.
    most: u32,
    // Number of vertices of the mesh.
    vertices: u32,
    // Number of morph targets.
    targets: u32,
    // Number of clusters of the mesh at each level of detail.
    levels: array<vec4<u32>, MAX_LEVELS / 4u>,
}

// Arguments of the skinning dispatch, with the number of pairs and a counter.
struct Dispatched {
    // Number of workgroups along x.
    x: u32,
    // Number of workgroups along y.
    y: u32,
    // Number of workgroups along z.
    z: u32,
    // Number of pairs to be skinned.
    pairs: u32,
    // Number of pairs found so far.
    count: atomic<u32>,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: SelectParams;
// Bone set of each cluster, one bit per bone, for one skeleton tier after the other.
@group(0) @binding(1) var<storage, read> masks: array<u32>;
// Set of updated bones of each instance, one bit per bone.
@group(0) @binding(2) var<storage, read_write> updated_bones: array<u32>;
// Level of detail of each instance.
@group(0) @binding(3) var<storage, read> instance_lods: array<InstanceLod>;
// Weights of the targets as bits, instance by instance.
@group(0) @binding(4) var<storage, read> weights: array<u32>;
// Index of each vertex's first delta. The last element is the number of deltas.
@group(0) @binding(5) var<storage, read> offsets: array<u32>;
// State of each instance after the last frame: its InstanceLod, the number of frames for which it has been visible (at most 2),
// and its weights.
@group(0) @binding(6) var<storage, read_write> skinned: array<u32>;
// Out: pairs to be skinned, cluster * instances + instance. With KEEP, the state of every pair follows: `CLUSTER_STILL`,
// `CLUSTER_MOVED` or `CLUSTER_FRESH`.
@group(0) @binding(7) var<storage, read_write> pairs: array<u32>;
// Arguments of the skinning dispatch.
@group(0) @binding(8) var<storage, read_write> dispatched: Dispatched;

// Number of clusters at a level of detail.
fn clusters_of(level: u32) -> u32 {
    let at = min(level, MAX_LEVELS - 1u);
    return params.levels[at >> 2u][at & 3u];
}

// Stores the state of one instance for the next frame. The first thread also writes the arguments of the dispatch.
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

// Whether the cluster must be morphed again: targets move one of its vertices, and a weight of the instance has changed. `last`
// is the index of the instance's state in `skinned`.
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
    var found = bitcast<u32>(now.influence_fade) != skinned[last] || now.max_influences != skinned[last + 1u]
        || cluster >= clusters_of(skinned[last + 2u]) || now.tier != skinned[last + 3u];
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
