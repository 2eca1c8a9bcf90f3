//! A blend of two height fields: the CPU reference of `kernels/terrain/morph.wgsl`.

/// Returns `from + ⌊(to − from)·time / 65536⌋` at every point; `time` is 0 to 65536.
pub fn morph(from: &[i32], to: &[i32], time: u32) -> Vec<i32> {
    from.iter()
        .zip(to)
        .map(|(&from, &to)| from + ((i64::from(to - from) * i64::from(time)) >> 16) as i32)
        .collect()
}
