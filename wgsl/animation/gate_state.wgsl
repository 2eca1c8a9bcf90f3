// What gates know of an instance.

// An instance's level of detail.
struct Lod {
    // Ω, the level of detail by distance: 0 to [`OMEGA_ONE`], where nothing is skipped. See [`Range::omega`].
    omega: u32,
    // Motion that may be missed, in units of the gate's table: see [`Projection::allowed`].
    allowed: u32,
    // How much motion counts against that of other instances, 0 to 65535: in proportion to its size on screen.
    weight: u32,
    // [`Lod::HIDDEN`], [`Lod::REFRESH`].
    flags: u32,
}

// Flags: nothing is sampled; everything is, now.
const LOD_HIDDEN = 1u;
const LOD_REFRESH = 2u;
// Full detail.
const OMEGA_ONE = 65536u;

// Where an instance stands.
struct ClipClock {
    // Row of the gate's table: the clip's first, and the key before.
    row: u32,
    // In the lower 20 bits the way to the next row, 0 to 65536; above them the [`UpdateReason`].
    fraction_and_reason: u32,
    // The clip.
    clip: u32,
    // The row where it will stand when bones may be sampled ahead of their time; else as above.
    ahead_row: u32,
    // The way to the row after it, 0 to 65536.
    ahead_fraction: u32,
}

// Verdicts: the gate decides; nothing is sampled; everything is; what layers blend is.
const UPDATE_REASON_FREE = 0u;
const UPDATE_REASON_HIDDEN = 1u;
const UPDATE_REASON_FORCED = 2u;
const UPDATE_REASON_BLENDED = 3u;

// PHASE_FREE, PHASE_HIDDEN, PHASE_FORCED or PHASE_BLENDED.
fn update_reason_of(clip_clock: ClipClock) -> u32 {
    return clip_clock.fraction_and_reason >> 20u;
}

// Whether bones that are sampled ahead get another pose.
fn is_ahead(clip_clock: ClipClock) -> bool {
    return clip_clock.ahead_row != clip_clock.row || clip_clock.ahead_fraction != fraction_of(clip_clock);
}

// The way to the next row, 0 to 65536.
fn fraction_of(clip_clock: ClipClock) -> u32 {
    return clip_clock.fraction_and_reason & 0xfffffu;
}

// A pair of instance and bone that is sampled ahead.
const PAIR_AHEAD = 0x80000000u;
