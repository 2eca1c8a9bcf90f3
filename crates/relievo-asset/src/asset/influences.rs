//! Influences: the bones that each vertex follows, up to eight, the strongest first. Distant instances can use fewer
//! (thesis A, section 8.4):
//!
//! - `truncate(k)` keeps the k strongest influences and divides their weights by the sum of the kept weights. Vertices jump
//!   when k changes.
//! - `fade(λ)` subtracts λ times the second strongest weight from every weight except the strongest. The strongest weight grows
//!   so that the sum stays 1. The result is continuous in λ: λ = 0 keeps all weights, bit for bit; λ = 1 leaves only the
//!   strongest influence. The weakest influences vanish first, and shaders do not fetch vanished influences.

use serde::{Deserialize, Serialize};

use crate::InputError;

/// Largest number of bones that a vertex can follow.
pub const MAX_INFLUENCES: usize = 8;

/// A bone, and the weight with which a vertex follows it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Influence {
    /// Index of the bone in the list [`Skin::bones`](super::skeleton::Skin::bones).
    pub bone: u32,
    /// Weight, above 0; the weights of a vertex sum to 1.
    pub weight: f32,
}

/// The influences of every vertex of a mesh: bones and weights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Vec<Influence>>", into = "Vec<Vec<Influence>>")]
pub struct Influences {
    offsets: Vec<u32>,
    all: Vec<Influence>,
}

impl From<Influences> for Vec<Vec<Influence>> {
    fn from(influences: Influences) -> Self {
        (0..influences.vertices()).map(|vertex| influences.of(vertex).to_vec()).collect()
    }
}

impl TryFrom<Vec<Vec<Influence>>> for Influences {
    type Error = InputError;

    fn try_from(stored: Vec<Vec<Influence>>) -> Result<Self, InputError> {
        Self::stored("influences", stored)
    }
}

impl Default for Influences {
    /// Influences of a mesh without vertices.
    fn default() -> Self {
        Self { offsets: vec![0], all: Vec::new() }
    }
}

impl Influences {
    /// Builds influences from the bones and weights of each vertex, given in any order. Weights of the same bone are added, and
    /// weights of 0 are dropped. The remaining weights of a vertex are sorted, the largest first (equal weights by bone), and
    /// divided by their sum. A vertex whose weights are all 0 follows its first bone with a weight of 1, as in three.js.
    ///
    /// # Errors
    /// [`InputError`] for weights that are negative or not finite, for a vertex without bones or with more than
    /// [`MAX_INFLUENCES`], and for a bone index that is not below `bones`, unless the bone's weight is 0. In the path of the
    /// error, `path` precedes the vertex's index.
    pub fn new(
        path: &str,
        bones: usize,
        vertices: impl IntoIterator<Item = Vec<Influence>>,
    ) -> Result<Self, InputError> {
        let mut influences = Self::default();
        for (vertex, mut given) in vertices.into_iter().enumerate() {
            order(&mut given)
                .and_then(|()| check(&given, bones))
                .map_err(|(value, bound)| InputError::new(format!("{path}[{vertex}]"), value, bound))?;
            let sum: f64 = given.iter().map(|influence| f64::from(influence.weight)).sum();
            influences.all.extend(given.iter().map(|influence| Influence {
                bone: influence.bone,
                weight: (f64::from(influence.weight) / sum) as f32,
            }));
            influences.offsets.push(influences.all.len() as u32);
        }
        Ok(influences)
    }

    /// Builds the influences of a rigid mesh: every vertex follows bone 0 with a weight of 1.
    pub fn rigid(vertices: usize) -> Self {
        let one = Influence { bone: 0, weight: 1.0 };
        Self { offsets: (0..=vertices as u32).collect(), all: vec![one; vertices] }
    }

    /// Restores influences that were read with [`Influences::of`] and stored. Order and weights stay the same, bit for bit.
    ///
    /// # Errors
    /// [`InputError`] for weights outside 0..=1, for weights of a vertex that ascend or whose sum differs from 1 by more than
    /// rounding, for a bone that is named twice, and for a vertex without influences or with more than [`MAX_INFLUENCES`].
    pub(crate) fn stored(
        path: &str,
        vertices: impl IntoIterator<Item = Vec<Influence>>,
    ) -> Result<Self, InputError> {
        let mut influences = Self::default();
        for given in vertices {
            influences.restore(path, given)?;
        }
        Ok(influences)
    }

    /// Appends a vertex as [`Influences::stored`] does.
    pub(crate) fn restore(
        &mut self,
        path: &str,
        vertex: impl IntoIterator<Item = Influence>,
    ) -> Result<(), InputError> {
        let first = self.all.len();
        self.all.extend(vertex);
        check_stored(&self.all[first..]).map_err(|(value, bound)| {
            InputError::new(format!("{path}[{}]", self.vertices()), value, bound)
        })?;
        self.offsets.push(self.all.len() as u32);
        Ok(())
    }

    /// Appends a vertex that copies the influences of `vertex`.
    pub(crate) fn repeat(&mut self, vertex: usize) {
        self.all.extend_from_within(self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize);
        self.offsets.push(self.all.len() as u32);
    }

    /// Appends the influences of another mesh's vertices, with the same order and weights. `bone` converts the other mesh's
    /// bone indices to bone indices of this mesh.
    #[doc(hidden)]
    pub fn append(&mut self, other: &Self, mut bone: impl FnMut(u32) -> u32) {
        let first = self.all.len() as u32;
        self.offsets.extend(other.offsets[1..].iter().map(|offset| first + offset));
        let renamed =
            other.all.iter().map(|influence| Influence { bone: bone(influence.bone), ..*influence });
        self.all.extend(renamed);
    }

