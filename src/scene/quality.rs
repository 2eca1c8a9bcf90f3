//! How fine a view is, and what the permitted displacement is spent on.

use crate::InputError;

/// How fine a view is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// The largest number of pixels of the camera's viewport by which any point of an instance may be drawn away from its
    /// place, at least 0; 0 shows everything in full detail. It becomes a distance in the world that each instance is allowed,
    /// and [`ErrorBudget`] divide that among levels of detail, bones and influences. Not bounded are shading, textures, and
    /// shadow edges.
    ///
    /// Where the device has no memory left for the vertices of what is seen of a character, its levels are coarser than that:
    /// [`Scene::lod_bias`](super::Scene::lod_bias) says by how much.
    pub pixels: f32,
}

impl Default for Quality {
    /// One pixel.
    fn default() -> Self {
        Self { pixels: 1.0 }
    }
}

impl Quality {
    /// Checks the number of pixels.
    ///
    /// # Errors
    /// [`InputError`] for pixels that are negative or not finite.
    pub fn validate(&self) -> Result<(), InputError> {
        if self.pixels >= 0.0 && self.pixels.is_finite() {
            return Ok(());
        }
        Err(InputError::new("quality.pixels", self.pixels, "must be finite, and not negative"))
    }
}

/// The fractions of the allowed displacement that each source of error may use. They add up to at most 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorBudget {
    /// Levels of detail of characters' meshes, 0 to 1. Static meshes use the whole displacement.
    pub mesh: f32,
    /// Bones that keep an old pose, 0 to 1.
    pub bones: f32,
    /// Influences that are left out, 0 to 1.
    pub influences: f32,
}

impl Default for ErrorBudget {
    /// 0.9 for meshes, 0.08 for bones and 0.02 for influences: triangles cost most.
    fn default() -> Self {
        Self { mesh: 0.9, bones: 0.08, influences: 0.02 }
    }
}

impl ErrorBudget {
    /// Checks the fractions.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
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
