// Which clusters of which instances are skinned: those with a bone that moved, and those of instances whose reduction
// changed. A thread decides for one cluster. With FINISH, a thread takes note of one instance's reduction, and the
// first one writes the arguments of the dispatch.
import package::wgsl::dispatch::rows_of_workgroups;

override FINISH: bool = false;

struct SelectParams {
    instances: u32,
    clusters: u32,
    // Words of a set of bones.
    words: u32,
    // The most workgroups along x.
    most: u32,
}

@group(0) @binding(0) var<uniform> params: SelectParams;
// The bones of each cluster, a bit a bone.
@group(0) @binding(1) var<storage, read> masks: array<u32>;
// The bones of each instance that moved, likewise.
@group(0) @binding(2) var<storage, read> moved: array<u32>;
// Of each instance: now, and when it was skinned last.
@group(0) @binding(3) var<storage, read> reductions: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read_write> skinned: array<vec2<u32>>;
// cluster * instances + instance, of those to be skinned.
@group(0) @binding(5) var<storage, read_write> pairs: array<u32>;
@group(0) @binding(6) var<storage, read_write> count: atomic<u32>;
// Workgroups of the dispatch, and how many pairs.
@group(0) @binding(7) var<storage, read_write> dispatched: vec4<u32>;

fn finish(index: u32) {
    if index < params.instances {
        skinned[index] = reductions[index];
    }
    if index == 0u {
        let all = atomicExchange(&count, 0u);
        dispatched = vec4<u32>(rows_of_workgroups(all, params.most), all);
    }
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if FINISH {
        finish(index);
        return;
    }
    let cluster = index / params.instances;
    if cluster >= params.clusters {
        return;
    }
    let instance = index - cluster * params.instances;
    var found = any(reductions[instance] != skinned[instance]);
    for (var word = 0u; word < params.words && !found; word++) {
        found = (masks[cluster * params.words + word] & moved[instance * params.words + word]) != 0u;
    }
    if found {
        pairs[atomicAdd(&count, 1u)] = index;
    }
}
