//! The keys of one track, and the form in which clips store them.

use crate::InputError;
use crate::asset::transform::{finite, unit};

/// Largest key time, in seconds: about 12 days.
pub const LONGEST: f32 = 1_048_576.0;

/// Threshold in seconds, 2⁻¹⁰⁰: key times below it are stored as 0.
const LEAST_TIME: f32 = 7.888_609e-31;

/// Interpolation of values between keys. The numbers are those of `wgsl/animation/interpolation.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[repr(u32)]
pub enum Interpolation {
    /// Constant: the value of the previous key holds until the next key.
    Step = 0,
    /// Linear interpolation; for rotations, along the shortest arc.
    Linear = 1,
    /// Cubic Hermite spline with tangents at each key. A tangent is a change of the value per second. Interpolated rotations
    /// are normalized.
    CubicSpline = 2,
}

impl Interpolation {
    /// Number of stored values per key: 3 in cubic splines, otherwise 1.
    pub(crate) fn values_a_key(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

/// Keys of one track, as an importer provides them.
#[derive(Debug, Clone, PartialEq)]
pub struct Keys {
    /// Key times in seconds. They do not descend.
    pub times: Vec<f32>,
    /// One value per key, or three in cubic splines (in-tangent, value, out-tangent). The fourth component of translations and
    /// scales is 0.
    pub values: Vec<[f32; 4]>,
    /// Interpolation of values between keys.
    pub interpolation: Interpolation,
}

impl Keys {
    /// Checks key times and values. The values are quaternions if `is_rotation` is set, otherwise translations or scales.
    /// `times` and `values` are the paths of these fields in errors.
    ///
    /// # Errors
    /// [`InputError`] for no keys; for times that descend, are negative, too large or not finite; for a number of values that
    /// is not one per key (three in splines); for values that are not finite; and for rotations without a direction.
    pub(crate) fn validate(&self, [times, values]: [&str; 2], is_rotation: bool) -> Result<(), InputError> {
        check_times(times, &self.times)?;
        let each = self.interpolation.values_a_key();
        if self.values.len() != each * self.times.len() {
            let bound = format!("must be {}, {each} a key", each * self.times.len());
            return Err(InputError::new(format!("{values}.len"), self.values.len(), bound));
        }
        for (at, value) in self.values.iter().enumerate() {
            let path = format!("{values}[{at}]");
            finite(&path, value)?;
            if is_rotation && (each == 1 || at % 3 == 1) {
                unit(&path, *value)?;
            }
        }
        Ok(())
    }

    /// Converts valid keys to the form in which a clip stores them: unit quaternions, and tangents multiplied by the duration
    /// of their segment.
    ///
    /// # Errors
    /// [`InputError`] for tangents that overflow `f32` when they are multiplied by their segment's duration in seconds.
    #[doc(hidden)]
    pub fn stored(&self, path: &str, is_rotation: bool) -> Result<Self, InputError> {
        let mut keys = self.clone();
        keys.times.iter_mut().filter(|time| **time < LEAST_TIME).for_each(|time| *time = 0.0);
        match self.interpolation {
            Interpolation::CubicSpline => {
                stretch_tangents(&keys.times, &mut keys.values);
                finite(path, keys.values.as_flattened())?;
            }
            _ if is_rotation => {
                for value in &mut keys.values {
                    *value = unit(path, *value)?;
                }
                if self.interpolation == Interpolation::Linear {
                    take_short_ways(&mut keys.values);
                }
            }
            _ => {}
        }
        Ok(keys)
    }
}

/// Refuses an empty list of key times, times that descend, and times outside 0..=[`LONGEST`] seconds.
pub(crate) fn check_times(path: &str, times: &[f32]) -> Result<(), InputError> {
    if times.is_empty() {
        return Err(InputError::new(format!("{path}.len"), 0, "must be at least 1"));
    }
    InputError::check_most(format!("{path}.len"), times.len(), u32::MAX as usize)?;
    let bound = format!("must be in 0..={LONGEST} seconds");
    InputError::check_each(path, times, |time| (0.0..=LONGEST).contains(time), bound)?;
    match times.windows(2).position(|pair| pair[0] > pair[1]) {
        None => Ok(()),
        Some(at) => {
            let bound = format!("must not be below the time before it, {}", times[at]);
            Err(InputError::new(format!("{path}[{}]", at + 1), times[at + 1], bound))
        }
    }
}

/// Negates each quaternion whose negative is closer to the previous quaternion.
fn take_short_ways(values: &mut [[f32; 4]]) {
    for at in 1..values.len() {
        let (before, here) = (values[at - 1], values[at]);
        let dot: f64 = before.iter().zip(here).map(|(a, b)| f64::from(*a) * f64::from(b)).sum();
        if dot < 0.0 {
            values[at] = here.map(|component| -component);
        }
    }
}

/// Multiplies each tangent by the duration of its segment in seconds, as the spline formula requires. The segment of an
/// in-tangent ends at the key; the segment of an out-tangent starts at the key.
fn stretch_tangents(times: &[f32], values: &mut [[f32; 4]]) {
    for (key, pair) in times.windows(2).enumerate() {
        for at in [3 * key + 2, 3 * key + 3] {
            values[at] = values[at].map(|tangent| tangent * (pair[1] - pair[0]));
        }
    }
}
