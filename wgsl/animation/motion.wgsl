// How far bones have moved along their clips, in units of the table.

// value * fraction / 65536, fraction at most 65536, without overflow.
fn scale_by_fraction(value: u32, fraction: u32) -> u32 {
    return (value >> 16u) * fraction + (((value & 0xffffu) * (fraction & 0xffffu)) >> 16u)
        + (value & 0xffffu) * (fraction >> 16u);
}

// `row`: the sum at the row's start and its rise to the next. `fraction`: the way there, 0 to 65536.
fn motion_at(row: vec2<u32>, fraction: u32) -> u32 {
    return row.x + scale_by_fraction(row.y, fraction);
}

// The shorter way between two sums: directly, or over the clip's end. `period`: that of the whole clip.
fn motion_between(now: u32, last: u32, period: u32) -> u32 {
    let direct = max(now, last) - min(now, last);
    return min(direct, max(period, direct) - direct);
}
