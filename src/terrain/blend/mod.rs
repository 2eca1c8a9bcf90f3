//! The top-down colour map of a patch: zones of ground with their textures (B section 3.3.1, equations 3.6 and 3.7), and
//! hill-shading.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

use crate::InputError;
use crate::terrain::config::finite;

#[cfg(feature = "gpu")]
pub use pass::{BlendBuffers, BlendPass};

/// How zone weights are combined into a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WeightMode {
    /// Weights are divided by their sum; where all of them are 0, the nearest zone has weight 1.
    #[default]
    Normalized,
    /// B's rule: colours are summed with the weights as they are.
    Additive,
}

impl WeightMode {
    /// The value of the shaders' `additive` for this mode: 0 or 1.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(self) -> u32 {
        u32::from(self == Self::Additive)
    }
}

/// How a colour map is shaded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shading {
    /// Unit vector towards the light: x east, y up, z south.
    pub light: [f32; 3],
    /// Light that a surface facing away from the light still receives: a fraction of the full light, 0 to 1.
    pub ambient: f32,
    /// How zone weights are combined into a colour.
    pub weights: WeightMode,
}

impl Default for Shading {
    fn default() -> Self {
        // The light stands in the north-west, 40° high, as is usual for relief maps.
        Self { light: [-0.541_675, 0.642_788, -0.541_675], ambient: 0.25, weights: WeightMode::Normalized }
    }
}

impl Shading {
    /// Checks that the light's direction is a unit vector and that `ambient` is in 0..=1.
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

/// The largest difference allowed between a channel of a colour map and the reference: one level of 255. Places in textures and
/// the cells of the variation are whole numbers, and everything else is continuous. A weight carries at most 2^-16: by height
/// some 2^-23 · (|height| + |max|) / (max − min), and by slope, whose transitions are at least a degree wide, 115 times the 2^-20
/// of the steepness. The colour carries that divided by the sum of weights, and the 1/100 level of the polynomial for sRGB's curve.
/// Where the sum is at least [`MIN_TOTAL`], that is far less than a level, but the rounding to 8 bits may go either way.
pub const MAP_BOUND: u8 = 1;

/// The sum of weights below which [`MAP_BOUND`] does not hold, unless it is 0.
pub const MIN_TOTAL: f32 = 1.0 / 64.0;
