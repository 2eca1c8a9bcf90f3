// What gates know of an instance.

// An instance's level of detail.
struct Lod {
    // Ω, the level of detail by distance: 0 to [`OMEGA_ONE`], where nothing is skipped. See [`Range::omega`].
    omega: u32,
    // Motion that may be missed, in units of the gate's table: see [`Lens::allowed`].
    allowed: u32,
    // How much motion counts against that of other instances, 0 to 65535: in proportion to its size on screen.
    weight: u32,
    // [`Lod::HIDDEN`], [`Lod::REFRESH`].
    flags: u32,
}

// Not in view: costs nothing, and is sampled in full when it comes back.
const LOD_HIDDEN = 1u;
// Sampled in full this frame, whatever the gate says.
const LOD_REFRESH = 2u;
// `Lod::omega` at full detail.
const OMEGA_ONE = 65536u;

// Where an instance stands.
struct Phase {
    // Row of the gate's table: the clip's first, and the key before.
    row: u32,
    // In the lower 20 bits the way to the next row, 0 to 65536; above them the [`Verdict`].
    fraction_and_verdict: u32,
    // The clip.
    clip: u32,
    // The row where it will stand when bones may be sampled ahead of their time; else as above.
    ahead_row: u32,
    // The way to the row after it, 0 to 65536.
    ahead_fraction: u32,
}

// Verdicts: the gate decides; nothing is sampled; everything is; what layers blend is.
const PHASE_FREE = 0u;
const PHASE_HIDDEN = 1u;
const PHASE_FORCED = 2u;
const PHASE_BLENDED = 3u;

// PHASE_FREE, PHASE_HIDDEN, PHASE_FORCED or PHASE_BLENDED.
fn verdict_of(phase: Phase) -> u32 {
    return phase.fraction_and_verdict >> 20u;
}

// Whether bones that are sampled ahead get another pose.
fn is_ahead(phase: Phase) -> bool {
    return phase.ahead_row != phase.row || phase.ahead_fraction != fraction_of(phase);
}

// The way to the next row, 0 to 65536.
fn fraction_of(phase: Phase) -> u32 {
    return phase.fraction_and_verdict & 0xfffffu;
}

// A pair of instance and bone that is sampled ahead.
const PAIR_AHEAD = 0x80000000u;
