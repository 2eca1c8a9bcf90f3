//! How fine a view is, and how its allowed displacement is divided.

use crate::InputError;

/// How fine a view is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// The largest error on the screen, in pixels of the camera's viewport: no point of an instance is drawn further from
    /// its place. At least 0; 0 shows everything in full detail. The limit becomes an allowed displacement in the world per
    /// instance, which [`ErrorBudget`] divides among levels of detail, bones and influences. Shading, textures and shadow
    /// edges are not bounded.
    ///
    /// When the device has no memory left for the vertices of a character's visible instances, its levels are coarser than
    /// this; [`Scene::lod_bias`](super::Scene::lod_bias) returns the factor.
    pub pixels: f32,
}

impl Default for Quality {
    /// One pixel.
    fn default() -> Self {
        Self { pixels: 1.0 }
    }
}

impl Quality {
    /// Checks `pixels`.
    ///
    /// # Errors
    /// [`InputError`] for `pixels` that is negative or not finite.
    pub fn validate(&self) -> Result<(), InputError> {
        if self.pixels >= 0.0 && self.pixels.is_finite() {
            return Ok(());
        }
        Err(InputError::new("quality.pixels", self.pixels, "must be finite, and not negative"))
    }
}

/// Fraction of the allowed displacement that each source of error may use. The fractions add up to at most 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorBudget {
    /// Levels of detail of characters' meshes, 0 to 1. Static meshes use the whole displacement.
    pub mesh: f32,
    /// Bones that keep an older pose, 0 to 1.
    pub bones: f32,
    /// Omitted influences, 0 to 1.
    pub influences: f32,
}

impl Default for ErrorBudget {
    /// 0.9 for meshes, 0.08 for bones and 0.02 for influences, because triangles cost the most.
    fn default() -> Self {
        Self { mesh: 0.9, bones: 0.08, influences: 0.02 }
    }
}

impl ErrorBudget {
    /// Checks the fractions.
    ///
    /// # Errors
    /// [`InputError`] that names the invalid field.
    pub fn validate(&self) -> Result<(), InputError> {
        for (path, value) in
            [("budget.mesh", self.mesh), ("budget.bones", self.bones), ("budget.influences", self.influences)]
        {
            if !(0.0..=1.0).contains(&value) {
                return Err(InputError::new(path, value, "must be in 0..=1"));
            }
        }
        let sum = self.mesh + self.bones + self.influences;
        if sum > 1.000_001 {
            return Err(InputError::new("budget", sum, "must add up to at most 1"));
        }
        Ok(())
    }
}
