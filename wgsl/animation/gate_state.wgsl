// State per instance that gates read.
//
// Progress word of `ClipClock::fraction_and_reason`: the fraction of the way to the next row, and the update reason.
// packed Progress: fraction 20, reason 12

// An instance's level of detail.
struct Lod {
    // Ω, the level of detail by distance: 0 to [`OMEGA_ONE`], at which nothing is skipped. See
    // [`Range::omega`].
    omega: u32,
    // The motion that may be missed, in units of the gate's table. See [`Projection::allowed`].
    allowed: u32,
    // Weight of this instance's motion against that of other instances, 0 to FULL_WEIGHT, proportional to its size on screen.
    weight: u32,
    // LOD_HIDDEN, LOD_FORCED or neither. A hidden instance is not sampled, even if it has both.
    flags: u32,
}

// The instance is not in view: it costs nothing, and is sampled in full when it comes back.
const LOD_HIDDEN: u32 = 1u;
// The instance is sampled in full this frame, whatever the gate says.
const LOD_FORCED: u32 = 2u;
// The value of `Lod::omega` at full detail.
const OMEGA_ONE: u32 = 65536u;
// The weight of an instance that counts in full.
const FULL_WEIGHT: u32 = 65535u;

// The position of an instance on the common timeline of its clip.
struct ClipClock {
    // Row of the gate's table: the clip's first row plus the key before the current time.
    row: u32,
    // Progress word: the fraction of the way to the next row, 0 to FRACTION_ONE, and the [`UpdateReason`].
    fraction_and_reason: u32,
    // Index of the clip.
    clip: u32,
    // Row at the look-ahead time, at which bones may be sampled ahead; `row` if there is no such time.
    ahead_row: u32,
    // Fraction of the way from the look-ahead row to the next, 0 to FRACTION_ONE.
    ahead_fraction: u32,
}

// 1 in fixed point: the fraction of the whole way from one row to the next.
const FRACTION_ONE: u32 = 65536u;

// Update reasons. FREE: the gate decides. HIDDEN: nothing is sampled. FORCED: everything is sampled. BLENDED: layers are
// blended over the clip.
const UPDATE_REASON_FREE: u32 = 0u;
const UPDATE_REASON_HIDDEN: u32 = 1u;
const UPDATE_REASON_FORCED: u32 = 2u;
const UPDATE_REASON_BLENDED: u32 = 3u;

// The update reason: one of the constants above.
fn update_reason_of(clip_clock: ClipClock) -> u32 {
    return progress_reason(clip_clock.fraction_and_reason);
}

// Whether the pose at the look-ahead time differs from the current one.
fn is_ahead(clip_clock: ClipClock) -> bool {
    return clip_clock.ahead_row != clip_clock.row || clip_clock.ahead_fraction != fraction_of(clip_clock);
}

// The fraction of the way to the next row, 0 to FRACTION_ONE.
fn fraction_of(clip_clock: ClipClock) -> u32 {
    return progress_fraction(clip_clock.fraction_and_reason);
}

// Flag of a pair of instance and bone: it is sampled ahead.
const PAIR_AHEAD: u32 = 0x80000000u;
