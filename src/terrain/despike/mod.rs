//! Removal of the spikes that midpoint displacement produces (B figure 5.10).

use crate::InputError;
use crate::terrain::config::{HEIGHT_ONE, finite};

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{DespikeBuffers, DespikePass};

/// Removal of spikes. A sample that differs from the mean of its four neighbours by more than `threshold` is replaced by this
/// mean. Injected points stay unchanged. The result at a sample depends only on the sample and these neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Despike {
    /// Largest allowed difference τ from the neighbours' mean, in height units, 0 to 16383.
    pub threshold: f64,
}

impl Despike {
    /// Checks that the threshold is in 0..=16383.
    ///
    /// # Errors
    /// [`InputError`] that names `despike.threshold`.
    pub fn validate(&self) -> Result<(), InputError> {
        finite("despike.threshold", self.threshold, 0.0, 16383.0)
    }

    /// Threshold τ as an integer, in 1/65536 height units.
    pub fn fixed_threshold(&self) -> i32 {
        (self.threshold * HEIGHT_ONE).round_ties_even() as i32
    }
}
