//! Keyframe cursors: the position of each instance between two keys of its clip. Computing them is the first step of sampling. A
//! cursor is found once per timeline (list of key times), so all tracks with the same key times share it.
//!
//! The search first guesses the key as if keys were evenly spaced. If the guess is wrong, bisection finds the key. The result
//! does not depend on the guess, so two devices find the same key whenever they compute the same time.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

use std::mem::offset_of;

use crate::asset::keyframe::KeyframeCursor;
use crate::shared::animation::clip;
#[cfg(feature = "gpu")]
pub use pass::{KeyframeCursorJob, KeyframeCursorPass};

// `relievo-asset` repeats the struct of the shaders.
const _: fn(clip::KeyframeCursor) -> KeyframeCursor =
    |clip::KeyframeCursor { key, fraction }| KeyframeCursor { key, fraction };
const _: () = assert!(size_of::<KeyframeCursor>() == size_of::<clip::KeyframeCursor>());
const _: () = assert!(offset_of!(KeyframeCursor, key) == offset_of!(clip::KeyframeCursor, key));
const _: () = assert!(offset_of!(KeyframeCursor, fraction) == offset_of!(clip::KeyframeCursor, fraction));

/// Largest allowed difference between a cursor's `key + fraction` and the CPU reference, on any device. It holds for times up to
/// 64 s and keys at least 1/64 s apart.
///
/// Devices may fuse the operations of `start + rate·elapsed` and of the wrapped time `t − ⌊t/d⌋·d`. The errors of both terms add
/// up to at most 3ε · 64 s, with ε = 2⁻²⁴. This is 7.4e-4 of a segment of 1/64 s. The division for the fraction adds 2.5ε.
pub const KEYFRAME_CURSOR_BOUND: f32 = 1e-3;
