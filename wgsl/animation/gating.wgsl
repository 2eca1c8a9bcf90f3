// What gates know of an instance.

// From the host.
struct Lod {
    // Level of detail by distance, 0 to 65536.
    omega: u32,
    // Motion that may be missed, in units of the table.
    allowed: u32,
    // How much motion counts, relative to other instances, 0 to 65535.
    weight: u32,
    flags: u32,
}

const LOD_HIDDEN = 1u;
const LOD_REFRESH = 2u;
const OMEGA_ONE = 65536u;

// Where it stands in its clip.
struct Phase {
    row: u32,
    // The way to the next row, 0 to 65536; above 20 bits what else asks for a pose.
    fraction_and_verdict: u32,
    clip: u32,
}

const PHASE_FREE = 0u;
const PHASE_HIDDEN = 1u;
const PHASE_FORCED = 2u;
const PHASE_BLENDED = 3u;

fn verdict_of(phase: Phase) -> u32 {
    return phase.fraction_and_verdict >> 20u;
}

fn fraction_of(phase: Phase) -> u32 {
    return phase.fraction_and_verdict & 0xfffffu;
}
