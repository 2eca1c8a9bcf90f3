//! Heights of regions, replaced by given ones.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::terrain::replace::NOT_GIVEN;
#[cfg(feature = "gpu")]
pub use pass::{ReplaceBuffers, ReplacePass};
