// relievo animation/gate: generated from kernels/animation/gate.wgsl

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

struct Slot {
    bone: u32,
    parent: u32,
    subtree: u32
}

struct Chain {
    first: u32,
    count: u32
}

const NO_PARENT: u32 = 4294967295u;

const CONTINUES: u32 = 4294967294u;

override MODE: u32 = 0;

const OFF = 0u;

const SKIP_PERIOD = 1u;

const UNIFORM = 2u;

const RANDOM = 3u;

const BOUNDED = 4u;

struct GateParams {
    instances: u32,
    bones: u32,
    words: u32,
    stride: u32,
    ticks: u32,
    frame_ticks: u32,
    period: u32,
    frame: u32,
    clips: u32,
    tiers: u32,
    first_above: u32
}

@group(0) @binding(0)
var<uniform> params: GateParams;

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
var<storage, read_write> remaining: array<u32>;

@group(0) @binding(7)
var<storage, read_write> bits: array<u32>;

const SCRAMBLE_FIRST: u32 = 569420461u;

const SCRAMBLE_SECOND: u32 = 1935289751u;

fn scramble(word: u32) -> u32 {
    var mixed = (word ^ (word >> 16u)) * SCRAMBLE_FIRST;
    mixed = (mixed ^ (mixed >> 15u)) * SCRAMBLE_SECOND;
    return mixed ^ (mixed >> 15u);
}

fn is_skipped(period: u32, ticks: u32) -> bool {
    return period <= params.frame_ticks || ticks % period < params.frame_ticks;
}

fn by_priority(instance: u32, first: u32, candidates: u32, omega: u32, clip_clock: ClipClock) -> u32 {
    let ticks = params.ticks + (scramble(instance) & 65535u);
    var chosen = candidates;
    var rest = candidates;
    while (rest != 0u) {
        let bit = firstTrailingBit(rest);
        rest &= rest - 1u;
        let slot = first + bit;
        let four = table[clip_clock.row * params.stride + slot / 4u];
        let two = select(four.x, four.y, (slot & 2u) != 0u);
        let priority = (two >> (16u * (slot & 1u))) & 65535u;
        let level = (priority * omega) >> 16u;
        let whole = (params.period >> 16u) * level;
        let period = whole + (((params.period & 65535u) * level) >> 16u);
        if is_skipped(period, ticks) {
            chosen &= ~(1u << bit);
        }
    }
    return chosen;
}

fn all_or_none(instance: u32, candidates: u32, omega: u32) -> u32 {
    let frame = (params.frame + scramble(instance)) & 65535u;
    let is_due = (frame * omega) >> 16u != ((frame + 1u) * omega) >> 16u;
    return select(0u, candidates, is_due);
}

fn at_random(instance: u32, first: u32, candidates: u32, omega: u32) -> u32 {
    var chosen = 0u;
    var rest = candidates;
    while (rest != 0u) {
        let bit = firstTrailingBit(rest);
        rest &= rest - 1u;
        let word = scramble(scramble(params.frame) + instance * params.bones + first + bit);
        if (word >> 16u) < omega {
            chosen |= 1u << bit;
        }
    }
    return chosen;
}

const EVERYTHING: u32 = 1u << 30u;

const BUDGET_FRACTION_SHIFT: u32 = 8u;

const BUDGET_SLACK_MASK: u32 = 31u;

const STARTS: u32 = 32u;

const REMAINING: u32 = 64u;

fn quantization_slack_of(granted: u32) -> u32 {
    return (1u << (granted & BUDGET_SLACK_MASK)) >> 1u;
}

struct Chosen {
    bits: u32,
    ahead: u32
}

struct AccumulatedMotion {
    allowed: u32,
    clip_clock: ClipClock,
    last_row: u32
}

