// relievo animation/drive: generated from kernels/animation/drive.wgsl

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

struct DriveParams {
    driven: u32,
    instances: u32,
    words: u32
}

struct DrivenWord {
    at: u32,
    bones: u32
}

@group(0) @binding(0)
var<uniform> params: DriveParams;

@group(0) @binding(1)
var<storage, read> driven: array<DrivenWord>;

@group(0) @binding(2)
var<storage, read> lods: array<Lod>;

@group(0) @binding(3)
var<storage, read_write> bits: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= params.driven {
        return;
    }
    let word = driven[index];
    if (lods[word.at / params.words].flags & LOD_HIDDEN) != 0u {
        return;
    }
    bits[word.at] |= word.bones;
    bits[params.instances * params.words + word.at] &= ~word.bones;
}
