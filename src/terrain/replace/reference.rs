//! Heights replaced by given ones: the CPU reference of `kernels/terrain/replace.wgsl`.

use super::NOT_GIVEN;

/// Replaces heights by those of `given` that are not [`NOT_GIVEN`].
pub fn replace(heights: &mut [i32], given: &[i32]) {
    for (height, given) in heights.iter_mut().zip(given).filter(|(_, given)| **given != NOT_GIVEN) {
        *height = *given;
    }
}
