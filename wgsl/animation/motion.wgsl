// Accumulated motion of bones along their clips, in units of the gate's table.

// value * fraction / 65536, computed without overflow. `fraction` is at most 65536.
fn scale_by_fraction(value: u32, fraction: u32) -> u32 {
    return (value >> 16u) * fraction + (((value & 0xffffu) * (fraction & 0xffffu)) >> 16u)
        + (value & 0xffffu) * (fraction >> 16u);
}

// Accumulated motion at a time between two rows. `row` has the motion at the first row (x) and the increase up to the next row
// (y). `fraction` is the position between the rows, 0 to 65536.
fn motion_at(row: vec2<u32>, fraction: u32) -> u32 {
    return row.x + scale_by_fraction(row.y, fraction);
}

// Difference of two accumulated motions: the direct one or the one across the clip's end, whichever is smaller. `period` is the
// motion over the whole clip.
fn motion_between(now: u32, last: u32, period: u32) -> u32 {
    let direct = max(now, last) - min(now, last);
    return min(direct, max(period, direct) - direct);
}
