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
    /// The largest number of triangles that the view draws in one layer, back faces and both levels of fades included; at
    /// least 1. `None`, the default: no limit.
    ///
    /// In each frame the device finds the least factor of the metric of all instances at which they fit: the levels of
    /// detail are those of instances further away, or those of more [`Quality::pixels`]. The error then is within
    /// `pixels` times this factor ([`ViewStatistics::pixels`](super::ViewStatistics::pixels)). The factor grows at once, and
    /// falls within half a second. Objects with a rank are coarsened in the order of their ranks
    /// ([`LevelOfDetail::rank`](super::LevelOfDetail::rank)). If the coarsest levels do not fit,
    /// [`BudgetStatistics::is_missed`](super::BudgetStatistics::is_missed) is true.
    pub triangles: Option<u32>,
    /// The time that a frame may take, in milliseconds, above 0. `None`, the default: no limit. The view then draws fewer
    /// triangles, at most `triangles`, until the times that the program reports ([`View::frame_took`](super::View::frame_took))
    /// are within it.
    pub milliseconds: Option<f32>,
}

impl Default for Quality {
    /// One pixel, without a budget.
    fn default() -> Self {
        Self { pixels: 1.0, triangles: None, milliseconds: None }
    }
}

impl Quality {
    /// A quality within so many pixels, without a budget.
    pub fn pixels(pixels: f32) -> Self {
        Self { pixels, ..Self::default() }
    }

    /// Checks the fields.
    ///
    /// # Errors
    /// [`InputError`] for `pixels` that is negative or not finite, for 0 `triangles`, and for `milliseconds` that are not
    /// above 0 and finite.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(0.0..f32::INFINITY).contains(&self.pixels) {
            return Err(InputError::new("quality.pixels", self.pixels, "must be finite, and not negative"));
        }
        if self.triangles == Some(0) {
            return Err(InputError::new("quality.triangles", 0, "must be at least 1"));
        }
        match self.milliseconds {
            Some(limit) if !(limit > 0.0 && limit.is_finite()) => {
                Err(InputError::new("quality.milliseconds", limit, "must be finite, and above 0"))
            }
            _ => Ok(()),
        }
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
