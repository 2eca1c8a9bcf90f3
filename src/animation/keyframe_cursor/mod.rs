//! Keyframe cursors, the first step of a frame: the position of each instance between two keys of its clip. A
//! time is looked up once per timeline, that is once for all tracks that share their key times, and not once
//! per bone.
//!
//! The search first guesses that keys are evenly spaced; if the guess is wrong, bisection finds the key. Two
//! devices therefore agree on a key unless they disagree on the time.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{KeyframeCursorJob, KeyframeCursorPass};

/// The largest difference allowed between key + fraction and the reference, on any device, for times up to 64 s
/// and keys at least 1/64 s apart.
///
/// `start + rate·elapsed` may be fused, and so may the wrapped time `t − ⌊t/d⌋·d`: that is 3ε of 64 s, or
/// 7.4e-4 of a segment of 1/64 s, with ε = 2⁻²⁴. The fraction's division adds 2.5ε.
pub const KEYFRAME_CURSOR_BOUND: f32 = 1e-3;
