//! Thermal erosion: material slides down slopes that are steeper than a given angle, the talus angle.

use serde::Deserialize;

use crate::InputError;
use crate::terrain::config::{HEIGHT_LIMIT, HEIGHT_ONE, finite, whole};

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{ThermalBuffers, ThermalPass};

/// Parameters of thermal erosion. An iteration looks at every pair of 4-neighbours. If their heights differ by more than the
/// talus angle allows, an eighth of the excess moves downhill. Mass is conserved to the last bit. An iteration reads samples at
/// most one sample away.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// Number of iterations, at most 1024.
    #[serde(deserialize_with = "whole::<_, 0, 1024>")]
    pub iterations: u32,
    /// Talus angle: the steepest stable slope, in degrees, 0 to 89. Default 35.
    #[serde(default = "talus")]
    pub talus: f64,
}

fn talus() -> f64 {
    Thermal::default().talus
}

impl Default for Thermal {
    fn default() -> Self {
        Self { iterations: 1, talus: 35.0 }
    }
}

impl Thermal {
    /// Checks that `iterations` is at most 1024 and `talus` is in 0..=89.
    ///
    /// # Errors
    /// [`InputError`] that names `thermal.iterations` or `thermal.talus`.
    pub fn validate(&self) -> Result<(), InputError> {
        InputError::check_most("thermal.iterations", self.iterations, 1024)?;
        finite("thermal.talus", self.talus, 0.0, 89.0)
    }

    /// Largest stable height difference T between neighbouring samples, in 1/65536 height units. Samples are `terrain_scale`
    /// world units apart.
    pub fn fixed_threshold(&self, terrain_scale: f64) -> i32 {
        let difference = libm::tan(self.talus.to_radians()) * terrain_scale * HEIGHT_ONE;
        // Two heights differ by at most twice the height limit, so a larger threshold has no further effect.
        difference.round_ties_even().min(2.0 * HEIGHT_LIMIT as f64) as i32
    }
}
