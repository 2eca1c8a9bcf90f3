//! Derives priority weights from a clip (thesis A, section 14, future work). The weights tell how well each term predicts the
//! error of freezing a bone from one key to the next.

use super::{Differences, Weights};
use crate::InputError;
use crate::animation::instance::Wrap;
use crate::animation::local_to_model::reference::{affine, local_to_model, product};
use crate::animation::sample::reference::{sample, sample_bone};
use crate::asset::clip::Clip;
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;
use crate::asset::transform::{Affine, Transform};

/// Times at which the error of a frozen bone is measured, as fractions of the time from a key to the next.
const MOMENTS: [f32; 4] = [0.25, 0.5, 0.75, 1.0];

impl Weights {
    /// Derives the weights of the first five terms from a clip that plays with `wrap`. Each bone is frozen from each of its keys
    /// to the next, and the errors in model space are measured. A non-negative least squares fit of the terms to these errors
    /// gives the weights.
    ///
    /// The user term keeps its default weight; the fit divides the remaining weight. If nothing moves in the clip, or if no term
    /// has an effect, the result is the default weights.
    ///
    /// The error is the root mean square of displacements over four moments and all bones. The displaced points lie on each
    /// bone's axes. Their distance from the bone's origin is the bone's length.
    ///
    /// # Errors
    /// [`InputError`] if the clip's number of bones differs from the skeleton's.
    pub fn analyze(skeleton: &Skeleton, clip: &Clip, wrap: Wrap) -> Result<Self, InputError> {
        let differences = Differences::new(skeleton, clip, wrap)?;
        let errors = freezing_errors(skeleton, clip, &differences);
        let largest = errors.iter().copied().fold(0.0, f64::max);
        // After its last key, a bone has no motion to freeze.
        let last = differences.keys.iter().map(|key| key.until <= key.time);
        let rows = differences.terms(skeleton).into_iter().zip(&errors).zip(last).filter(|(_, last)| !last);
        let (terms, targets): (Vec<_>, Vec<_>) =
            rows.map(|((terms, error), _)| (terms, error / largest)).unzip();
        let fitted = if largest > 0.0 { non_negative_least_squares(&terms, &targets) } else { [0.0; 5] };
        let sum: f64 = fitted.iter().sum();
        if sum.is_nan() || sum <= 0.0 {
            return Ok(Self::default());
        }
        let of_user = Self::default().0[5];
        let fraction = |weight: f64| weight / sum * (1.0 - of_user);
        let [translation, rotation, scale, children, depth] = fitted.map(fraction);
        Ok(Self([translation, rotation, scale, children, depth, of_user]))
    }
}

/// A bone frozen at a key, to be compared with its true pose at a later time.
struct Probe {
    time: f32,
    key: usize,
    bone: u32,
    frozen: Transform,
}

/// Error of freezing each key's bone until the next key: one value per key.
fn freezing_errors(skeleton: &Skeleton, clip: &Clip, differences: &Differences) -> Vec<f64> {
    let mut probes = Vec::new();
    for (index, key) in differences.keys.iter().enumerate().filter(|(_, key)| key.until > key.time) {
        let frozen = sample_bone(clip, key.bone as usize, key.time, RotationPath::Slerp);
        let at = |fraction: f32| key.time + (key.until - key.time) * fraction;
        probes.extend(MOMENTS.map(|fraction| Probe {
            time: at(fraction),
            key: index,
            bone: key.bone,
            frozen,
        }));
    }
    // Sort by time, so that all probes of one time share one pose.
    probes.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.key.cmp(&b.key)));
    let lengths = skeleton.lengths();
    let mut squares = vec![0.0; differences.keys.len()];
    for moment in probes.chunk_by(|a, b| a.time == b.time) {
        let locals = sample(clip, moment[0].time, RotationPath::Slerp);
        let model_matrices = local_to_model(skeleton, &locals);
        for probe in moment {
            squares[probe.key] += square_error(skeleton, &locals, &model_matrices, &lengths, probe);
        }
    }
    let values = (MOMENTS.len() * skeleton.len()) as f64;
    squares.into_iter().map(|square| (square / values).sqrt()).collect()
}

/// Sum, over all bones, of the squared error that one frozen bone causes. Only the bone and its descendants have an error.
fn square_error(
    skeleton: &Skeleton,
    locals: &[Transform],
    model_matrices: &[Affine],
    lengths: &[f64],
    probe: &Probe,
) -> f64 {
    let first = probe.bone as usize;
    let mut moved: Vec<Option<Affine>> = vec![None; skeleton.len() - first];
    let mut sum = 0.0;
    for (bone, node) in skeleton.bones().iter().enumerate().skip(first) {
        let stale = if bone == first {
            let local = affine(&probe.frozen);
            Some(node.parent.map_or(local, |parent| product(&model_matrices[parent as usize], &local)))
        } else {
            let above = node.parent.and_then(|parent| (parent as usize).checked_sub(first));
            above.and_then(|at| moved[at]).map(|parent| product(&parent, &affine(&locals[bone])))
        };
        if let Some(stale) = &stale {
            sum += farthest(stale, &model_matrices[bone], lengths[bone]).powi(2);
        }
        moved[bone - first] = stale;
    }
    sum
}

