//! Bounds of a model's motion that were computed in advance.

use serde::{Deserialize, Serialize};

use crate::InputError;

/// Bounds of a model's motion in its clips, in the model's units. A package has them, so that a scene need not sample the clips.
///
/// The bounds hold for the skeleton, skins, clips and vertices from which they were computed. If any of these has changed since
/// then, the bounds are not used, and a scene samples the clips.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotionBounds {
    /// A sphere around all vertices for each clip: x, y and z of its center, and its radius.
    #[doc(hidden)]
    pub spheres: Vec<[f32; 4]>,
    /// Largest displacement of a vertex in any clip per unit of influence fade
    /// (`relievo::ops::skinning::Extent::stray`).
    #[doc(hidden)]
    pub stray: f32,
    /// Fingerprint of the model.
    pub(super) of: u64,
}

impl MotionBounds {
    /// The same bounds without a model.
    pub(super) fn unbound(self) -> Self {
        Self { of: 0, ..self }
    }

    /// Checks that there is a sphere for each of `clips` clips, and that all numbers are finite, radii and displacement at least
    /// 0.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub(crate) fn check(&self, clips: usize) -> Result<(), InputError> {
        InputError::check_len("motion.spheres", self.spheres.len(), clips, "a clip")?;
        for (at, sphere) in self.spheres.iter().enumerate() {
            if !sphere.iter().all(|value| value.is_finite()) || sphere[3] < 0.0 {
                let bound = "must be finite, with a radius of at least 0";
                return Err(InputError::new(format!("motion.spheres[{at}]"), format!("{sphere:?}"), bound));
            }
        }
        let bound = || "must be finite, and at least 0".to_owned();
        InputError::check((0.0..f32::INFINITY).contains(&self.stray), "motion.stray", self.stray, bound)
    }
}
