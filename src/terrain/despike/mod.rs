//! Removal of the spikes that midpoint displacement leaves (B figure 5.10).

use crate::InputError;
use crate::terrain::config::{HEIGHT_ONE, finite};

#[cfg(feature = "verify")]
pub(crate) mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub(crate) mod verify;

#[cfg(feature = "gpu")]
pub use pass::DespikePass;

/// A point further than `threshold` from the mean of its four neighbours is replaced by it; injected points
/// are left alone. Reaches one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Despike {
    /// τ, in height units; 0 to 16383.
    pub threshold: f64,
}

impl Despike {
    /// Checks the threshold.
    ///
    /// # Errors
    /// [`InputError`] that names `despike`.
    pub fn validate(&self) -> Result<(), InputError> {
        finite("despike", self.threshold, 0.0, 16383.0)
    }

    /// τ in 1/65536 units.
    pub fn fixed_threshold(&self) -> i32 {
        (self.threshold * HEIGHT_ONE).round_ties_even() as i32
    }
}
