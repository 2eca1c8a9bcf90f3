//! A limit of the distance between eroded heights and the heights before erosion.

use crate::InputError;
use crate::terrain::config::{HEIGHT_LIMIT, HEIGHT_ONE, finite};

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{LimitBuffers, LimitPass, LimitShape};

/// How far erosion may move heights. What it would move farther stays at this distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErosionLimit {
    /// Largest distance in height units, 0.001 to 1000.
    pub depth: f64,
}

impl ErosionLimit {
    /// Checks the depth.
    ///
    /// # Errors
    /// [`InputError`] that names `depth`.
    pub fn validate(&self) -> Result<(), InputError> {
        finite("depth", self.depth, 0.001, 1000.0)
    }

    /// The depth in 1/65536 height units.
    pub fn fixed_depth(&self) -> i32 {
        (self.depth * HEIGHT_ONE).round_ties_even().min(HEIGHT_LIMIT as f64) as i32
    }
}
