//! Checks of triangle indices.

use crate::InputError;

/// Checks that the number of indices is a multiple of three, and that each index is below `vertices`.
pub fn check_triangles(path: &str, indices: &[u32], vertices: usize) -> Result<(), InputError> {
    if !indices.len().is_multiple_of(3) {
        return Err(InputError::new(format!("{path}.len"), indices.len(), "must be a multiple of 3"));
    }
    check_indices(path, indices, vertices)
}

/// Checks that each index is below `vertices`.
pub(super) fn check_indices(path: &str, indices: &[u32], vertices: usize) -> Result<(), InputError> {
    let bound = format!("must be below {vertices}, the number of vertices");
    InputError::check_each(path, indices, |index| (*index as usize) < vertices, bound)
}
