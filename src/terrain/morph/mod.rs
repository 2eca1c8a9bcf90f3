//! Blend of two height fields over time (thesis B section 4.4, `targetHeight`).

use crate::InputError;
use crate::terrain::config::{TerrainConfig, finite};

#[cfg(feature = "gpu")]
mod batch;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use batch::MorphedFields;
#[cfg(feature = "gpu")]
pub use pass::{HeightMorphPass, MorphBuffers, MorphJob};

/// Time of a blend between two fields. A blended height is `from + ⌊(to − from)·time⌋`, computed in integers. The result is exact
/// at both ends, and every device computes the same bits in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Morph {
    /// Time from 0 (the first field) to 1 (the second), rounded to steps of 1/65536.
    pub time: f64,
}

impl Default for Morph {
    /// Time 0: the first field.
    fn default() -> Self {
        Self { time: 0.0 }
    }
}

/// Checks that the fields of `config` can be blended into the fields of `target`: both need the same number and spacing of
/// samples.
///
/// # Errors
/// [`InputError`] that names `patch_size` or `terrain_scale`.
pub fn check_target(config: &TerrainConfig, target: &TerrainConfig) -> Result<(), InputError> {
    InputError::check_same("patch_size", target.patch_size, config.patch_size, "as at time 0")?;
    InputError::check_same("terrain_scale", target.terrain_scale, config.terrain_scale, "as at time 0")
}

impl Morph {
    /// Checks that the time is in 0..=1.
    ///
    /// # Errors
    /// [`InputError`] that names `time`.
    pub fn validate(&self) -> Result<(), InputError> {
        finite("time", self.time, 0.0, 1.0)
    }

    /// The time as an integer, in steps of 1/65536.
    pub fn fixed_time(&self) -> u32 {
        (self.time * 65_536.0).round_ties_even() as u32
    }
}