    /// Influences of one vertex, the strongest first.
    pub fn of(&self, vertex: usize) -> &[Influence] {
        &self.all[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The largest number of influences that any vertex has.
    pub fn most(&self) -> usize {
        self.offsets.windows(2).map(|ends| (ends[1] - ends[0]) as usize).max().unwrap_or(0)
    }

    /// The influences of all vertices, concatenated in the order of the vertices.
    pub fn all(&self) -> &[Influence] {
        &self.all
    }
}

type Fault = (String, String);

/// Adds up the weights of equal bones, drops weights of 0, and sorts the rest. If all weights are 0, the first bone gets a
/// weight of 1.
fn order(given: &mut Vec<Influence>) -> Result<(), Fault> {
    if let Some(wrong) = given.iter().find(|influence| !(0.0..f32::INFINITY).contains(&influence.weight)) {
        return Err((wrong.weight.to_string(), "must be finite, and not negative".to_owned()));
    }
    if given.iter().all(|influence| influence.weight == 0.0)
        && let Some(first) = given.first_mut()
    {
        first.weight = 1.0;
    }
    given.retain(|influence| influence.weight > 0.0);
    given.sort_by_key(|influence| influence.bone);
    given.dedup_by(|next, first| {
        let is_same = next.bone == first.bone;
        if is_same {
            first.weight = (first.weight + next.weight).min(f32::MAX);
        }
        is_same
    });
    given.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    Ok(())
}

fn check(given: &[Influence], bones: usize) -> Result<(), Fault> {
    if given.is_empty() {
        return Err(("0 weights".to_owned(), "must follow a bone".to_owned()));
    }
    if given.len() > MAX_INFLUENCES {
        return Err((format!("{} weights", given.len()), format!("must be at most {MAX_INFLUENCES}")));
    }
    match given.iter().find(|influence| influence.bone as usize >= bones) {
        Some(wrong) => {
            Err((format!("joint {}", wrong.bone), format!("must be below {bones}, the skin's joints")))
        }
        None => Ok(()),
    }
}

/// Checks the influences of a vertex that were ordered before.
fn check_stored(given: &[Influence]) -> Result<(), Fault> {
    check(given, usize::MAX)?;
    let mut most = 1.0;
    for (at, Influence { bone, weight }) in given.iter().enumerate() {
        if !(*weight > 0.0 && *weight <= most) {
            let bound = "must be above 0, and at most 1 and the weight before";
            return Err((weight.to_string(), bound.to_owned()));
        }
        if given[..at].iter().any(|other| other.bone == *bone) {
            return Err((format!("joint {bone}"), "must be named once".to_owned()));
        }
        most = *weight;
    }
    let sum: f64 = given.iter().map(|influence| f64::from(influence.weight)).sum();
    if (sum - 1.0).abs() > 1e-6 {
        return Err((format!("a sum of {sum}"), "must be 1".to_owned()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn influences(given: &[(u32, f32)]) -> Result<Vec<(u32, f32)>, InputError> {
        let given = given.iter().map(|&(bone, weight)| Influence { bone, weight }).collect();
        let all = Influences::new("w", 9, [given])?;
        Ok(all.of(0).iter().map(|influence| (influence.bone, influence.weight)).collect())
    }

    #[test]
    fn the_strongest_come_first_and_sum_to_one() {
        assert_eq!(influences(&[(3, 0.25), (1, 0.0), (2, 0.75)]), Ok(vec![(2, 0.75), (3, 0.25)]));
        assert_eq!(influences(&[(3, 2.0), (1, 2.0), (8, 4.0)]), Ok(vec![(8, 0.5), (1, 0.25), (3, 0.25)]));
        // A bone that is named twice gets the sum of its weights.
        assert_eq!(influences(&[(3, 0.5), (1, 0.25), (3, 0.25)]), Ok(vec![(3, 0.75), (1, 0.25)]));
        assert_eq!(influences(&[(3, f32::MAX), (3, f32::MAX)]), Ok(vec![(3, 1.0)]));
        assert_eq!(influences(&[(3, f32::MIN_POSITIVE)]), Ok(vec![(3, 1.0)]));
        // A bone with a weight of 0 may have any index.
        assert_eq!(influences(&[(3, 1.0), (99, 0.0)]), Ok(vec![(3, 1.0)]));
        // All weights are 0: the vertex follows the first bone.
        assert_eq!(influences(&[(7, 0.0), (1, 0.0), (1, -0.0), (99, 0.0)]), Ok(vec![(7, 1.0)]));
    }

    #[test]
    fn what_follows_nothing_or_too_much_is_refused() {
        let refused = |given: &[(u32, f32)], value: &str| {
            let error = influences(given).expect_err("refused");
            assert_eq!((error.path.as_str(), error.value.as_str()), ("w[0]", value));
        };
        refused(&[], "0 weights");
        refused(&[(9, 0.0), (1, 0.0)], "joint 9");
        refused(&[(0, -0.5), (1, 1.5)], "-0.5");
        refused(&[(0, f32::NAN)], "NaN");
        refused(&[(0, f32::INFINITY)], "inf");
        refused(&[(0, 0.5), (9, 0.5)], "joint 9");
        let nine: Vec<_> = (0..9).map(|bone| (bone, 0.1)).collect();
        refused(&nine, "9 weights");
        assert!(influences(&nine[..8]).is_ok());
    }
}
