// Turns bits into lists: the active pairs of instance and bone, and the instances with active pairs. Also marks the slots that
// must be updated, which are the slots of active bones and all slots below them. Writes the arguments of the indirect
// dispatches. On every device, lists are in the order of instances and, within an instance, of slots. There are three stages,
// one dispatch each.
import package::wgsl::animation::gate_state::PAIR_AHEAD;
import package::wgsl::animation::order::Slot;
import package::wgsl::dispatch::{nonuniform, rows_of_workgroups};

// Stage of the kernel: one of the constants below.
override STAGE: u32 = 0;

// Stage: a thread spreads the active bits of one instance to all slots below them, and counts the active bits.
const SPREAD = 0u;
// Stage: one workgroup sums the counts, lists the instances and writes the arguments.
const SCAN = 1u;
// Stage: a thread lists the pairs of one word of bits.
const SCATTER = 2u;

// Number of threads in a workgroup.
const WIDTH = 64u;

// Parameters of the kernel `animation/compact`.
struct CompactParams {
    // Number of instances.
    instances: u32,
    // Number of bones per instance.
    bones: u32,
    // Number of 32-bit words per instance. Each slot has one bit.
    words: u32,
    // Number of dispatches, besides the first one, that handle updated instances.
    served: u32,
    // Largest number of workgroups along x.
    most_groups: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: CompactParams;
// Three bit sets of the same layout, each with one bit per bone of each instance, in the order of bones: the bones that are
// sampled, those of them that are sampled ahead, and the bones whose model matrices this frame updates.
@group(0) @binding(1) var<storage, read_write> bits: array<u32>;
// Bones in their order, parents first.
@group(0) @binding(2) var<storage, read> slots: array<Slot>;
// Updated bones, one bit per slot of each instance. The bits accumulate over frames until all readers have processed them.
@group(0) @binding(3) var<storage, read_write> updated_bones: array<u32>;
// Per instance. In: the number of active pairs. Out, after SCAN: the number of active pairs of all preceding instances.
@group(0) @binding(4) var<storage, read_write> counts: array<u32>;
// Out: active pairs, instance * bones + bone, with PAIR_AHEAD if the bone is sampled ahead.
@group(0) @binding(5) var<storage, read_write> pairs: array<u32>;
// Out: numbers of workgroups along x, y and z for one thread per pair, and the number of pairs (w).
@group(0) @binding(6) var<storage, read_write> pair_dispatch: array<vec4<u32>, 1>;
// Out: indices of the instances with active pairs.
@group(0) @binding(7) var<storage, read_write> updated_instances: array<u32>;
// Out: dispatches, as numbers of workgroups along x, y and z. The first dispatch has one thread per updated instance; its w is
// the number of updated instances. Every other dispatch has several threads per updated instance. Its w is this number of
// threads, which is also an input.
@group(0) @binding(8) var<storage, read_write> instance_dispatches: array<vec4<u32>>;

// Sum per thread: active pairs (x) and updated instances (y).
var<workgroup> sums: array<vec2<u32>, WIDTH>;

// Mask of the bits from `start` to below `end`, both within 0..=32.
fn run(start: u32, end: u32) -> u32 {
    let below = select(0xffffffffu, (1u << (end & 31u)) - 1u, end < 32u);
    return below & (0xffffffffu << start);
}

// Stage SPREAD for one instance.
fn spread(instance: u32) {
    let first_word = instance * params.words;
    let all_words = params.instances * params.words;
    var count = 0u;
    // End of the last updated subtree: the slot after the subtree's last slot.
    var end = 0u;
    let words = nonuniform(params.words, instance);
    for (var word = 0u; word < words; word++) {
        let chosen = bits[first_word + word];
        let first = 32u * word;
        var below = 0u;
        if end > first {
            below = run(0u, min(end - first, 32u));
        }
        var rest = chosen & ~below;
        while rest != 0u {
            let bit = firstTrailingBit(rest);
            end = first + bit + slots[first + bit].subtree;
            below |= run(bit, min(end - first, 32u));
            rest &= ~below;
        }
        bits[2u * all_words + first_word + word] = below;
        if below != 0u {
            updated_bones[first_word + word] |= below;
        }
        count += countOneBits(chosen);
    }
    counts[instance] = count;
}

// Numbers of workgroups along x, y and z for a number of threads.
fn dispatch_of(threads: u32) -> vec3<u32> {
    return rows_of_workgroups(threads / WIDTH + u32(threads % WIDTH > 0u), params.most_groups);
}

// Stage SCAN: prefix sums of the counts, the list of updated instances, and the arguments of dispatches.
fn scan(lane: u32) {
    let chunk = (params.instances + WIDTH - 1u) / WIDTH;
    let first = min(lane * chunk, params.instances);
    let end = min(first + chunk, params.instances);
    var sum = vec2<u32>(0u);
    for (var instance = first; instance < end; instance++) {
        let count = counts[instance];
        sum += vec2<u32>(count, u32(count > 0u));
    }
    sums[lane] = sum;
    workgroupBarrier();
    var before = vec2<u32>(0u);
    for (var other = 0u; other < lane; other++) {
        before += sums[other];
    }
    for (var instance = first; instance < end; instance++) {
        let count = counts[instance];
        counts[instance] = before.x;
        if count > 0u {
            updated_instances[before.y] = instance;
        }
        before += vec2<u32>(count, u32(count > 0u));
    }
    if lane == WIDTH - 1u {
        pair_dispatch[0] = vec4<u32>(dispatch_of(before.x), before.x);
        instance_dispatches[0] = vec4<u32>(dispatch_of(before.y), before.y);
        let served = nonuniform(params.served, lane);
        for (var at = 1u; at <= served; at++) {
            let each = instance_dispatches[at].w;
            instance_dispatches[at] = vec4<u32>(dispatch_of(before.y * each), each);
        }
    }
}

// Stage SCATTER for one word of bits.
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
    let first_slot = 32u * (index - first_word);
    let ahead = bits[params.instances * params.words + index];
    var rest = bits[index];
    while rest != 0u {
        let bit = firstTrailingBit(rest);
        let pair = instance * params.bones + slots[first_slot + bit].bone;
        pairs[at] = select(pair, pair | PAIR_AHEAD, (ahead & (1u << bit)) != 0u);
        rest &= rest - 1u;
        at++;
    }
}

@compute @workgroup_size(WIDTH)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * WIDTH + id.x;
    if STAGE == SCAN {
        scan(index);
    } else if STAGE == SCATTER {
        scatter(index);
    } else if index < params.instances {
        spread(index);
    }
}
