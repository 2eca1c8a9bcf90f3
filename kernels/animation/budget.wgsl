// Selects the bones to sample when their number is limited: the bones whose outdated transforms are expected to be most
// visible. There are five stages, one dispatch each. Bones of equal rank are served in the order of instances and slots, so
// that every device decides identically.
import package::wgsl::animation::gate_state::{Lod, lod_flags_tier, UPDATE_REASON_FORCED, UPDATE_REASON_FREE, UPDATE_REASON_HIDDEN, ClipClock, fraction_of, update_reason_of};
import package::wgsl::animation::motion::{motion_at, motion_between};
import package::wgsl::dispatch::nonuniform;

// Stage of the kernel: one of the constants below.
override STAGE: u32 = 0;

// Stage: a thread ranks up to 32 bones of one instance and counts the ranks.
const RANK = 0u;
// Stage: one workgroup finds the lowest rank that is served.
const CHOOSE = 1u;
// Stage: a thread selects the bones above the lowest served rank and counts the bones of the lowest served rank.
const DECIDE = 2u;
// Stage: one workgroup computes prefix sums, over the instances, of the numbers of bones of the lowest served rank.
const SUM = 3u;
// Stage: a thread selects bones of the lowest served rank while the budget lasts.
const SETTLE = 4u;

// Number of threads in a workgroup.
const WIDTH = 64u;
// Number of ranks; higher ranks are served first.
const RANKS = 1024u;

