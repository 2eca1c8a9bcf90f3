//! A copy of words: the CPU reference of `kernels/baseline/copy.wgsl`.

/// Copies `source` over the start of `destination`.
pub fn copy(source: &[u32], destination: &mut [u32]) {
    destination[..source.len()].copy_from_slice(source);
}