/// Largest displacement of three points, which lie on the bone's axes at the distance `length` from its origin.
pub(super) fn farthest(stale: &Affine, fresh: &Affine, length: f64) -> f64 {
    let off = |axis: usize| {
        let squares = stale.iter().zip(fresh).map(|(stale, fresh)| {
            let turned = f64::from(stale[axis]) - f64::from(fresh[axis]);
            (f64::from(stale[3]) - f64::from(fresh[3]) + length * turned).powi(2)
        });
        squares.sum::<f64>().sqrt()
    };
    off(0).max(off(1)).max(off(2))
}

/// Returns the `x ≥ 0` that minimizes `|rows · x − targets|`. With five unknowns, all subsets can be tried. In each try, the
/// unknowns of one subset are free and the others are 0. The best non-negative solution wins.
pub(super) fn non_negative_least_squares(rows: &[[f64; 5]], targets: &[f64]) -> [f64; 5] {
    let mut normal = [[0.0; 5]; 5];
    let mut right = [0.0; 5];
    for (row, target) in rows.iter().zip(targets) {
        for i in 0..5 {
            right[i] += row[i] * target;
            (0..5).for_each(|j| normal[i][j] += row[i] * row[j]);
        }
    }
    // The value of |rows · x − targets|² minus a constant.
    let cost = |x: &[f64; 5]| -> f64 {
        let product = |i: usize| (0..5).map(|j| normal[i][j] * x[j]).sum::<f64>();
        (0..5).map(|i| x[i] * (product(i) - 2.0 * right[i])).sum()
    };
    let mut best = [0.0; 5];
    for subset in 1_u32..32 {
        if let Some(x) = solve(&normal, &right, subset)
            && x.iter().all(|value| *value >= 0.0)
            && cost(&x) < cost(&best)
        {
            best = x;
        }
    }
    best
}

