//! Top-down colour map of a patch: zones of ground with their textures (B section 3.3.1, equations 3.6 and 3.7), and
//! hill-shading.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

use crate::InputError;
use crate::terrain::config::finite;

#[cfg(feature = "gpu")]
pub use pass::{BlendBuffers, BlendPass};

/// Method that combines zone weights into a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WeightMode {
    /// Weights are divided by their sum. Where all are 0, the nearest zone has weight 1.
    #[default]
    Normalized,
    /// B's rule: colours are summed with unnormalized weights.
    Additive,
}

impl WeightMode {
    /// Value of the shaders' `additive` for this mode: 0 or 1.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(self) -> u32 {
        u32::from(self == Self::Additive)
    }
}

/// Shading of a colour map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shading {
    /// Unit vector towards the light: x east, y up, z south.
    pub light: [f32; 3],
    /// Fraction of the full light that a surface facing away from the light receives, 0 to 1.
    pub ambient: f32,
    /// Method that combines zone weights into a colour.
    pub weights: WeightMode,
}

impl Default for Shading {
    fn default() -> Self {
        // The light is in the north-west, 40° high, as is usual for relief maps.
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

/// Largest allowed difference between a channel of a colour map and the reference: one level of 255.
///
/// Positions in textures and the cells of the variation are integers, and everything else is continuous. A weight carries an
/// error of at most 2^-16. By height, that is some 2^-23 · (|height| + |max|) / (max − min). By slope, with transitions at
/// least a degree wide, it is 115 times the 2^-20 of the steepness. The colour carries this error divided by the sum of
/// weights, and the 1/100 level of the polynomial for sRGB's curve. Where the sum is at least [`MIN_TOTAL`], that is far less
/// than a level, but the rounding to 8 bits may go either way.
pub const MAP_BOUND: u8 = 1;

/// Smallest sum of weights for which [`MAP_BOUND`] holds. It also holds for a sum of 0.
pub const MIN_TOTAL: f32 = 1.0 / 64.0;
