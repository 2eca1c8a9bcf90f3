// How far bones have moved along their clips, as sums that never fall: modulo 2^32, in units of the table.
import package::wgsl::animation::gating::{Phase, fraction_of};

// value * fraction / 65536, fraction at most 65536, without overflow.
fn share_of(value: u32, fraction: u32) -> u32 {
    return (value >> 16u) * fraction + (((value & 0xffffu) * (fraction & 0xffffu)) >> 16u)
        + (value & 0xffffu) * (fraction >> 16u);
}

// `row`: the sum at the row's start and its rise to the next; `period`: that of the whole clip.
fn motion_at(row: vec2<u32>, period: u32, phase: Phase) -> u32 {
    return row.x + share_of(row.y, fraction_of(phase)) + bitcast<u32>(phase.turns) * period;
}

// On either way.
fn motion_between(now: u32, last: u32) -> u32 {
    return u32(abs(bitcast<i32>(now - last)));
}
