// relievo animation/budget: generated from kernels/animation/budget.wgsl

struct Lod {
    omega: u32,
    allowed: u32,
    weight: u32,
    flags: u32
}

const LOD_HIDDEN: u32 = 1u;

const LOD_FORCED: u32 = 2u;

const OMEGA_ONE: u32 = 65536u;

const FULL_WEIGHT: u32 = 65535u;

struct ClipClock {
    row: u32,
    fraction_and_reason: u32,
    clip: u32,
    ahead_row: u32,
    ahead_fraction: u32
}

const FRACTION_ONE: u32 = 65536u;

const UPDATE_REASON_FREE: u32 = 0u;

const UPDATE_REASON_HIDDEN: u32 = 1u;

const UPDATE_REASON_FORCED: u32 = 2u;

const UPDATE_REASON_BLENDED: u32 = 3u;

fn update_reason_of(clip_clock: ClipClock) -> u32 {
    return progress_reason(clip_clock.fraction_and_reason);
}

fn is_ahead(clip_clock: ClipClock) -> bool {
    return clip_clock.ahead_row != clip_clock.row || clip_clock.ahead_fraction != fraction_of(clip_clock);
}

fn fraction_of(clip_clock: ClipClock) -> u32 {
    return progress_fraction(clip_clock.fraction_and_reason);
}

const PAIR_AHEAD: u32 = 2147483648u;

fn progress_word(fraction: u32, reason: u32) -> u32 {
    return fraction | (reason << 20u);
}

fn progress_fraction(word: u32) -> u32 {
    return word & 1048575u;
}

fn progress_reason(word: u32) -> u32 {
    return word >> 20u;
}

fn lod_flags_word(bits: u32, tier: u32) -> u32 {
    return bits | (tier << 8u);
}

fn lod_flags_bits(word: u32) -> u32 {
    return word & 255u;
}

fn lod_flags_tier(word: u32) -> u32 {
    return (word >> 8u) & 255u;
}

fn scale_by_fraction(value: u32, fraction: u32) -> u32 {
    return (value >> 16u) * fraction + (((value & 65535u) * (fraction & 65535u)) >> 16u) + (value & 65535u) * (fraction >> 16u);
}

fn motion_at(row: vec2<u32>, fraction: u32) -> u32 {
    return row.x + scale_by_fraction(row.y, fraction);
}

fn motion_between(now: u32, last: u32, period: u32) -> u32 {
    let direct = max(now, last) - min(now, last);
    return min(direct, max(period, direct) - direct);
}

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

override STAGE: u32 = 0;

const RANK = 0u;

const CHOOSE = 1u;

const DECIDE = 2u;

const SUM = 3u;

const SETTLE = 4u;

const WIDTH = 64u;

const RANKS = 1024u;

struct BudgetParams {
    instances: u32,
    bones: u32,
    words: u32,
    stride: u32,
    budget: u32,
    clips: u32,
    tiers: u32
}

@group(0) @binding(0)
var<uniform> params: BudgetParams;

@group(0) @binding(1)
var<storage, read> lods: array<Lod>;

@group(0) @binding(2)
var<storage, read> clip_clocks: array<ClipClock>;

@group(0) @binding(3)
var<storage, read> animated_bones: array<u32>;

@group(0) @binding(4)
var<storage, read> table: array<vec2<u32>>;

@group(0) @binding(5)
var<storage, read_write> sampled: array<u32>;

@group(0) @binding(6)
var<storage, read_write> bits: array<u32>;

@group(0) @binding(7)
var<storage, read_write> ranks: array<u32>;

@group(0) @binding(8)
var<storage, read_write> tally: array<atomic<u32>>;

const FORCED = 1024u;

const LOWEST = 1025u;

const ROOM = 1026u;

const TIES = 1027u;

var<workgroup> sums: array<u32, WIDTH>;

struct WordOfBones {
    instance: u32,
    slot: u32,
    candidates: u32,
    forced: u32,
    periods: u32,
    clip_clock: ClipClock
}

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

fn is_unlimited(index: u32) -> bool {
    return params.budget >= nonuniform(params.instances * params.bones, index);
}

fn rank_of(missed: u32, weight: u32) -> u32 {
    let low = (missed & 65535u) * weight;
    let high = (missed >> 16u) * weight + (low >> 16u);
    if high > 0u {
        let lead = firstLeadingBit(high);
        var fine = high >> (max(lead, 4u) - 4u);
        if lead < 4u {
            fine = (high << (4u - lead)) | ((low & 65535u) >> (12u + lead));
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

fn motion_now(word_of_bones: WordOfBones, bit: u32) -> u32 {
    return motion_at(table[word_of_bones.clip_clock.row * params.stride + word_of_bones.slot + bit], fraction_of(word_of_bones.clip_clock));
}

fn missed_by(word_of_bones: WordOfBones, bit: u32, last: u32) -> u32 {
    let period = table[word_of_bones.periods * params.stride + word_of_bones.slot + bit].x;
    return motion_between(motion_now(word_of_bones, bit), last, period);
}

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
        var room = params.budget - min(atomicExchange(&tally[FORCED], 0u), params.budget);
        var block = WIDTH;
        while (block > 0u && sums[block - 1u] <= room) {
            block--;
            room -= sums[block];
        }
        var lowest = 0u;
        if block > 0u {
            lowest = chunk * block - 1u;
            var count = atomicLoad(&tally[lowest]);
            while (count <= room) {
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

fn decide(index: u32) {
    let word_of_bones = word_of_bones_at(index);
    let lowest = atomicLoad(&tally[LOWEST]);
    var above = word_of_bones.forced;
    var equal = 0u;
    if is_unlimited(index) {
        above |= word_of_bones.candidates;
    }
    else {
        for (var two = 0u; two < 16u; two++) {
            let both = ranks[16u * index + two];
            let pair = vec2<u32>(both & 65535u, both >> 16u);
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
    while (waiting != 0u && before < room) {
        chosen |= waiting & (~waiting + 1u);
        waiting &= waiting - 1u;
        before++;
    }
    bits[index] = chosen;
    let own = word_of_bones.instance * params.bones + word_of_bones.slot;
    while (chosen != 0u) {
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
    }
    else if STAGE == SUM {
        sum_ties(index);
    }
    else if index < params.instances * params.words {
        if STAGE == RANK {
            rank(index);
        }
        else if STAGE == DECIDE {
            decide(index);
        }
        else {
            settle(index);
        }
    }
}
