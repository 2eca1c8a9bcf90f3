//! Morph targets, which move vertices before skinning, and the keys of their weights (glTF 2.0, sections 3.7.2.2 and 3.11).

use serde::{Deserialize, Serialize};

use super::clip::{Interpolation, check_times};
use super::keyframe::{KeyframeCursor, keyframe_cursor};
use super::transform::finite;
use crate::InputError;

/// A morph target: the displacement of some vertices at a weight of 1. All other vertices stay in place.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MorphTarget {
    /// Indices of the displaced vertices, ascending.
    pub vertices: Vec<u32>,
    /// One delta for each entry of `vertices`, added to the vertex's position, normal and tangent.
    pub deltas: Vec<MorphDelta>,
}

/// The displacement of a vertex at a weight of 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MorphDelta {
    /// Change of the vertex's position.
    pub position: [f32; 3],
    /// Change of the vertex's normal.
    pub normal: [f32; 3],
    /// Change of the vertex's tangent.
    pub tangent: [f32; 3],
}

impl MorphTarget {
    /// Builds a morph target from one delta per vertex of the mesh. Vertices with a delta of 0 are left out.
    pub fn new(deltas: &[MorphDelta]) -> Self {
        let moving = (0..).zip(deltas).filter(|(_, delta)| **delta != MorphDelta::default());
        let (vertices, deltas) = moving.map(|(vertex, delta): (u32, _)| (vertex, *delta)).unzip();
        Self { vertices, deltas }
    }

    /// Gives vertex `copy` the same delta as `vertex`, if `vertex` has one. The index `copy` must exceed all indices in the
    /// target.
    pub(crate) fn repeat(&mut self, vertex: u32, copy: u32) {
        if let Ok(at) = self.vertices.binary_search(&vertex) {
            self.vertices.push(copy);
            self.deltas.push(self.deltas[at]);
        }
    }
}

/// The keys of a mesh's morph weights in one clip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StoredKeys")]
pub struct WeightKeys {
    times: Vec<f32>,
    values: Vec<f32>,
    interpolation: Interpolation,
    targets: usize,
}

/// Weight keys as serde reads them, before validation.
#[derive(Deserialize)]
#[serde(rename = "WeightKeys")]
struct StoredKeys {
    times: Vec<f32>,
    values: Vec<f32>,
    interpolation: Interpolation,
    targets: usize,
}

impl TryFrom<StoredKeys> for WeightKeys {
    type Error = InputError;

    fn try_from(stored: StoredKeys) -> Result<Self, InputError> {
        let StoredKeys { times, values, interpolation, targets } = stored;
        // With more targets than values, the product that `new` computes could overflow.
        let bound = || format!("must be at most {}, the number of values", values.len());
        InputError::check(targets <= values.len(), "weight_keys.targets", targets, bound)?;
        Self::new(["weight_keys.times", "weight_keys.values"], times, values, interpolation, targets)
    }
}

impl WeightKeys {
    /// Builds the keys of `targets` weights. Each key has one value per target. In a cubic spline, a key has first the
    /// in-tangents of all targets, then all values, then all out-tangents. A tangent is a change of weight per second.
    /// `at_times` and `at_values` are the paths of `times` and `values` in errors.
    ///
    /// # Errors
    /// [`InputError`] for no keys or no targets; for times that descend, are negative, too large or not finite; for a wrong
    /// number of values; and for values that are not finite.
    pub fn new(
        [at_times, at_values]: [&str; 2],
        times: Vec<f32>,
        values: Vec<f32>,
        interpolation: Interpolation,
        targets: usize,
    ) -> Result<Self, InputError> {
        check_times(at_times, &times)?;
        let each = interpolation.values_a_key() * targets;
        if targets == 0 || values.len() != each * times.len() {
            let bound = format!("must be {}, {each} a key", each * times.len());
            return Err(InputError::new(format!("{at_values}.len"), values.len(), bound));
        }
        finite(at_values, &values)?;
        Ok(Self { times, values, interpolation, targets })
    }

    /// The weight of each target at a time in seconds inside the clip.
    pub fn at(&self, time: f32) -> Vec<f32> {
        let KeyframeCursor { key, fraction } = keyframe_cursor(&self.times, time);
        let key = key as usize;
        (0..self.targets).map(|target| self.between(key, fraction, target)).collect()
    }

    /// Key times in seconds, weights at the keys, and interpolation.
    #[doc(hidden)]
    pub fn parts(&self) -> (&[f32], &[f32], Interpolation) {
        (&self.times, &self.values, self.interpolation)
    }

