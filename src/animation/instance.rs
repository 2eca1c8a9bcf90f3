//! Playback of a clip by an instance, with a start time and a playback rate.

use crate::InputError;
use crate::shared::animation::clock;
pub use crate::shared::animation::instance::AnimationInstance as Instance;

/// Largest absolute value of a start time, of elapsed seconds, and of a playback rate. As a time, it is about 30 years. Within
/// this limit, products and sums of such values stay finite.
pub const MAX_SECONDS: f32 = 1e9;

/// Treatment of times before the start or after the end of a clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum Wrap {
    /// The clip repeats. The clip's end coincides with its start.
    #[default]
    Loop = 0,
    /// The clip holds its first pose before its start, and its last pose after its end.
    Clamp = clock::WRAP_CLAMP,
}

impl Wrap {
    /// Maps `seconds` after the clip's start to a time inside a clip of `duration` seconds. `seconds` is negative if the clip
    /// plays backwards. A duration of 0 gives 0.
    ///
    /// # Errors
    /// [`InputError`] if `seconds` is not finite.
    pub fn inside(self, duration: f32, seconds: f64) -> Result<f32, InputError> {
        InputError::check_finite("time", seconds)?;
        let duration = f64::from(duration);
        Ok(match self {
            _ if duration <= 0.0 => 0.0,
            Self::Loop => seconds.rem_euclid(duration) as f32,
            Self::Clamp => seconds.clamp(0.0, duration) as f32,
        })
    }
}

/// Checks that elapsed seconds are within ±[`MAX_SECONDS`].
#[cfg(any(feature = "gpu", test))]
pub(crate) fn check_elapsed(elapsed: f32) -> Result<(), InputError> {
    check_seconds("elapsed", elapsed)
}

/// Checks that a number of seconds is within ±[`MAX_SECONDS`]. `field` names the value in errors.
pub(crate) fn check_seconds(field: &str, value: f32) -> Result<(), InputError> {
    // The comparison is false for NaN, so NaN is refused.
    if value.abs() <= MAX_SECONDS {
        return Ok(());
    }
    Err(InputError::new(field, value, format!("must be finite, and within ±{MAX_SECONDS:e}")))
}

impl Instance {
    /// Creates an instance that plays clip number `clip`. `start` is its clip time in seconds at elapsed time 0. `rate` is in
    /// clip seconds per second.
    pub fn new(clip: u32, wrap: Wrap, start: f32, rate: f32) -> Self {
        Self { clip, wrap_code: wrap as u32, start, rate }
    }

    /// Treatment of times before the start or after the end of the clip.
    pub fn wrap(&self) -> Wrap {
        if self.wrap_code == Wrap::Loop as u32 { Wrap::Loop } else { Wrap::Clamp }
    }

    /// Checks that the clip index is below `clips`, and that start and rate are within ±[`MAX_SECONDS`].
    ///
    /// # Errors
    /// [`InputError`] that names the first invalid field.
    pub fn validate(&self, clips: usize) -> Result<(), InputError> {
        InputError::check_below("instance.clip", self.clip, clips)?;
        check_seconds("instance.start", self.start)?;
        check_seconds("instance.rate", self.rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_come_inside() {
        let inside = |wrap: Wrap, seconds| wrap.inside(2.0, seconds).expect("finite");
        for (seconds, looped, clamped) in [
            (0.0, 0.0, 0.0),
            (0.5, 0.5, 0.5),
            (2.0, 0.0, 2.0),
            (5.25, 1.25, 2.0),
            (-0.5, 1.5, 0.0),
            (-4.0, 0.0, 0.0),
        ] {
            assert_eq!((inside(Wrap::Loop, seconds), inside(Wrap::Clamp, seconds)), (looped, clamped));
        }
        assert_eq!(Wrap::Loop.inside(0.0, 3.0), Ok(0.0));
        for seconds in [f64::NAN, f64::INFINITY] {
            assert_eq!(Wrap::Clamp.inside(2.0, seconds).expect_err("refused").path, "time");
        }
    }

    #[test]
    fn instances_are_checked_field_by_field() {
        let good = Instance::new(1, Wrap::Clamp, 0.5, -2.0);
        assert_eq!((good.validate(2), good.wrap()), (Ok(()), Wrap::Clamp));
        assert_eq!(good.validate(1).expect_err("refused").path, "instance.clip");
        let refused = |instance: Instance| instance.validate(2).expect_err("refused").path;
        assert_eq!(refused(Instance { start: f32::NAN, ..good }), "instance.start");
        assert_eq!(refused(Instance { rate: f32::INFINITY, ..good }), "instance.rate");
        assert_eq!(refused(Instance { rate: -1.1e9, ..good }), "instance.rate");
        assert_eq!((check_elapsed(-1e9).is_ok(), check_elapsed(f32::NAN).is_ok()), (true, false));
    }
}