fn by_motion(instance: u32, first: u32, candidates: u32, asked: u32, accumulated: AccumulatedMotion, left: ptr<function, u32>) -> Chosen {
    let forced = asked | select(0u, candidates, accumulated.allowed == 0u);
    let row = accumulated.clip_clock.row * params.stride + first;
    let ahead_row = accumulated.clip_clock.ahead_row * params.stride + first;
    let may_lead = is_ahead(accumulated.clip_clock);
    let last = accumulated.last_row * params.stride + first;
    let own = instance * params.bones;
    var chosen = Chosen(forced, 0u);
    var rest = candidates | forced;
    while (rest != 0u) {
        let bit = firstTrailingBit(rest);
        rest &= rest - 1u;
        let whole = table[last + bit];
        if (whole.y & STARTS) != 0u {
            let above = table[(params.first_above + accumulated.clip_clock.clip) * params.stride + first + bit].x;
            if above == NO_PARENT {
                *left = accumulated.allowed;
            }
            else {
                *left = remaining[own + above];
            }
        }
        let at = own + first + bit;
        let quantization_slack = quantization_slack_of(whole.y);
        let own_budget = scale_by_fraction(*left, whole.y >> BUDGET_FRACTION_SHIFT);
        let now = motion_at(table[row + bit], fraction_of(accumulated.clip_clock));
        let missed = motion_between(now, sampled[at], whole.x) + quantization_slack;
        let is_forced = (forced & (1u << bit)) != 0u;
        if is_forced || missed > own_budget {
            chosen.bits |= 1u << bit;
            var stored = now;
            if may_lead && !is_forced {
                let later = motion_at(table[ahead_row + bit], accumulated.clip_clock.ahead_fraction);
                let early = motion_between(later, now, whole.x) + quantization_slack;
                if early <= own_budget {
                    chosen.ahead |= 1u << bit;
                    stored = later;
                    *left -= early;
                }
            }
            sampled[at] = stored;
        }
        else {
            *left -= missed;
        }
        if (whole.y & REMAINING) != 0u {
            remaining[at] = *left;
        }
    }
    return chosen;
}

fn gate_word(instance: u32, word: u32, lod: Lod, clip_clock: ClipClock, left: ptr<function, u32>) -> Chosen {
    let first = 32u * word;
    let reason = update_reason_of(clip_clock);
    if reason == UPDATE_REASON_HIDDEN {
        return Chosen(0u, 0u);
    }
    let tier = lod_flags_tier(lod.flags);
    let record = (tier * params.clips + clip_clock.clip) * (params.words + 1u);
    let sets = params.tiers * params.clips * (params.words + 1u) + 2u * tier * params.words + word;
    let all = animated_bones[sets];
    let candidates = select(animated_bones[record + 1u + word], all, reason == UPDATE_REASON_BLENDED);
    let always = candidates & animated_bones[sets + params.words];
    let forced = select(always, all, reason >= UPDATE_REASON_FORCED);
    if MODE == BOUNDED {
        let accumulated = AccumulatedMotion(min(lod.allowed, EVERYTHING - 1u), clip_clock, animated_bones[record]);
        return by_motion(instance, first, candidates, forced, accumulated, left);
    }
    var chosen = candidates;
    if reason == UPDATE_REASON_FORCED {
        chosen = all;
    }
    else if lod.omega >= OMEGA_ONE {
        chosen = candidates;
    }
    else if MODE == SKIP_PERIOD {
        chosen = by_priority(instance, first, candidates, lod.omega, clip_clock);
    }
    else if MODE == UNIFORM {
        chosen = all_or_none(instance, candidates, lod.omega);
    }
    else if MODE == RANDOM {
        chosen = at_random(instance, first, candidates, lod.omega);
    }
    return Chosen(chosen | always, 0u);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    let each = select(1u, params.words, MODE == BOUNDED);
    let instance = index * each / params.words;
    if instance >= params.instances {
        return;
    }
    let lod = lods[instance];
    let clip_clock = clip_clocks[instance];
    let first = index * each - instance * params.words;
    var left = 0u;
    for (var word = first; word < first + each; word++) {
        let chosen = gate_word(instance, word, lod, clip_clock, &left);
        let at = instance * params.words + word;
        bits[at] = chosen.bits;
        bits[params.instances * params.words + at] = chosen.ahead;
    }
}
