//! Checks of triangle indices.

use crate::InputError;

/// Refuses a number of indices that is not a multiple of three, and indices of vertices that do not exist.
pub fn check_triangles(path: &str, indices: &[u32], vertices: usize) -> Result<(), InputError> {
    if !indices.len().is_multiple_of(3) {
        return Err(InputError::new(format!("{path}.len"), indices.len(), "must be a multiple of 3"));
    }
    match indices.iter().position(|index| *index as usize >= vertices) {
        None => Ok(()),
        Some(at) => {
            let bound = format!("must be below {vertices}, the number of vertices");
            Err(InputError::new(format!("{path}[{at}]"), indices[at], bound))
        }
    }
}
