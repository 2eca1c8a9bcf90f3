//! Heights of a window onto the diamond-square surface of the whole plane (B section 3.3.1), for `seamless`
//! terrain. All arithmetic is on integers: every device computes the same bits.

#[cfg(feature = "verify")]
pub(crate) mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub(crate) mod verify;

#[cfg(feature = "gpu")]
#[cfg(feature = "verify")]
pub(crate) use pass::Blocks;
#[cfg(feature = "gpu")]
pub use pass::{HeightBatch, HeightJob, HeightPass, HeightScratch};
