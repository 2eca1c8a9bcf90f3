//! relievo
#![warn(missing_docs)]

#[cfg(feature = "gpu")]
pub mod baseline;
#[cfg(feature = "gpu")]
pub mod bench;
pub mod error;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod reference;
#[cfg(feature = "gpu")]
pub mod render;
pub mod terrain;
#[cfg(feature = "gpu")]
pub mod verify;

pub use error::{Error, InputError};
