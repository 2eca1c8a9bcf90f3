//! Heights of a window onto the diamond-square surface of the whole plane (B section 3.3.1), for `seamless`
//! terrain. All arithmetic is on integers: every device computes the same bits.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{Blocks, HeightBatch, HeightJob, HeightPass, HeightScratch};
