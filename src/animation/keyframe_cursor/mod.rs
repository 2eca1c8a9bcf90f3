//! Keyframe cursors, the first step of a frame: the position of each instance between two keys of its clip. A time is looked up
//! once per timeline, so once for all tracks with the same key times, not once per bone.
//!
//! The search first guesses that keys are evenly spaced. If the guess is wrong, bisection finds the key. Two devices therefore
//! agree on a key unless they disagree on the time.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{KeyframeCursorJob, KeyframeCursorPass};

/// Largest allowed difference of key + fraction from the reference, on any device, for times up to 64 s and keys at least 1/64
/// s apart.
///
/// `start + rate·elapsed` may be fused, and so may the wrapped time `t − ⌊t/d⌋·d`. Together they are off by 3ε of 64 s, or
/// 7.4e-4 of a segment of 1/64 s, with ε = 2⁻²⁴. The fraction's division adds 2.5ε.
pub const KEYFRAME_CURSOR_BOUND: f32 = 1e-3;
