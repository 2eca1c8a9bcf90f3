//! A blend of two height fields over time (B section 4.4, `targetHeight`).

use crate::InputError;
use crate::terrain::config::finite;

#[cfg(feature = "verify")]
pub(crate) mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub(crate) mod verify;

#[cfg(feature = "gpu")]
pub use pass::{MorphBuffers, MorphJob, MorphPass};

/// A blend of two fields: `from + ⌊(to − from)·time⌋`, in integers. It is exact at both ends, and every device
/// computes the same bits in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Morph {
    /// 0 (the first field) to 1 (the second), rounded to steps of 1/65536.
    pub time: f64,
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
