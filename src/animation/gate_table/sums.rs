//! Integer arithmetic on accumulated motion: the CPU reference of `wgsl/animation/motion.wgsl`.

/// Returns `value · fraction / 65536`, rounded down. `fraction` is at most 65536.
pub fn scale_by_fraction(value: u32, fraction: u32) -> u32 {
    ((u64::from(value) * u64::from(fraction)) >> 16) as u32
}

/// Accumulated motion at a time between two rows. `start` is the accumulated motion at the first row, and `rise` is its increase
/// until the next row. `fraction` is the progress between the rows in 1/65536.
pub fn motion_at([start, rise]: [u32; 2], fraction: u32) -> u32 {
    start.wrapping_add(scale_by_fraction(rise, fraction))
}

/// Motion between two values of accumulated motion: the smaller of the direct difference and the difference across the clip's
/// end. `period` is the motion of the whole clip.
pub fn motion_between(now: u32, last: u32, period: u32) -> u32 {
    let direct = now.abs_diff(last);
    direct.min(period.max(direct) - direct)
}
