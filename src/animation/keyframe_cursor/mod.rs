//! Where instances stand in their clips: the first step of a frame. A time is looked up once a timeline, that is once
//! for all the tracks that share their key times, and not once a bone.
//!
//! An even spacing of keys is guessed first; where the guess is wrong, halving finds the key. So two devices agree on
//! a key unless they disagree on the time.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{KeyframeCursorJob, KeyframeCursorPass};

/// How far key + fraction may lie from the reference's for times up to 64 s, keys at least 1/64 s apart, on any device.
///
/// `start + rate·elapsed` may be fused, the wrapped time `t − ⌊t/d⌋·d` likewise: 3ε of 64 s, in stretches of 1/64 s
/// with ε = 2⁻²⁴ 7.4e-4; the fraction's division adds 2.5ε.
pub const KEYFRAME_CURSOR_BOUND: f32 = 1e-3;
