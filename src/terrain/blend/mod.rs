//! Top-down colour maps of patches: textured zones of ground (thesis B section 3.3.1, equations 3.6 and 3.7) with hill-shading.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

use crate::InputError;
use crate::terrain::config::finite;

#[cfg(feature = "gpu")]
pub use pass::{BlendBuffers, BlendPass};

/// How the weights of the zones at a point are combined into a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WeightMode {
    /// Weights are divided by their sum. Where all weights are 0, the zone nearest in height gets weight 1.
    #[default]
    Normalized,
    /// Thesis B's rule: colours are multiplied by the weights and added, without normalization.
    Additive,
}

impl WeightMode {
    /// Value of the shader parameter `additive` for this mode: 1 for `Additive`, otherwise 0.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(self) -> u32 {
        u32::from(self == Self::Additive)
    }
}

/// Light and weighting of a colour map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shading {
    /// Unit vector towards the light: x east, y up, z south.
    pub light: [f32; 3],
    /// Brightness of a surface that faces away from the light, as a fraction of full light, 0 to 1.
    pub ambient: f32,
    /// How the weights of the zones at a point are combined into a colour.
    pub weights: WeightMode,
}

impl Default for Shading {
    fn default() -> Self {
        // Light from the north-west at 40° above the horizon, as is usual for relief maps.
        Self { light: [-0.541_675, 0.642_788, -0.541_675], ambient: 0.25, weights: WeightMode::Normalized }
    }
}

impl Shading {
    /// Checks that `light` is a unit vector and that `ambient` is in 0..=1.
    ///
    /// # Errors
    /// [`InputError`] that names `light` or `ambient`.
    pub fn validate(&self) -> Result<(), InputError> {
        let length = self.light.iter().map(|part| f64::from(*part).powi(2)).sum::<f64>().sqrt();
        if length.is_nan() || (length - 1.0).abs() > 1e-3 {
            let bound = format!("must have length 1, and has {length}");
            return Err(InputError::new("light", format!("{:?}", self.light), bound));
        }
        finite("ambient", self.ambient, 0.0, 1.0)
    }
}

/// Largest allowed difference between a channel of a colour map and its CPU reference: one level of 255.
///
/// Rounding moves the weights of zones. The bound therefore holds only where the weights are known well enough, compared with their
/// sum: where the linear colour is off by at most [`COLOR_BOUND`]. `docs/rounding-bounds.md` has the derivation, and the error of
/// the linear colour at a pixel.
pub const MAP_BOUND: u8 = 1;

/// Largest error of a pixel's linear colour for which [`MAP_BOUND`] holds: 0.92 levels where the sRGB curve is steepest.
pub const COLOR_BOUND: f32 = 2.8e-4;
