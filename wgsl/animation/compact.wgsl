// The steps that turn bits into lists, for kernels/animation/compact.wgsl.
import package::wgsl::animation::gated::bits::bits;
import package::wgsl::animation::gate_state::PAIR_AHEAD;
import package::wgsl::animation::order::Slot;
import package::wgsl::dispatch::rows_of_workgroups;

const WIDTH = 64u;

struct CompactParams {
    instances: u32,
    bones: u32,
    // Words of bits per instance.
    words: u32,
    // Number of dispatches, after the first, that handle updated instances.
    served: u32,
    // The largest number of workgroups along x.
    most_groups: u32,
}

@group(0) @binding(15) var<uniform> compact_params: CompactParams;
// Binding 14 holds the bits.
@group(0) @binding(16) var<storage, read> slots: array<Slot>;
// The updated bones of this frame and of those before, until readers have followed all of them.
@group(0) @binding(17) var<storage, read_write> updated_bones: array<u32>;
// The number of active pairs of each instance; after the scan, of all instances before it.
@group(0) @binding(18) var<storage, read_write> counts: array<u32>;
// instance * bones + bone, with PAIR_AHEAD if it is sampled ahead.
@group(0) @binding(19) var<storage, read_write> pairs: array<u32>;
// Workgroups along x, y and z for one thread per pair, and the number of pairs.
@group(0) @binding(20) var<storage, read_write> pair_dispatch: array<vec4<u32>, 1>;
@group(0) @binding(21) var<storage, read_write> updated_instances: array<u32>;
// The same for one thread per updated instance; then dispatches with several threads per updated instance, as
// many as w said before.
@group(0) @binding(22) var<storage, read_write> instance_dispatches: array<vec4<u32>>;

var<workgroup> sums: array<vec2<u32>, WIDTH>;

// A mask of the bits from `start` to below `end`, both within 0..=32.
fn run(start: u32, end: u32) -> u32 {
    let below = select(0xffffffffu, (1u << (end & 31u)) - 1u, end < 32u);
    return below & (0xffffffffu << start);
}

// State after the words of an instance so far.
struct Spread {
    // Number of chosen slots.
    count: u32,
    // The slot after the last updated one.
    end: u32,
}

// Spreads the chosen slots of the next word.
fn spread_word(instance: u32, word: u32, chosen: u32, so_far: Spread) -> Spread {
    let first = 32u * word;
    var end = so_far.end;
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
    let all_words = compact_params.instances * compact_params.words;
    let at = instance * compact_params.words + word;
    bits[2u * all_words + at] = below;
    if below != 0u {
        updated_bones[at] |= below;
    }
    return Spread(so_far.count + countOneBits(chosen), end);
}

// (No subtree ends beyond the last bone. Where uniforms alone decide a loop's end, lavapipe compiles the kernel anew in each
// submission; hence the second conditions of loops here.)
fn spread(instance: u32) {
    var so_far = Spread(0u, 0u);
    for (var word = 0u; word < compact_params.words && so_far.end <= compact_params.bones; word++) {
        so_far = spread_word(instance, word, bits[instance * compact_params.words + word], so_far);
    }
    counts[instance] = so_far.count;
}

fn dispatch_of(threads: u32) -> vec3<u32> {
    return rows_of_workgroups(threads / WIDTH + u32(threads % WIDTH > 0u), compact_params.most_groups);
}

// The instances of a lane of a single workgroup with `width` lanes: from x to below y.
fn instances_of(lane: u32, width: u32) -> vec2<u32> {
    let chunk = (compact_params.instances + width - 1u) / width;
    let first = min(lane * chunk, compact_params.instances);
    return vec2<u32>(first, min(first + chunk, compact_params.instances));
}

// The scan, for one workgroup of at most WIDTH lanes.
fn scan(lane: u32, width: u32) {
    let own = instances_of(lane, width);
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
            updated_instances[before.y] = instance;
        }
        before += vec2<u32>(count, u32(count > 0u));
    }
    if lane == width - 1u {
        pair_dispatch[0] = vec4<u32>(dispatch_of(before.x), before.x);
        instance_dispatches[0] = vec4<u32>(dispatch_of(before.y), before.y);
        for (var at = 1u; at <= compact_params.served && before.y <= compact_params.instances; at++) {
            let each = instance_dispatches[at].w;
            instance_dispatches[at] = vec4<u32>(dispatch_of(before.y * each), each);
        }
    }
}

// Lists the pairs of a word, starting at `start`. Returns where those of the next word begin.
fn list_word(instance: u32, word: u32, start: u32) -> u32 {
    let first_pair = instance * compact_params.bones;
    let first_slot = 32u * word;
    var at = start;
    let at_word = instance * compact_params.words + word;
    let ahead = bits[compact_params.instances * compact_params.words + at_word];
    var rest = bits[at_word];
    while rest != 0u {
        let bit = firstTrailingBit(rest);
        let pair = first_pair + slots[first_slot + bit].bone;
        pairs[at] = select(pair, pair | PAIR_AHEAD, (ahead & (1u << bit)) != 0u);
        rest &= rest - 1u;
        at++;
    }
    return at;
}

fn scatter(index: u32) {
    let instance = index / compact_params.words;
    if instance >= compact_params.instances {
        return;
    }
    let first_word = instance * compact_params.words;
    var at = counts[instance];
    for (var word = first_word; word < index; word++) {
        at += countOneBits(bits[word]);
    }
    list_word(instance, index - first_word, at);
}

// Lists all pairs of one instance.
fn list_instance(instance: u32) {
    var at = counts[instance];
    let end = compact_params.instances * compact_params.bones;
    for (var word = 0u; word < compact_params.words && at <= end; word++) {
        at = list_word(instance, word, at);
    }
}
