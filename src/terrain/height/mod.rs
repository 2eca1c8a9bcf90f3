//! Heights of a window onto the diamond-square surface of the whole plane (B section 3.3.1), for `seamless`
//! terrain. All arithmetic is on integers: every device computes the same bits.

#[cfg(feature = "gpu")]
mod batch;
#[cfg(feature = "gpu")]
mod job;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use batch::HeightBatch;
#[cfg(feature = "gpu")]
pub use job::{HeightJob, HeightScratch};
#[cfg(feature = "gpu")]
pub(in crate::terrain) use job::{LevelInputs, level_widths};
#[cfg(feature = "gpu")]
pub use pass::Blocks;
#[cfg(feature = "gpu")]
pub use pass::HeightPass;
