//! The memory traffic of sampling without its arithmetic (`kernels/baseline/gather.wgsl`).

pub use pass::GatherPass;

mod pass;
pub mod reference;

/// The data that the kernel reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reads {
    /// Everything that sampling reads: 20 words of keys per bone, and the 9 words that locate them (the
    /// instance's clip, three tracks, a cursor).
    Everything,
    /// The keys and the cursor only: tracks are evenly spaced, with this many values each.
    Keys(u32),
}
