// Gate: decides which bones of which instances are sampled this frame, one bit each. All arithmetic is on integers, so that
// every device decides identically. A thread decides for up to 32 bones of one instance. With BOUNDED, a thread decides for all
// bones of one instance, because parents pass their remaining error budget to their children.
import package::wgsl::animation::gate_state::{Lod, lod_flags_tier, OMEGA_ONE, UPDATE_REASON_BLENDED, UPDATE_REASON_FORCED, UPDATE_REASON_HIDDEN, ClipClock, fraction_of, is_ahead, update_reason_of};
import package::wgsl::animation::motion::{motion_at, motion_between, scale_by_fraction};
import package::wgsl::animation::order::NO_PARENT;

// Mode of the gate: one of the constants below.
override MODE: u32 = 0;

// Mode: all bones that the clip moves are sampled.
const OFF = 0u;
// Mode: each bone skips one update per period. The period depends on the bone's priority and Ω.
const SKIP_PERIOD = 1u;
// Mode: in a fraction Ω of the frames, all bones of an instance are sampled; in the other frames, none are.
const UNIFORM = 2u;
// Mode: each bone is sampled with probability Ω.
const RANDOM = 3u;
// Mode: a bone is sampled when the motion that it missed exceeds its error budget.
const BOUNDED = 4u;

