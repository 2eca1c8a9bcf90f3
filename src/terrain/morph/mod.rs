//! A blend of two height fields over time (B section 4.4, `targetHeight`).

use crate::InputError;
use crate::terrain::config::{Config, finite};

#[cfg(feature = "gpu")]
mod batch;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use batch::MorphedFields;
#[cfg(feature = "gpu")]
pub use pass::{MorphBuffers, MorphJob, MorphPass};

/// A blend of two fields: `from + ⌊(to − from)·time⌋`, in integers. It is exact at both ends, and every device
/// computes the same bits in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Morph {
    /// 0 (the first field) to 1 (the second), rounded to steps of 1/65536.
    pub time: f64,
}

impl Default for Morph {
    /// The first field.
    fn default() -> Self {
        Self { time: 0.0 }
    }
}

/// Checks that fields of `target` may follow those of `config`: that they have the same number of samples in the same places.
///
/// # Errors
/// [`InputError`] that names `patch_size` or `terrain_scale`.
pub fn check_target(config: &Config, target: &Config) -> Result<(), InputError> {
    if target.patch_size != config.patch_size {
        let bound = format!("must be {}, as at time 0", config.patch_size);
        return Err(InputError::new("patch_size", target.patch_size, bound));
    }
    if target.terrain_scale != config.terrain_scale {
        let bound = format!("must be {}, as at time 0", config.terrain_scale);
        return Err(InputError::new("terrain_scale", target.terrain_scale, bound));
    }
    Ok(())
}

impl Morph {
    /// Checks that the time is in 0..=1.
    ///
    /// # Errors
    /// [`InputError`] that names `time`.
    pub fn validate(&self) -> Result<(), InputError> {
        finite("time", self.time, 0.0, 1.0)
    }

    /// The time in steps of 1/65536.
    pub fn fixed_time(&self) -> u32 {
        (self.time * 65_536.0).round_ties_even() as u32
    }
}
