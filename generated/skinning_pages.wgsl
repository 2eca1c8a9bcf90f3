// relievo skinning/pages: generated from kernels/skinning/pages.wgsl

struct InstanceLod {
    influence_fade: f32,
    max_influences: u32,
    mesh_lod: u32,
    tier: u32
}

const MAX_LEVELS: u32 = 16u;

const NO_PAGE: u32 = 4294967295u;

const LANES = 64u;

struct PageParams {
    instances: u32,
    clusters: u32,
    levels: array<vec4<u32>, MAX_LEVELS / 4u>
}

struct PageState {
    free: u32,
    short: u32
}

@group(0) @binding(0)
var<uniform> params: PageParams;

@group(0) @binding(1)
var<storage, read> instance_lods: array<InstanceLod>;

@group(0) @binding(2)
var<storage, read_write> held: array<u32>;

@group(0) @binding(3)
var<storage, read_write> table: array<u32>;

@group(0) @binding(4)
var<storage, read_write> stack: array<u32>;

@group(0) @binding(5)
var<storage, read_write> state: PageState;

var<workgroup> sums: array<vec2<u32>, LANES>;

var<workgroup> short_lanes: array<u32, LANES>;

fn needed(instance: u32) -> u32 {
    let lod = instance_lods[instance];
    let level = min(lod.mesh_lod, MAX_LEVELS - 1u);
    return select(params.levels[level >> 2u][level & 3u], 0u, lod.max_influences == 0u);
}

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
    top = was_free + scanned.z - min(scanned.y, was_free + scanned.z);
    var short = 0u;
    for (var instance = first; instance < end; instance++) {
        let needs = needed(instance);
        var has = min(held[instance], needs);
        while (has < needs && top > 0u) {
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