/// Solves the normal equations for a subset of the unknowns; `None` if the solution is not unique.
fn solve(normal: &[[f64; 5]; 5], right: &[f64; 5], subset: u32) -> Option<[f64; 5]> {
    let chosen: Vec<usize> = (0..5).filter(|i| subset & (1 << i) != 0).collect();
    let mut rows: Vec<Vec<f64>> =
        (chosen.iter()).map(|i| chosen.iter().map(|j| normal[*i][*j]).chain([right[*i]]).collect()).collect();
    let size = rows.len();
    for at in 0..size {
        let pivot = (at..size).max_by(|a, b| rows[*a][at].abs().total_cmp(&rows[*b][at].abs()))?;
        rows.swap(at, pivot);
        if rows[at][at].abs() <= 1e-12 * normal[chosen[at]][chosen[at]] {
            return None;
        }
        let lead = rows[at].clone();
        for row in rows.iter_mut().skip(at + 1) {
            let factor = row[at] / lead[at];
            row.iter_mut().zip(&lead).for_each(|(value, lead)| *value -= factor * lead);
        }
    }
    let mut x = [0.0; 5];
    for at in (0..size).rev() {
        let known: f64 = (at + 1..size).map(|j| rows[at][j] * x[chosen[j]]).sum();
        x[chosen[at]] = (rows[at][size] - known) / rows[at][at];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::clip::{BoneKeys, Interpolation, Keys};
    use crate::asset::skeleton::Bone;
    use crate::samples::creature;

    #[test]
    fn least_squares_finds_what_made_the_targets() {
        let noise = |index: usize| ((index * 7919 + 13) % 101) as f64 / 101.0;
        let rows: Vec<[f64; 5]> = (0..60).map(|r| std::array::from_fn(|c| noise(5 * r + c * c))).collect();
        let truth = [0.5, 0.0, 2.0, 0.25, 1.0];
        let of = |x: &[f64; 5]| -> Vec<f64> {
            rows.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
        };
        let found = non_negative_least_squares(&rows, &of(&truth));
        assert!(found.iter().zip(truth).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
        // The negative value is clamped to 0, and no nearby x ≥ 0 is better.
        let targets = of(&[1.0, -0.5, 0.0, 0.3, 0.0]);
        let found = non_negative_least_squares(&rows, &targets);
        let cost = |x: &[f64; 5]| of(x).iter().zip(&targets).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        assert!(found.iter().all(|value| *value >= 0.0) && found.contains(&0.0), "{found:?}");
        for (at, step) in (0..5).flat_map(|at| [1e-4, -1e-4].map(|step| (at, step))) {
            let mut other = found;
            other[at] = f64::max(0.0, other[at] + step);
            assert!(cost(&other) >= cost(&found), "{at} {step}");
        }
    }

    #[test]
    fn equal_columns_do_not_confuse_it() {
        let rows = [[1.0, 1.0, 0.0, 0.0, 0.0], [2.0, 2.0, 0.0, 0.0, 0.0]];
        let found = non_negative_least_squares(&rows, &[3.0, 6.0]);
        assert!((found[0] + found[1] - 3.0).abs() < 1e-9 && found[2..] == [0.0; 3], "{found:?}");
        assert_eq!(non_negative_least_squares(&rows, &[-1.0, -1.0]), [0.0; 5]);
    }

    fn chain(parts: [Option<Keys>; 3]) -> (Skeleton, Clip) {
        let bone = |parent| Bone {
            name: String::new(),
            parent,
            rest: Transform::from_translation([0.0, f32::from(parent.is_some()), 0.0]),
        };
        let skeleton = Skeleton::of_joints(vec![bone(None), bone(Some(0)), bone(Some(1))]).expect("valid");
        let [translation, rotation, scale] = parts;
        let bones = [BoneKeys::default(), BoneKeys { translation, rotation, scale }, BoneKeys::default()];
        let clip = Clip::new("test", &skeleton, &bones, 0.0).expect("valid");
        (skeleton, clip)
    }

    fn keys(times: &[f32], values: &[[f32; 4]]) -> Option<Keys> {
        let (times, values) = (times.to_vec(), values.to_vec());
        Some(Keys { times, values, interpolation: Interpolation::Linear })
    }

    /// Compares with values computed by hand. The middle bone moves 4 m in a second, so at the four moments the frozen bone and
    /// its child are 1, 2, 3 and 4 m off.
    #[test]
    fn the_error_of_freezing_is_the_one_computed_by_hand() {
        let (skeleton, clip) = chain([keys(&[0.0, 1.0], &[[0.0; 4], [4.0, 0.0, 0.0, 0.0]]), None, None]);
        let differences = Differences::new(&skeleton, &clip, Wrap::Loop).expect("fits");
        let errors = freezing_errors(&skeleton, &clip, &differences);
        let expected = (2.0 * (1.0 + 4.0 + 9.0 + 16.0) / 12.0_f64).sqrt();
        assert!((errors[0] - expected).abs() < 1e-6 && errors[1] == 0.0, "{errors:?} {expected}");
    }

    /// Only the translation changes, and the error is proportional to this change. The translation term then gets all weight that
    /// the user term leaves.
    #[test]
    fn the_part_that_moves_gets_the_weight() {
        let distances = [0.0, 1.0, 1.5, 4.0, 0.0].map(|x| [x, 0.0, 0.0, 0.0]);
        let (skeleton, clip) = chain([keys(&[0.0, 1.0, 2.0, 3.0, 4.0], &distances), None, None]);
        let weights = Weights::analyze(&skeleton, &clip, Wrap::Loop).expect("fits");
        assert!(weights.validate().is_ok());
        assert!(
            (weights.0[0] - 5.0 / 6.0).abs() < 1e-3 && (weights.0[5] - 1.0 / 6.0).abs() < 1e-12,
            "{weights:?}"
        );
    }

    #[test]
    fn nothing_moving_gives_the_default() {
        let (skeleton, clip) = chain([keys(&[0.0, 1.0], &[[0.0; 4], [0.0; 4]]), None, None]);
        assert_eq!(Weights::analyze(&skeleton, &clip, Wrap::Loop), Ok(Weights::default()));
    }

    /// Checks that the fitted weights explain the errors better than equal weights do.
    #[test]
    fn the_creatures_weights_fit_better_than_equal_ones() {
        let model = creature().expect("valid");
        for clip in &model.clips {
            let weights = Weights::analyze(&model.skeleton, clip, Wrap::Loop).expect("fits");
            assert!(weights.validate().is_ok());
            let differences = Differences::new(&model.skeleton, clip, Wrap::Loop).expect("fits");
            let terms = differences.terms(&model.skeleton);
            let errors = freezing_errors(&model.skeleton, clip, &differences);
            // Squared difference between the errors and the weighted terms, after scaling the terms by the best factor.
            let misfit = |weights: &[f64]| {
                let sums: Vec<f64> =
                    terms.iter().map(|row| row.iter().zip(weights).map(|(a, b)| a * b).sum()).collect();
                let scale = sums.iter().zip(&errors).map(|(a, b)| a * b).sum::<f64>()
                    / sums.iter().map(|a| a * a).sum::<f64>();
                sums.iter().zip(&errors).map(|(a, b)| (scale * a - b).powi(2)).sum::<f64>()
            };
            let (fitted, equal) = (misfit(&weights.0[..5]), misfit(&[1.0; 5]));
            assert!(fitted < 0.9 * equal, "{}: {fitted} {equal}", clip.name());
        }
    }
}
