//! The quality of a view, and how its allowed displacement is divided.

use crate::InputError;

/// The quality of a view: its largest error in pixels, and its limits of triangles and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// The largest error on the screen, in pixels of the camera's viewport, at least 0. No point of an instance is
    /// drawn further from its exact position. 0 shows everything in full detail.
    ///
    /// For each instance, this limit becomes an allowed displacement in the world. [`ErrorBudget`] divides that
    /// displacement among levels of detail, bones and influences. Shading, textures and shadow edges are not bounded.
    ///
    /// If the device has no memory left for the vertices of a character's visible instances, the character's error
    /// exceeds this limit. [`Scene::lod_bias`](super::Scene::lod_bias) returns the factor.
    pub pixels: f32,
    /// The largest number of triangles that the view draws in one layer, at least 1. Back faces count, and so do both
    /// levels of a fade. `None`, the default, means no limit.
    ///
    /// In each frame, the device finds the smallest factor at which the triangles fit the limit. The factor multiplies
    /// the metric by which each instance's level of detail is chosen. So instances get the levels that they would have
    /// further away, or with a larger [`Quality::pixels`]. The error is then at most `pixels` times this factor
    /// ([`ViewStatistics::pixels`](super::ViewStatistics::pixels)). The factor rises at once, and falls within half a
    /// second.
    ///
    /// Objects with a rank become coarser in the order of their ranks
    /// ([`LevelOfDetail::rank`](super::LevelOfDetail::rank)). If even the coarsest levels exceed the limit,
    /// [`BudgetStatistics::is_missed`](super::BudgetStatistics::is_missed) is true.
    pub triangles: Option<u32>,
    /// The time that a frame may take, in milliseconds, above 0. `None`, the default, means no limit. The program
    /// reports the times of its frames ([`View::frame_took`](super::View::frame_took)). If they exceed the limit, the
    /// view draws fewer triangles. `triangles` remains an upper bound.
    pub milliseconds: Option<f32>,
}

impl Default for Quality {
    /// An error of at most one pixel, without limits of triangles and time.
    fn default() -> Self {
        Self { pixels: 1.0, triangles: None, milliseconds: None }
    }
}

impl Quality {
    /// An error of at most `pixels` pixels, without limits of triangles and time.
    pub fn pixels(pixels: f32) -> Self {
        Self { pixels, ..Self::default() }
    }

    /// Checks the fields.
    ///
    /// # Errors
    /// [`InputError`] for `pixels` that is negative or not finite, for 0 `triangles`, and for `milliseconds` that is
    /// not finite or not above 0.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(0.0..f32::INFINITY).contains(&self.pixels) {
            return Err(InputError::new("quality.pixels", self.pixels, "must be finite, and not negative"));
        }
        InputError::check(self.triangles != Some(0), "quality.triangles", 0, || "must be at least 1")?;
        match self.milliseconds {
            Some(limit) if !(limit > 0.0 && limit.is_finite()) => {
                Err(InputError::new("quality.milliseconds", limit, "must be finite, and above 0"))
            }
            _ => Ok(()),
        }
    }
}

/// Fractions of the allowed displacement, one for each source of error. The fractions add up to at most 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorBudget {
    /// Fraction for levels of detail of characters' meshes, 0 to 1. Static meshes use the whole displacement.
    pub mesh: f32,
    /// Fraction for bones that keep an older pose, 0 to 1.
    pub bones: f32,
    /// Fraction for bone influences that skinning omits, 0 to 1.
    pub influences: f32,
}

impl Default for ErrorBudget {
    /// 0.78 for meshes, 0.2 for bones and 0.02 for influences. In a crowd of ten models, 0.2 samples 30 %
    /// fewer bones than 0.08, at the same number of triangles.
    fn default() -> Self {
        Self { mesh: 0.78, bones: 0.2, influences: 0.02 }
    }
}

impl ErrorBudget {
    /// Checks that each fraction is 0 to 1, and that their sum is at most 1.
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
