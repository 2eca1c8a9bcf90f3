//! Where instances stand in their clips: the first step of a frame. A time is looked up once a timeline, that is once
//! for all the tracks that share their key times, and not once a bone.
//!
//! An even spacing of keys is guessed first; where the guess is wrong, halving finds the key. So two devices agree on
//! a key unless they disagree on the time.

use super::sample::Wrap;
use crate::InputError;
pub use crate::shared::animation::instance::AnimationInstance as Instance;

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{PlaceJob, PlacePass};

/// How far key + fraction may lie from the twin's for times up to 64 s, keys at least 1/64 s apart, on any device.
///
/// `start + rate·elapsed` may be fused, the wrapped time `t − ⌊t/d⌋·d` likewise: 3ε of 64 s, in stretches of 1/64 s
/// with ε = 2⁻²⁴ 7.4e-4; the fraction's division adds 2.5ε.
pub const PLACE_BOUND: f32 = 1e-3;

/// The most seconds that a start, or what has elapsed since, may be from 0, and the most clip seconds a second: their
/// products and sums stay finite. Some 30 years.
pub const MOST_SECONDS: f32 = 1e9;

/// Checks what has elapsed.
#[cfg(any(feature = "gpu", test))]
pub(crate) fn check_elapsed(elapsed: f32) -> Result<(), InputError> {
    check_seconds("elapsed", elapsed)
}

/// Checks any seconds.
pub(crate) fn check_seconds(field: &str, value: f32) -> Result<(), InputError> {
    // NaN is not within.
    if value.abs() <= MOST_SECONDS {
        return Ok(());
    }
    Err(InputError::new(field, value, format!("must be finite, and within ±{MOST_SECONDS:e}")))
}

impl Instance {
    /// A clip from a start, at a rate.
    pub fn new(clip: u32, wrap: Wrap, start: f32, rate: f32) -> Self {
        Self { clip, wrap_code: wrap as u32, start, rate }
    }

    /// What becomes of times outside the clip.
    pub fn wrap(&self) -> Wrap {
        if self.wrap_code == Wrap::Loop as u32 { Wrap::Loop } else { Wrap::Clamp }
    }

    /// Checks that it plays one of `clips` clips, from a start and at a rate within ±[`MOST_SECONDS`].
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn validate(&self, clips: usize) -> Result<(), InputError> {
        if self.clip as usize >= clips {
            return Err(InputError::new("instance.clip", self.clip, format!("must be below {clips}")));
        }
        for (field, value) in [("instance.start", self.start), ("instance.rate", self.rate)] {
            check_seconds(field, value)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instances_are_checked_field_by_field() {
        let good = Instance::new(1, Wrap::Clamp, 0.5, -2.0);
        assert_eq!((good.validate(2), good.wrap()), (Ok(()), Wrap::Clamp));
        assert_eq!(good.validate(1).expect_err("refused").field, "instance.clip");
        let refused = |instance: Instance| instance.validate(2).expect_err("refused").field;
        assert_eq!(refused(Instance { start: f32::NAN, ..good }), "instance.start");
        assert_eq!(refused(Instance { rate: f32::INFINITY, ..good }), "instance.rate");
        assert_eq!(refused(Instance { rate: -1.1e9, ..good }), "instance.rate");
        assert_eq!((check_elapsed(-1e9).is_ok(), check_elapsed(f32::NAN).is_ok()), (true, false));
    }
}
