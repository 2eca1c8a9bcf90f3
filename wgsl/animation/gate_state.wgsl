// Per-instance state that gates read.
//
// Progress word of `ClipClock::fraction_and_reason`: the fraction of the interval to the next row, and the update reason.
// packed Progress: fraction 20, reason 12

// Level of detail of an instance, as gates read it.
struct Lod {
    // Level of detail by distance, Ω: 0 to [`OMEGA_ONE`]. At [`OMEGA_ONE`], no update is skipped. See [`Range::omega`].
    omega: u32,
    // Motion that a gate may miss, in units of the gate's table. See [`Projection::allowed`].
    allowed: u32,
    // Weight of this instance's motion relative to other instances, 0 to FULL_WEIGHT, proportional to the instance's size on
    // screen.
    weight: u32,
    // Flags word: LOD_HIDDEN, LOD_FORCED or 0, and the skeleton tier. An instance with both flags counts as hidden and is not
    // sampled.
    flags: u32,
}

// Word of `Lod.flags`: the LOD flags, and the index of the skeleton tier whose bones are sampled. Tier 0 is the whole skeleton.
// packed LodFlags: bits 8, tier 8

// Flag of an instance that is not in view. The instance costs nothing, and is sampled in full when it comes back into view.
const LOD_HIDDEN: u32 = 1u;
// Flag of an instance that is sampled in full this frame, whatever the gate says.
const LOD_FORCED: u32 = 2u;
// Value of `Lod::omega` at full detail.
const OMEGA_ONE: u32 = 65536u;
// Value of `Lod::weight` for an instance that counts in full.
const FULL_WEIGHT: u32 = 65535u;

// Position of an instance in its clip, on the clip's common timeline (its first one).
struct ClipClock {
    // Index of a row in the gate's table: the clip's first row, plus the index of the last key at or before the current time.
    row: u32,
    // Progress word: the fraction of the interval to the next row, 0 to FRACTION_ONE, and the [`UpdateReason`].
    fraction_and_reason: u32,
    // Index of the clip in its set.
    clip: u32,
    // Row at the look-ahead time: a later time, for which bones may already be sampled in this frame. It equals `row` if there
    // is no look-ahead time.
    ahead_row: u32,
    // Fraction of the interval from the look-ahead row to the next row, 0 to FRACTION_ONE.
    ahead_fraction: u32,
}

// The fraction 1 in fixed point: the whole interval from one row to the next.
const FRACTION_ONE: u32 = 65536u;

// Update reason: the gate decides which bones are sampled.
const UPDATE_REASON_FREE: u32 = 0u;
// Update reason: no bone is sampled.
const UPDATE_REASON_HIDDEN: u32 = 1u;
// Update reason: all bones are sampled.
const UPDATE_REASON_FORCED: u32 = 2u;
// Update reason: layers are blended over the clip.
const UPDATE_REASON_BLENDED: u32 = 3u;

// Update reason of an instance: one of the UPDATE_REASON constants.
fn update_reason_of(clip_clock: ClipClock) -> u32 {
    return progress_reason(clip_clock.fraction_and_reason);
}

// Whether the pose at the look-ahead time differs from the current one.
fn is_ahead(clip_clock: ClipClock) -> bool {
    return clip_clock.ahead_row != clip_clock.row || clip_clock.ahead_fraction != fraction_of(clip_clock);
}

// Fraction of the interval to the next row, 0 to FRACTION_ONE.
fn fraction_of(clip_clock: ClipClock) -> u32 {
    return progress_fraction(clip_clock.fraction_and_reason);
}

// Flag in the word of a pair, which stands for one bone of one instance: the bone is sampled at the look-ahead time.
const PAIR_AHEAD: u32 = 0x80000000u;