    /// Number of morph targets whose weights have keys.
    pub(crate) fn targets(&self) -> usize {
        self.targets
    }

    fn between(&self, key: usize, t: f32, target: usize) -> f32 {
        let value = |key: usize, part: usize| match self.interpolation {
            Interpolation::CubicSpline => self.values[(3 * key + part) * self.targets + target],
            _ => self.values[key * self.targets + target],
        };
        let start = value(key, 1);
        match self.interpolation {
            _ if t <= 0.0 => start,
            Interpolation::Step => start,
            Interpolation::Linear => start + (value(key + 1, 1) - start) * t,
            Interpolation::CubicSpline => {
                let seconds = self.times[key + 1] - self.times[key];
                let (square, cube) = (t * t, t * t * t);
                let of_end = 3.0 * square - 2.0 * cube;
                (1.0 - of_end) * start
                    + (cube - 2.0 * square + t) * (seconds * value(key, 2))
                    + of_end * value(key + 1, 1)
                    + (cube - square) * (seconds * value(key + 1, 0))
            }
        }
    }

    /// Upper bound on the absolute value of a target's weight over the whole clip.
    pub fn largest(&self, target: usize) -> f32 {
        let all = (0..self.times.len()).map(|key| self.between(key, 0.0, target).abs());
        let values = all.fold(0.0, f32::max);
        if self.interpolation != Interpolation::CubicSpline {
            return values;
        }
        // The two tangents have the factors t³ − 2t² + t and t³ − t². The absolute values of these factors add up to t − t²,
        // which is at most 1/4.
        let tangent = |key: usize, part: usize| self.values[(3 * key + part) * self.targets + target].abs();
        let bends = (1..self.times.len())
            .map(|key| (self.times[key] - self.times[key - 1]) * tangent(key - 1, 2).max(tangent(key, 0)));
        values + 0.25 * bends.fold(0.0, f32::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(values: &[f32], interpolation: Interpolation) -> Result<WeightKeys, InputError> {
        WeightKeys::new(["t", "v"], vec![0.0, 2.0], values.to_vec(), interpolation, 2)
    }

    #[test]
    fn weights_follow_their_keys() {
        let values = [0.0, 1.0, 4.0, -1.0];
        let linear = keys(&values, Interpolation::Linear).expect("valid");
        assert_eq!(
            (linear.at(0.5), linear.at(2.0), linear.at(9.0)),
            (vec![1.0, 0.5], vec![4.0, -1.0], vec![4.0, -1.0])
        );
        assert_eq!((linear.largest(0), linear.largest(1)), (4.0, 1.0));
        let step = keys(&values, Interpolation::Step).expect("valid");
        assert_eq!((step.at(1.9), step.at(2.0)), (vec![0.0, 1.0], vec![4.0, -1.0]));
        // In-tangents, values, out-tangents of two targets. The second target's weight curves between its keys.
        let spline = [0.0, 0.0, 0.0, 1.0, 0.0, 6.0, 0.0, -6.0, 4.0, 1.0, 0.0, 0.0];
        let spline = keys(&spline, Interpolation::CubicSpline).expect("valid");
        assert_eq!(
            (spline.at(0.0), spline.at(1.0)),
            (vec![0.0, 1.0], vec![2.0, 1.0 + 0.125 * 12.0 + 0.125 * 12.0])
        );
        assert_eq!((spline.largest(0), spline.largest(1)), (4.0, 1.0 + 0.25 * 12.0));
    }

    #[test]
    fn keys_are_checked() {
        let refused = |values: &[f32]| keys(values, Interpolation::Linear).expect_err("refused").path;
        assert_eq!(refused(&[0.0; 3]), "v.len");
        assert_eq!(refused(&[0.0, 0.0, f32::NAN, 0.0]), "v[2]");
        let descending = WeightKeys::new(["t", "v"], vec![1.0, 0.0], vec![0.0; 2], Interpolation::Step, 1);
        assert_eq!(descending.expect_err("refused").path, "t[1]");
    }

    #[test]
    fn targets_keep_what_moves() {
        let moving = MorphDelta { normal: [0.0, 1.0, 0.0], ..MorphDelta::default() };
        let target = MorphTarget::new(&[MorphDelta::default(), moving, MorphDelta::default()]);
        assert_eq!(target, MorphTarget { vertices: vec![1], deltas: vec![moving] });
    }
}
