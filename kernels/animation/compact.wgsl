// From bits to lists: the pairs of instance and bone that are active, the slots that are dirty since a bone above them is
// active, the instances with any, and the arguments of the dispatches that serve them. Lists keep the order of the
// instances and, within one, of its slots, on every device. Three stages, a dispatch each, or all in one.

import package::wgsl::dispatch::rows_of_workgroups;

// One of the constants below.
override STAGE: u32 = 0;

// A thread spreads the active bits of one instance to all slots below them, and counts them.
const SPREAD = 0u;
// One workgroup sums the counts, lists the instances and writes the arguments.
const SCAN = 1u;
// A thread lists the pairs of one word.
const SCATTER = 2u;
// One workgroup does all of it: for small crowds where a dispatch costs more than a second processor gains.
const ALL = 3u;

const WIDTH = 64u;

struct CompactParams {
    instances: u32,
    bones: u32,
    // Words of bits an instance.
    words: u32,
    // Dispatches beyond the first that serve dirty instances.
    served: u32,
    // Most workgroups along x.
    most_groups: u32,
}

@group(0) @binding(0) var<uniform> params: CompactParams;
// A bit for each slot of each instance.
@group(0) @binding(1) var<storage, read> bits: array<u32>;
// Bone, parent, slots of the subtree.
@group(0) @binding(2) var<storage, read> slots: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read_write> dirty: array<u32>;
// Active pairs of each instance, then of all before it.
@group(0) @binding(4) var<storage, read_write> counts: array<u32>;
// instance * bones + bone.
@group(0) @binding(5) var<storage, read_write> pairs: array<u32>;
// Workgroups along x, y, z for a thread a pair; how many.
@group(0) @binding(6) var<storage, read_write> pair_dispatch: array<vec4<u32>, 1>;
@group(0) @binding(7) var<storage, read_write> dirty_instances: array<u32>;
// Likewise for a thread a dirty instance; then, where w says how many, for as many threads a dirty instance.
@group(0) @binding(8) var<storage, read_write> instance_dispatches: array<vec4<u32>>;

var<workgroup> sums: array<vec2<u32>, WIDTH>;

// Bits from `start` to below `end`, both within 0..=32.
fn run(start: u32, end: u32) -> u32 {
    let below = select(0xffffffffu, (1u << (end & 31u)) - 1u, end < 32u);
    return below & (0xffffffffu << start);
}

fn spread(instance: u32) {
    if instance >= params.instances {
        return;
    }
    var count = 0u;
    // The slot after the last dirty one so far.
    var end = 0u;
    for (var word = 0u; word < params.words; word++) {
        let first = 32u * word;
        let chosen = bits[instance * params.words + word];
        count += countOneBits(chosen);
        var below = 0u;
        if end > first {
            below = run(0u, min(end - first, 32u));
        }
        var rest = chosen & ~below;
        while rest != 0u {
            let bit = firstTrailingBit(rest);
            end = first + bit + slots[first + bit].z;
            below |= run(bit, min(end - first, 32u));
            rest &= ~below;
        }
        dirty[instance * params.words + word] = below;
    }
    counts[instance] = count;
}

fn dispatch_of(threads: u32) -> vec3<u32> {
    return rows_of_workgroups(threads / WIDTH + u32(threads % WIDTH > 0u), params.most_groups);
}

// The instances of a lane of one workgroup, from x to below y.
fn share_of(lane: u32) -> vec2<u32> {
    let share = (params.instances + WIDTH - 1u) / WIDTH;
    let first = min(lane * share, params.instances);
    return vec2<u32>(first, min(first + share, params.instances));
}

fn scan(lane: u32) {
    let own = share_of(lane);
    var sum = vec2<u32>(0u);
    for (var instance = own.x; instance < own.y; instance++) {
        let count = counts[instance];
        sum += vec2<u32>(count, u32(count > 0u));
    }
    sums[lane] = sum;
    workgroupBarrier();
    var before = vec2<u32>(0u);
    for (var other = 0u; other < lane; other++) {
        before += sums[other];
    }
    for (var instance = own.x; instance < own.y; instance++) {
        let count = counts[instance];
        counts[instance] = before.x;
        if count > 0u {
            dirty_instances[before.y] = instance;
        }
        before += vec2<u32>(count, u32(count > 0u));
    }
    if lane == WIDTH - 1u {
        pair_dispatch[0] = vec4<u32>(dispatch_of(before.x), before.x);
        instance_dispatches[0] = vec4<u32>(dispatch_of(before.y), before.y);
        for (var at = 1u; at <= params.served; at++) {
            let each = instance_dispatches[at].w;
            instance_dispatches[at] = vec4<u32>(dispatch_of(before.y * each), each);
        }
    }
}

fn scatter(index: u32) {
    let instance = index / params.words;
    if instance >= params.instances {
        return;
    }
    let first_word = instance * params.words;
    var at = counts[instance];
    for (var word = first_word; word < index; word++) {
        at += countOneBits(bits[word]);
    }
    let first = 32u * (index - first_word);
    var rest = bits[index];
    while rest != 0u {
        pairs[at] = instance * params.bones + slots[first + firstTrailingBit(rest)].x;
        rest &= rest - 1u;
        at++;
    }
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * WIDTH + lane;
    if STAGE == SPREAD {
        spread(index);
    } else if STAGE == SCAN {
        scan(lane);
    } else if STAGE == ALL {
        let own = share_of(lane);
        for (var instance = own.x; instance < own.y; instance++) {
            spread(instance);
        }
        scan(lane);
        for (var word = own.x * params.words; word < own.y * params.words; word++) {
            scatter(word);
        }
    } else {
        scatter(index);
    }
}
