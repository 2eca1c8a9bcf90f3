// Assignment of pages, which hold skinned vertices. A visible instance holds one page per cluster of its level of detail, and
// gives back pages that it no longer needs. One workgroup serves all instances, so that every execution hands out the same
// pages.
import package::wgsl::skinning::instance_lod::{InstanceLod, MAX_LEVELS};
import package::wgsl::skinning::page::NO_PAGE;

// Number of threads of the workgroup.
const LANES = 64u;

// Parameters of the kernel `skinning/pages`.
struct PageParams {
    // Number of instances.
    instances: u32,
    // Number of clusters of the mesh, and of table entries per instance.
    clusters: u32,
    // Number of clusters of the mesh at each level of detail.
    levels: array<vec4<u32>, MAX_LEVELS / 4u>,
}

// State of the page assignment.
struct PageState {
    // Number of free pages, whose indices are at the bottom of the stack.
    free: u32,
    // Number of instances that lacked a page in the last frame. The number is 0, because the host provides enough pages.
    short: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: PageParams;
// Level of detail of each instance.
@group(0) @binding(1) var<storage, read> instance_lods: array<InstanceLod>;
// Number of clusters of each instance that have a page, counted from the first cluster.
@group(0) @binding(2) var<storage, read_write> held: array<u32>;
// Page of each cluster of each instance, or `NO_PAGE`.
@group(0) @binding(3) var<storage, read_write> table: array<u32>;
// Stack of the indices of free pages. The last one is handed out first.
@group(0) @binding(4) var<storage, read_write> stack: array<u32>;
// State of the page assignment.
@group(0) @binding(5) var<storage, read_write> state: PageState;

// Number of pages given back (x) and taken (y) by the instances of each thread.
var<workgroup> sums: array<vec2<u32>, LANES>;
// Number of instances of each thread that lack a page.
var<workgroup> short_lanes: array<u32, LANES>;

// Number of clusters for which an instance needs a page; 0 if the instance is invisible.
fn needed(instance: u32) -> u32 {
    let lod = instance_lods[instance];
    let level = min(lod.mesh_lod, MAX_LEVELS - 1u);
    return select(params.levels[level >> 2u][level & 3u], 0u, lod.max_influences == 0u);
}

// Sums of `sums` over the threads before this one (xy), and over all threads (zw).
fn before(lane: u32) -> vec4<u32> {
    var mine = vec2<u32>(0u);
    var all = vec2<u32>(0u);
    for (var other = 0u; other < LANES; other++) {
        mine += select(vec2<u32>(0u), sums[other], other < lane);
        all += sums[other];
    }
    return vec4<u32>(mine, all);
}

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
    let chunk = (params.instances + LANES - 1u) / LANES;
    let first = min(lane * chunk, params.instances);
    let end = min(first + chunk, params.instances);
    let was_free = state.free;
    var sum = vec2<u32>(0u);
    for (var instance = first; instance < end; instance++) {
        let has = held[instance];
        let needs = needed(instance);
        sum += vec2<u32>(has - min(has, needs), needs - min(has, needs));
    }
    sums[lane] = sum;
    workgroupBarrier();
    let scanned = before(lane);
    var top = was_free + scanned.x;
    for (var instance = first; instance < end; instance++) {
        let needs = needed(instance);
        for (var cluster = held[instance]; cluster > needs; cluster--) {
            let entry = instance * params.clusters + cluster - 1u;
            stack[top] = table[entry];
            table[entry] = NO_PAGE;
            top++;
        }
    }
    storageBarrier();
    // The stack shrinks from its top. Each thread takes the pages below the pages of the threads before it.
    top = was_free + scanned.z - min(scanned.y, was_free + scanned.z);
    var short = 0u;
    for (var instance = first; instance < end; instance++) {
        let needs = needed(instance);
        var has = min(held[instance], needs);
        while has < needs && top > 0u {
            top--;
            table[instance * params.clusters + has] = stack[top];
            has++;
        }
        short += u32(has < needs);
        held[instance] = has;
    }
    short_lanes[lane] = short;
    workgroupBarrier();
    if lane == 0u {
        state.free = was_free + scanned.z - min(scanned.w, was_free + scanned.z);
        var all_short = 0u;
        for (var other = 0u; other < LANES; other++) {
            all_short += short_lanes[other];
        }
        state.short = all_short;
    }
}
