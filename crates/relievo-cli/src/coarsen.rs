//! Models whose meshes are replaced by coarser levels of themselves.

use relievo::InputError;
use relievo::asset::{Mesh, Model};
use relievo::ops::skinning::{add_levels, poses_of};

/// What became of a mesh that was coarsened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coarsened {
    /// Triangles that are left.
    pub triangles: usize,
    /// Triangles that it had.
    pub of: usize,
    /// How far it is off, in the model's units, in any pose of the clip or at rest.
    pub error: f32,
}

/// Gives every mesh the triangles of the coarsest of its levels that is off by no more than `within` (the model's units) in
/// any pose of a clip, which is looked at 60 times a second, or at rest.
///
/// # Errors
/// [`InputError`] for a distance that is negative or not finite, and as [`poses_of`] and
/// [`add_levels`].
pub fn coarsen(model: &mut Model, clip: usize, within: f32) -> Result<Vec<Coarsened>, InputError> {
    if !(within >= 0.0 && within.is_finite()) {
        return Err(InputError::new("within", within, "must be finite, and not negative"));
    }
    let poses = model.clips.get(clip).map_or(Ok(1), poses_of)?;
    add_levels(model, &[clip], poses)?;
    let coarsened = |mesh: &mut Mesh| {
        let of = mesh.indices.len() / 3;
        mesh.partners.clear();
        let level = std::mem::take(&mut mesh.levels).into_iter().rfind(|level| level.error <= within);
        let error = level.as_ref().map_or(0.0, |level| level.error);
        if let Some(level) = level {
            mesh.indices = level.indices;
        }
        Coarsened { triangles: mesh.indices.len() / 3, of, error }
    };
    Ok(model.meshes.iter_mut().map(coarsened).collect())
}