// Parameters of the kernel `animation/gate`.
struct GateParams {
    // Number of instances.
    instances: u32,
    // Number of bones per instance.
    bones: u32,
    // Number of 32-bit words per instance. Each slot has one bit.
    words: u32,
    // Number of entries per row of the table.
    stride: u32,
    // Number of ticks since the start.
    ticks: u32,
    // Number of ticks since the last frame.
    frame_ticks: u32,
    // Longest period, in ticks.
    period: u32,
    // Number of frames since the start.
    frame: u32,
    // Number of clips.
    clips: u32,
    // Number of skeleton tiers.
    tiers: u32,
    // Index of the table's row with the nearest animated ancestors of all slots in the first clip. The nearest animated
    // ancestor of a slot is the nearest slot above it that the clip moves. Rows for the other clips follow.
    first_above: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: GateParams;
// Level of detail of each instance.
@group(0) @binding(1) var<storage, read> lods: array<Lod>;
// Clip clock of each instance.
@group(0) @binding(2) var<storage, read> clip_clocks: array<ClipClock>;
// Per skeleton tier and clip: the index of the clip's last row in `table`, then one bit per bone of the tier that the clip moves.
// After all tiers, two bit sets per tier: all of its bones, and the bones that no gate skips.
@group(0) @binding(3) var<storage, read> animated_bones: array<u32>;
// Rows of the gate's table. With SKIP_PERIOD, they hold priorities, four per vector. With BOUNDED, they hold per bone the
// accumulated motion (x) and its increase up to the next row (y). In a clip's last row, x is the motion over the whole clip,
// and y the bone's encoded error budget.
@group(0) @binding(4) var<storage, read> table: array<vec2<u32>>;
// Accumulated motion of each bone of each instance when the bone was last sampled.
@group(0) @binding(5) var<storage, read_write> sampled: array<u32>;
// Remaining error budget of each bone with a child that is not the next bone in the order.
@group(0) @binding(6) var<storage, read_write> remaining: array<u32>;
// Three bit sets of the same layout, each with one bit per bone of each instance, in the order of bones: the bones that are
// sampled, those of them that are sampled ahead, and the bones whose model matrices this frame updates.
@group(0) @binding(7) var<storage, read_write> bits: array<u32>;

// First factor of the hash `scramble`.
const SCRAMBLE_FIRST: u32 = 0x21f0aaadu;
// Second factor of the hash `scramble`.
const SCRAMBLE_SECOND: u32 = 0x735a2d97u;

// One round of a multiplicative hash (Wellons' "lowbias32").
fn scramble(word: u32) -> u32 {
    var mixed = (word ^ (word >> 16u)) * SCRAMBLE_FIRST;
    mixed = (mixed ^ (mixed >> 15u)) * SCRAMBLE_SECOND;
    return mixed ^ (mixed >> 15u);
}

// Thesis A's rule: whether the update in this frame is skipped. One update per period is skipped. If a period is no longer than a
// frame, every update is skipped. Otherwise, an update is skipped if the clock has passed a multiple of the period since the
// last frame.
fn is_skipped(period: u32, ticks: u32) -> bool {
    return period <= params.frame_ticks || ticks % period < params.frame_ticks;
}

// Mode SKIP_PERIOD: the bones among `candidates` that are sampled, one bit each. `first` is the slot of bit 0.
fn by_priority(instance: u32, first: u32, candidates: u32, omega: u32, clip_clock: ClipClock) -> u32 {
    // An offset per instance keeps instances from skipping in step.
    let ticks = params.ticks + (scramble(instance) & 0xffffu);
    var chosen = candidates;
    var rest = candidates;
    while rest != 0u {
        let bit = firstTrailingBit(rest);
        rest &= rest - 1u;
        let slot = first + bit;
        let four = table[clip_clock.row * params.stride + slot / 4u];
        let two = select(four.x, four.y, (slot & 2u) != 0u);
        let priority = (two >> (16u * (slot & 1u))) & 0xffffu;
        // The level is the priority times Ω, in 1/65536. The period is the longest period times the level.
        let level = (priority * omega) >> 16u;
        let whole = (params.period >> 16u) * level;
        let period = whole + (((params.period & 0xffffu) * level) >> 16u);
        if is_skipped(period, ticks) {
            chosen &= ~(1u << bit);
        }
    }
    return chosen;
}

// Mode UNIFORM: either all of `candidates` or none.
fn all_or_none(instance: u32, candidates: u32, omega: u32) -> u32 {
    let frame = (params.frame + scramble(instance)) & 0xffffu;
    let is_due = (frame * omega) >> 16u != ((frame + 1u) * omega) >> 16u;
    return select(0u, candidates, is_due);
}

// Mode RANDOM: the bones among `candidates` that are sampled, one bit each. `first` is the slot of bit 0.
fn at_random(instance: u32, first: u32, candidates: u32, omega: u32) -> u32 {
    var chosen = 0u;
    var rest = candidates;
    while rest != 0u {
        let bit = firstTrailingBit(rest);
        rest &= rest - 1u;
        let word = scramble(scramble(params.frame) + instance * params.bones + first + bit);
        if (word >> 16u) < omega {
            chosen |= 1u << bit;
        }
    }
    return chosen;
}

// Exclusive upper bound of the allowed motion, in units of the table.
const EVERYTHING: u32 = 1u << 30u;

// Lowest bit of a field in a bone's encoded error budget. The field is the fraction of the remaining budget that the bone may
// use, in 1/FRACTION_ONE.
const BUDGET_FRACTION_SHIFT: u32 = 8u;
// Mask of a field in a bone's encoded error budget. The field is the exponent of the quantization slack, which is added to
// missed motion. The slack is 2^(exponent − 1), or 0 for exponent 0.
const BUDGET_SLACK_MASK: u32 = 31u;
// Flag in a bone's encoded error budget: the bone above is not the previous one in the order.
const STARTS: u32 = 32u;
// Flag in a bone's encoded error budget: the remaining budget is stored for later bones.
const REMAINING: u32 = 64u;

// Quantization slack of a bone, from its encoded error budget, in units of the table.
fn quantization_slack_of(granted: u32) -> u32 {
    return (1u << (granted & BUDGET_SLACK_MASK)) >> 1u;
}

// Decision of a gate for up to 32 bones, one bit per bone.
struct Chosen {
    // Bones that are sampled.
    bits: u32,
    // Subset of `bits` that is sampled at the look-ahead time.
    ahead: u32,
}

// Allowed motion of one instance, and its position in the table.
struct AccumulatedMotion {
    // Motion that all bones of the instance together may miss, in units of the table.
    allowed: u32,
    // Clip clock of the instance.
    clip_clock: ClipClock,
    // Index of the clip's last row in the table.
    last_row: u32,
}

// Mode BOUNDED: decides for bones in order, parents first. Each bone may miss a fraction of the remaining budget. A bone that
// missed no more than this fraction is not sampled. Its missed motion is subtracted from the budget, and the bones below get
// the rest. A bone that missed more is sampled, and the bones below get all of the remaining budget.
//
// A sampled bone is sampled ahead if its motion until the look-ahead time is also within its fraction. In this frame, the bone
// is off by this motion, which is subtracted from the budget. In return, the bone can stay unsampled for twice as long. Bones
// in `asked` are always sampled. If nothing may be missed, all bones are sampled. `left` is the budget that the previous bone
// left.
fn by_motion(instance: u32, first: u32, candidates: u32, asked: u32, accumulated: AccumulatedMotion, left: ptr<function, u32>) -> Chosen {
    let forced = asked | select(0u, candidates, accumulated.allowed == 0u);
    let row = accumulated.clip_clock.row * params.stride + first;
    let ahead_row = accumulated.clip_clock.ahead_row * params.stride + first;
    let may_lead = is_ahead(accumulated.clip_clock);
    let last = accumulated.last_row * params.stride + first;
    let own = instance * params.bones;
    var chosen = Chosen(forced, 0u);
    var rest = candidates | forced;
    while rest != 0u {
        let bit = firstTrailingBit(rest);
        rest &= rest - 1u;
        let whole = table[last + bit];
        if (whole.y & STARTS) != 0u {
            let above = table[(params.first_above + accumulated.clip_clock.clip) * params.stride + first + bit].x;
            if above == NO_PARENT {
                *left = accumulated.allowed;
            } else {
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
        } else {
            *left -= missed;
        }
        if (whole.y & REMAINING) != 0u {
            remaining[at] = *left;
        }
    }
    return chosen;
}

// Decides for up to 32 bones of one instance. BOUNDED handles the words of an instance in order: `left` is the budget that the
// previous word left.
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
    // Accumulated motion describes a single clip, so it decides only for the update reason UPDATE_REASON_FREE.
    let forced = select(always, all, reason >= UPDATE_REASON_FORCED);
    if MODE == BOUNDED {
        let accumulated = AccumulatedMotion(min(lod.allowed, EVERYTHING - 1u), clip_clock, animated_bones[record]);
        return by_motion(instance, first, candidates, forced, accumulated, left);
    }
    var chosen = candidates;
    if reason == UPDATE_REASON_FORCED {
        chosen = all;
    } else if lod.omega >= OMEGA_ONE {
        chosen = candidates;
    } else if MODE == SKIP_PERIOD {
        chosen = by_priority(instance, first, candidates, lod.omega, clip_clock);
    } else if MODE == UNIFORM {
        chosen = all_or_none(instance, candidates, lod.omega);
    } else if MODE == RANDOM {
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