// Parameters of the kernel `animation/budget`.
struct BudgetParams {
    // Number of instances.
    instances: u32,
    // Number of bones per instance.
    bones: u32,
    // Number of 32-bit words per instance. Each bone has one bit.
    words: u32,
    // Number of entries per row of the table.
    stride: u32,
    // Largest number of bones that may be sampled in a frame.
    budget: u32,
    // Number of clips.
    clips: u32,
    // Number of skeleton tiers.
    tiers: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: BudgetParams;
// Level of detail of each instance.
@group(0) @binding(1) var<storage, read> lods: array<Lod>;
// Clip clock of each instance.
@group(0) @binding(2) var<storage, read> clip_clocks: array<ClipClock>;
// Per skeleton tier and clip: the index of the clip's last row in `table`, then one bit per bone of the tier that the clip moves.
// After all tiers, two bit sets per tier: all of its bones, and the bones that no gate skips.
@group(0) @binding(3) var<storage, read> animated_bones: array<u32>;
// Per row and bone: the accumulated motion (x) and its increase up to the next row (y). In a clip's last row, x is the motion
// over the whole clip.
@group(0) @binding(4) var<storage, read> table: array<vec2<u32>>;
// Accumulated motion of each bone of each instance when the bone was last sampled.
@group(0) @binding(5) var<storage, read_write> sampled: array<u32>;
// Out: the bones that are sampled, one bit per bone. A second section in the same layout is for bones that are sampled ahead.
// All its bits become 0.
@group(0) @binding(6) var<storage, read_write> bits: array<u32>;
// Ranks of bones: for each word of `bits`, 16 words with two ranks each. Then one bit per bone, set for bones of the lowest
// rank that is served.
@group(0) @binding(7) var<storage, read_write> ranks: array<u32>;
// Number of bones of each rank; then the values at the indices FORCED, LOWEST and ROOM. From TIES on: per instance, the number
// of bones of the lowest served rank.
@group(0) @binding(8) var<storage, read_write> tally: array<atomic<u32>>;

// Index in `tally`: number of bones that must be sampled.
const FORCED = 1024u;
// Index in `tally`: the lowest rank that is served.
const LOWEST = 1025u;
// Index in `tally`: number of bones of the lowest rank that the budget permits.
const ROOM = 1026u;
// Index in `tally`: number of bones of the lowest rank in the first instance. The numbers of the other instances follow.
const TIES = 1027u;

// Sum of counts per thread.
var<workgroup> sums: array<u32, WIDTH>;

// Up to 32 bones of one instance, which share a word of bits.
struct WordOfBones {
    // Index of the instance.
    instance: u32,
    // Slot of the first of these bones in the instance.
    slot: u32,
    // Bones that may be sampled, one bit each.
    candidates: u32,
    // Bones that must be sampled, one bit each.
    forced: u32,
    // Row of the table with the motion over the whole clip.
    periods: u32,
    // Clip clock of the instance.
    clip_clock: ClipClock,
}

// The bones of a word of bits. `index` is the word's index among all instances.
fn word_of_bones_at(index: u32) -> WordOfBones {
    let instance = index / params.words;
    let word = index - instance * params.words;
    let clip_clock = clip_clocks[instance];
    let reason = update_reason_of(clip_clock);
    let tier = lod_flags_tier(lods[instance].flags);
    let record = (tier * params.clips + clip_clock.clip) * (params.words + 1u);
    let sets = params.tiers * params.clips * (params.words + 1u) + 2u * tier * params.words + word;
    let moving = animated_bones[record + 1u + word];
    let always = animated_bones[sets + params.words];
    let candidates = select(moving & ~always, 0u, reason != UPDATE_REASON_FREE);
    let forced = select(select(moving & always, 0u, reason == UPDATE_REASON_HIDDEN), animated_bones[sets], reason >= UPDATE_REASON_FORCED);
    return WordOfBones(instance, 32u * word, candidates, forced, animated_bones[record], clip_clock);
}

// Whether the budget permits all bones of all instances.
fn is_unlimited(index: u32) -> bool {
    return params.budget >= nonuniform(params.instances * params.bones, index);
}

// Rank, 1 to 768, of the product missed * weight on a logarithmic scale: sixteen ranks per octave.
fn rank_of(missed: u32, weight: u32) -> u32 {
    let low = (missed & 0xffffu) * weight;
    let high = (missed >> 16u) * weight + (low >> 16u);
    if high > 0u {
        let lead = firstLeadingBit(high);
        var fine = high >> (max(lead, 4u) - 4u);
        if lead < 4u {
            fine = (high << (4u - lead)) | ((low & 0xffffu) >> (12u + lead));
        }
        return 1u + 16u * (16u + lead) + (fine & 15u);
    }
    if low == 0u {
        return 1u;
    }
    let lead = firstLeadingBit(low);
    let fine = select(low << (4u - min(lead, 4u)), low >> (max(lead, 4u) - 4u), lead >= 4u);
    return 1u + 16u * lead + (fine & 15u);
}

// Accumulated motion of a bone at the current time.
fn motion_now(word_of_bones: WordOfBones, bit: u32) -> u32 {
    return motion_at(table[word_of_bones.clip_clock.row * params.stride + word_of_bones.slot + bit], fraction_of(word_of_bones.clip_clock));
}

// Motion of a bone since it was last sampled. `last` is the accumulated motion at that time.
fn missed_by(word_of_bones: WordOfBones, bit: u32, last: u32) -> u32 {
    let period = table[word_of_bones.periods * params.stride + word_of_bones.slot + bit].x;
    return motion_between(motion_now(word_of_bones, bit), last, period);
}

// Stage RANK for one word of bones.
fn rank(index: u32) {
    let word_of_bones = word_of_bones_at(index);
    if word_of_bones.slot == 0u {
        atomicStore(&tally[TIES + word_of_bones.instance], 0u);
    }
    if word_of_bones.forced != 0u {
        atomicAdd(&tally[FORCED], countOneBits(word_of_bones.forced));
    }
    if is_unlimited(index) {
        return;
    }
    let weight = lods[word_of_bones.instance].weight;
    let own = word_of_bones.instance * params.bones + word_of_bones.slot;
    for (var two = 0u; two < 16u; two++) {
        var both = 0u;
        for (var bit = 2u * two; bit < 2u * two + 2u; bit++) {
            if (word_of_bones.candidates & (1u << bit)) == 0u {
                continue;
            }
            let missed = missed_by(word_of_bones, bit, sampled[own + bit]);
            if missed > 0u {
                let rank = rank_of(missed, weight);
                both |= rank << (16u * (bit & 1u));
                atomicAdd(&tally[rank], 1u);
            }
        }
        ranks[16u * index + two] = both;
    }
}

// Stage CHOOSE: finds the lowest rank that is served, and clears the counts.
fn choose(lane: u32) {
    let chunk = RANKS / WIDTH;
    let first = chunk * lane;
    var sum = 0u;
    for (var at = first; at < first + chunk; at++) {
        sum += atomicLoad(&tally[at]);
    }
    sums[lane] = sum;
    workgroupBarrier();
    if lane == 0u {
        // Number of bones that the budget permits besides the forced bones.
        var room = params.budget - min(atomicExchange(&tally[FORCED], 0u), params.budget);
        var block = WIDTH;
        while block > 0u && sums[block - 1u] <= room {
            block--;
            room -= sums[block];
        }
        // Rank 0 stands for no motion and is never served.
        var lowest = 0u;
        if block > 0u {
            lowest = chunk * block - 1u;
            var count = atomicLoad(&tally[lowest]);
            while count <= room {
                room -= count;
                lowest--;
                count = atomicLoad(&tally[lowest]);
            }
        }
        atomicStore(&tally[LOWEST], lowest);
        atomicStore(&tally[ROOM], select(room, 0u, lowest == 0u));
    }
    workgroupBarrier();
    for (var at = first; at < first + chunk; at++) {
        atomicStore(&tally[at], 0u);
    }
}

// Stage DECIDE for one word of bones.
fn decide(index: u32) {
    let word_of_bones = word_of_bones_at(index);
    let lowest = atomicLoad(&tally[LOWEST]);
    var above = word_of_bones.forced;
    var equal = 0u;
    if is_unlimited(index) {
        above |= word_of_bones.candidates;
    } else {
        for (var two = 0u; two < 16u; two++) {
            let both = ranks[16u * index + two];
            let pair = vec2<u32>(both & 0xffffu, both >> 16u);
            above |= (u32(pair.x > lowest) | (u32(pair.y > lowest) << 1u)) << (2u * two);
            equal |= (u32(pair.x == lowest) | (u32(pair.y == lowest) << 1u)) << (2u * two);
        }
        equal = select(equal, 0u, lowest == 0u);
    }
    bits[index] = above;
    bits[params.instances * params.words + index] = 0u;
    ranks[16u * params.instances * params.words + index] = equal;
    if equal != 0u {
        atomicAdd(&tally[TIES + word_of_bones.instance], countOneBits(equal));
    }
}

// Stage SUM: replaces the counts from TIES on by their exclusive prefix sums.
fn sum_ties(lane: u32) {
    let chunk = (params.instances + WIDTH - 1u) / WIDTH;
    let first = min(lane * chunk, params.instances);
    let end = min(first + chunk, params.instances);
    var sum = 0u;
    for (var instance = first; instance < end; instance++) {
        sum += atomicLoad(&tally[TIES + instance]);
    }
    sums[lane] = sum;
    workgroupBarrier();
    var before = 0u;
    for (var other = 0u; other < lane; other++) {
        before += sums[other];
    }
    for (var instance = first; instance < end; instance++) {
        before += atomicExchange(&tally[TIES + instance], before);
    }
}

// Stage SETTLE for one word of bones. Also stores the accumulated motion of the selected bones.
fn settle(index: u32) {
    let word_of_bones = word_of_bones_at(index);
    let first_ties = 16u * params.instances * params.words;
    var before = atomicLoad(&tally[TIES + word_of_bones.instance]);
    for (var word = index - word_of_bones.slot / 32u; word < index; word++) {
        before += countOneBits(ranks[first_ties + word]);
    }
    let room = atomicLoad(&tally[ROOM]);
    var chosen = bits[index];
    var waiting = ranks[first_ties + index];
    while waiting != 0u && before < room {
        chosen |= waiting & (~waiting + 1u);
        waiting &= waiting - 1u;
        before++;
    }
    bits[index] = chosen;
    let own = word_of_bones.instance * params.bones + word_of_bones.slot;
    while chosen != 0u {
        let bit = firstTrailingBit(chosen);
        chosen &= chosen - 1u;
        sampled[own + bit] = motion_now(word_of_bones, bit);
    }
}

@compute @workgroup_size(WIDTH)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * WIDTH + id.x;
    if STAGE == CHOOSE {
        choose(index);
    } else if STAGE == SUM {
        sum_ties(index);
    } else if index < params.instances * params.words {
        if STAGE == RANK {
            rank(index);
        } else if STAGE == DECIDE {
            decide(index);
        } else {
            settle(index);
        }
    }
}
