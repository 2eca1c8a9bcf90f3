//! Priority of each key of each bone: how much the key contributes to the shape of the character (thesis A, section 12).
//! Priorities are computed once per clip, at load time.
//!
//! A bone has one key per distinct time of its translation, rotation and scale keys. Each key has six terms from 0 to 1:
//!
//! | term | value | divided by |
//! |---|---|---|
//! | translation | distance from this key to the next, times the largest scale of each ancestor at rest | the clip's largest |
//! | rotation | angle from this key to the next, in radians | the clip's largest |
//! | scale | change of scale from this key to the next, divided by the bone's largest scale at rest | the clip's largest |
//! | children | number of descendants | the skeleton's largest |
//! | depth | D − d + 1 for a bone d steps from the root, where D is the depth of the deepest bone | D + 1 |
//! | user | given for each bone; ½ by default | 1 |
//!
//! A key's priority is the weighted mean of its six terms.
//!
//! A term is 0 if the largest value that it is divided by is below [`NOISE`] (for translations, relative to the model's size).
//! Noise thus never becomes important. If the clip loops, the bone's last key is followed by its first. Otherwise the last key
//! has no next key, and its first three terms are 0.
//!
//! **Decided**: a key is compared with the next one, as in the equations of thesis A (12.2 to 12.4). The thesis's prose compares
//! it with the previous one (10.6, 14). The next key is right, because a bone that skips updates after a key misses the motion
//! towards the next key.
//!
//! **Decided**: the rotation term is the angle, as the prose of thesis A means it (11.2). Equation 12.3 is the dot product of two
//! quaternions. That product is *largest* when nothing rotates, and it distinguishes q from −q.
//!
//! **Decided**: the depth term is highest at the root, as in the prose of thesis A (10.5, 11.5). The equation d/D of section 12.7
//! grows away from the root. The equation D/d of section 10.5 divides by 0 at the root.

mod analyze;
mod differences;

use crate::InputError;
use crate::animation::instance::Wrap;
use crate::asset::clip::Clip;
use crate::asset::skeleton::Skeleton;

use differences::{Difference, Differences};
pub use differences::{key_times, size};

/// Threshold below which the largest value of a term counts as 0. It is in radians for rotations, a factor of the scale at rest
/// for scales, and a fraction of the model's size for translations.
pub const NOISE: f64 = 1e-6;

/// Default value of a bone's user term.
pub const USER_DEFAULT: f32 = 0.5;

/// Names of the six terms of a priority, in the order of their weights.
pub const TERMS: [&str; 6] = ["translation", "rotation", "scale", "children", "depth", "user"];

/// Weights of the six terms of a priority, in the order of [`TERMS`]. They must sum to 1.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Weights(pub [f64; 6]);

impl Default for Weights {
    /// Equal weights of 1/6, as in thesis A.
    fn default() -> Self {
        Self([1.0 / 6.0; 6])
    }
}

impl Weights {
    /// Checks that each weight is within 0..=1 and that the weights sum to 1.
    ///
    /// # Errors
    /// [`InputError`] for weights outside 0..=1, and if the sum differs from 1 by more than 1e-4.
    pub fn validate(&self) -> Result<(), InputError> {
        for (weight, term) in self.0.iter().zip(TERMS) {
            InputError::check_within(format!("weights.{term}"), *weight, 0.0..=1.0)?;
        }
        let sum: f64 = self.0.iter().sum();
        if (sum - 1.0).abs() > 1e-4 {
            return Err(InputError::new("weights", sum, "must sum to 1"));
        }
        Ok(())
    }
}

/// The priority of one key of one bone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeyPriority {
    /// Index of the bone in the skeleton.
    pub bone: u32,
    /// Index of the key within the bone's keys.
    pub key: u32,
    /// Time of the key in seconds.
    pub time: f32,
    /// Terms in the order of [`TERMS`], each 0 to 1.
    pub terms: [f32; 6],
    /// Priority of the key, 0 to 1: the weighted mean of its terms.
    pub priority: f32,
}

/// Priorities of all keys of a clip, bone by bone and key by key.
#[derive(Debug, Clone, PartialEq)]
pub struct Priorities {
    /// The keys of all bones, one bone after another.
    pub keys: Vec<KeyPriority>,
    /// Index in `keys` of the first key of each bone, followed by the number of keys.
    pub offsets: Vec<u32>,
}

impl Priorities {
    /// Computes the priorities of all keys of a clip that plays with `wrap`. `user` has one user term per bone, 0 to 1.
    ///
    /// # Errors
    /// [`InputError`] for invalid weights ([`Weights::validate`]), for a clip of another skeleton, if `user` does not have one
    /// value per bone, and for values in `user` outside 0..=1.
    pub fn new(
        skeleton: &Skeleton,
        clip: &Clip,
        wrap: Wrap,
        weights: &Weights,
        user: &[f32],
    ) -> Result<Self, InputError> {
        weights.validate()?;
        check_user(skeleton, user)?;
        let differences = Differences::new(skeleton, clip, wrap)?;
        let weigh = |(key, first): (&Difference, [f64; 5])| {
            let terms = [first[0], first[1], first[2], first[3], first[4], user[key.bone as usize].into()];
            let sum: f64 = terms.iter().zip(weights.0).map(|(term, weight)| term * weight).sum();
            KeyPriority {
                bone: key.bone,
                key: key.key,
                time: key.time,
                terms: terms.map(|term| term as f32),
                priority: sum as f32,
            }
        };
        let keys = differences.keys.iter().zip(differences.terms(skeleton)).map(weigh).collect();
        Ok(Self { keys, offsets: differences.offsets })
    }

    /// Priorities of the keys of one bone, in order of time.
    pub fn of(&self, bone: usize) -> &[KeyPriority] {
        &self.keys[self.offsets[bone] as usize..self.offsets[bone + 1] as usize]
    }
}

fn check_user(skeleton: &Skeleton, user: &[f32]) -> Result<(), InputError> {
    InputError::check_len("user", user.len(), skeleton.len(), "a bone")?;
    InputError::check_each("user", user, |value| (0.0..=1.0).contains(value), "must be in 0..=1")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::clip::{BoneKeys, Interpolation, Keys};
    use crate::asset::skeleton::Bone;
    use crate::asset::transform::Transform;

    /// The bones are root ─ arm ─ hand, and a leg below the root. Descendants per bone: 3, 1, 0, 0. Steps from the root: 0, 1, 2,
    /// 1.
    fn skeleton() -> Skeleton {
        let rest = Transform::from_translation([0.0, 1.0, 0.0]);
        let bone = |parent| Bone { name: String::new(), parent, rest };
        Skeleton::of_joints([None, Some(0), Some(1), Some(0)].map(bone).to_vec()).expect("valid")
    }

    fn keys(times: &[f32], values: &[[f32; 4]]) -> Option<Keys> {
        let (times, values) = (times.to_vec(), values.to_vec());
        Some(Keys { times, values, interpolation: Interpolation::Linear })
    }

    /// The root moves 2 m, then 1 m. The arm turns by ¼, then ⅛ of a turn. The hand grows by 0.6 between two scale keys, and has
    /// a translation key between them.
    fn clip() -> Clip {
        let turn = |turns: f32| {
            let half = turns * std::f32::consts::PI;
            [0.0, half.sin(), 0.0, half.cos()]
        };
        let root = keys(&[0.0, 1.0, 2.0], &[[0.0; 4], [2.0, 0.0, 0.0, 0.0], [2.0, 1.0, 0.0, 0.0]]);
        let arm = keys(&[0.0, 0.5, 2.0], &[turn(0.0), turn(0.25).map(|x| -x), turn(0.375)]);
        let hand = keys(&[0.0, 2.0], &[[1.0, 1.0, 1.0, 0.0], [1.6, 1.0, 1.0, 0.0]]);
        let bones = [
            BoneKeys { translation: root, ..BoneKeys::default() },
            BoneKeys { rotation: arm, ..BoneKeys::default() },
            BoneKeys { scale: hand, translation: keys(&[1.0], &[[0.0; 4]]), ..BoneKeys::default() },
            BoneKeys::default(),
        ];
        Clip::new("test", &skeleton(), &bones, 0.0).expect("valid")
    }

    fn of(wrap: Wrap, weights: Weights) -> Priorities {
        Priorities::new(&skeleton(), &clip(), wrap, &weights, &[USER_DEFAULT; 4]).expect("valid")
    }

    fn close(found: &[KeyPriority], expected: &[(f32, [f32; 6])]) {
        assert_eq!(found.len(), expected.len());
        for (found, (time, terms)) in found.iter().zip(expected) {
            assert_eq!(found.time, *time);
            let error = found.terms.iter().zip(terms).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(error < 1e-6, "{found:?} instead of {terms:?}");
            assert!((found.priority - terms.iter().sum::<f32>() / 6.0).abs() < 1e-6, "{found:?}");
        }
    }

    #[test]
    fn terms_are_those_computed_by_hand() {
        let found = of(Wrap::Clamp, Weights::default());
        assert_eq!(found.offsets, [0, 3, 6, 9, 9]);
        // Largest values in the clip: 2 m, ¼ turn, scale change 0.6. In the skeleton: 3 descendants, depth 2.
        close(
            found.of(0),
            &[
                (0.0, [1.0, 0.0, 0.0, 1.0, 1.0, 0.5]),
                (1.0, [0.5, 0.0, 0.0, 1.0, 1.0, 0.5]),
                (2.0, [0.0, 0.0, 0.0, 1.0, 1.0, 0.5]),
            ],
        );
        let (third, two_thirds) = (1.0 / 3.0, 2.0 / 3.0);
        close(
            found.of(1),
            &[
                (0.0, [0.0, 1.0, 0.0, third, two_thirds, 0.5]),
                (0.5, [0.0, 0.5, 0.0, third, two_thirds, 0.5]),
                (2.0, [0.0, 0.0, 0.0, third, two_thirds, 0.5]),
            ],
        );
        // The hand's keys are at 0, 1 and 2. Its scale is halfway at 1.
        close(
            found.of(2),
            &[
                (0.0, [0.0, 0.0, 1.0, 0.0, third, 0.5]),
                (1.0, [0.0, 0.0, 1.0, 0.0, third, 0.5]),
                (2.0, [0.0, 0.0, 0.0, 0.0, third, 0.5]),
            ],
        );
        assert!(found.of(3).is_empty());
    }

    /// The root stands still, jumps, and stands still again. The key before the jump must count, not the key after it.
    #[test]
    fn a_key_is_compared_with_the_next_one() {
        let x = |x: f32| [x, 0.0, 0.0, 0.0];
        let moves = keys(&[0.0, 1.0, 2.0, 3.0], &[x(0.0), x(0.0), x(3.0), x(3.0)]);
        let bones = [BoneKeys { translation: moves, ..BoneKeys::default() }];
        let bones: Vec<_> = bones.into_iter().chain(vec![BoneKeys::default(); 3]).collect();
        let clip = Clip::new("test", &skeleton(), &bones, 0.0).expect("valid");
        let found =
            Priorities::new(&skeleton(), &clip, Wrap::Clamp, &Weights::default(), &[0.5; 4]).expect("valid");
        let terms: Vec<f32> = found.of(0).iter().map(|key| key.terms[0]).collect();
        assert_eq!(terms, [0.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn loops_lead_back_to_the_first_key() {
        let found = of(Wrap::Loop, Weights::default());
        // The loop leads from (2, 1) back to 0. √5 m is now the largest translation, and ⅜ of a turn the largest rotation.
        let far = 5.0_f32.sqrt();
        assert!(
            (found.of(0)[0].terms[0] - 2.0 / far).abs() < 1e-6
                && (found.of(0)[2].terms[0] - 1.0).abs() < 1e-6
        );
        assert!(
            (found.of(1)[0].terms[1] - 2.0 / 3.0).abs() < 1e-6
                && (found.of(1)[2].terms[1] - 1.0).abs() < 1e-6
        );
        // The scale changes by 0.3 and 0.3 forward, then by 0.6 back.
        assert!((found.of(2)[0].terms[2] - 0.5).abs() < 1e-6 && (found.of(2)[2].terms[2] - 1.0).abs() < 1e-6);
    }

    #[test]
    fn weights_choose_terms() {
        let only = |term: usize| Weights(std::array::from_fn(|at| if at == term { 1.0 } else { 0.0 }));
        for term in 0..6 {
            for key in of(Wrap::Loop, only(term)).keys {
                assert_eq!(key.priority, key.terms[term]);
            }
        }
        let user = [0.0, 1.0, 0.25, 0.5];
        let found = Priorities::new(&skeleton(), &clip(), Wrap::Loop, &only(5), &user).expect("valid");
        assert!(found.keys.iter().all(|key| key.priority == user[key.bone as usize]));
    }

    #[test]
    fn noise_is_no_importance() {
        let tiny = keys(&[0.0, 1.0], &[[0.0; 4], [1e-6, 0.0, 0.0, 0.0]]);
        let bones = [BoneKeys { translation: tiny, ..BoneKeys::default() }];
        let bones: Vec<_> = bones.into_iter().chain(vec![BoneKeys::default(); 3]).collect();
        let clip = Clip::new("test", &skeleton(), &bones, 0.0).expect("valid");
        // The skeleton is 2 m tall. A motion of 1e-6 m is less than 1e-6 of this height.
        let found =
            Priorities::new(&skeleton(), &clip, Wrap::Loop, &Weights::default(), &[0.5; 4]).expect("valid");
        assert!((size(&skeleton()) - 2.0).abs() < 1e-6);
        assert!(found.keys.iter().all(|key| key.terms[..3] == [0.0; 3]));
    }

    /// A translation below a scaled bone counts by its size in model space. Noise counts as 0 at every scale.
    #[test]
    fn units_do_not_matter() {
        // Compares a model 2 m tall with the same model in other units: bones are scaled and animated accordingly. The arm's
        // translation is twice the root's, and the hand's is half the root's.
        let found = |scale: f32, noise: f32| {
            let rest = |at: usize| Transform {
                translation: [0.0, if at == 0 { 1.0 } else { 1.0 / scale }, 0.0],
                scale: if at == 0 { [scale; 3] } else { [1.0; 3] },
                ..Transform::IDENTITY
            };
            let plain = skeleton();
            let bones =
                plain.bones().iter().enumerate().map(|(at, bone)| Bone { rest: rest(at), ..bone.clone() });
            let skeleton = Skeleton::of_joints(bones.collect()).expect("valid");
            let moved = |x: f32| keys(&[0.0, 1.0], &[[0.0; 4], [x * noise, 0.0, 0.0, 0.0]]);
            // A scale change by rounding, as large as noise can be.
            let grown = scale * (1.0 + 5e-7);
            let bones = [
                BoneKeys {
                    translation: moved(1.0),
                    scale: keys(&[0.0, 1.0], &[[scale, scale, scale, 0.0], [grown, scale, scale, 0.0]]),
                    ..BoneKeys::default()
                },
                BoneKeys { translation: moved(2.0 / scale), ..BoneKeys::default() },
                BoneKeys { translation: moved(0.5 / scale), ..BoneKeys::default() },
                BoneKeys::default(),
            ];
            let clip = Clip::new("test", &skeleton, &bones, 0.0).expect("valid");
            let found = Priorities::new(&skeleton, &clip, Wrap::Clamp, &Weights::default(), &[0.5; 4])
                .expect("valid");
            found.keys.iter().step_by(2).map(|key| [key.terms[0], key.terms[2]]).collect::<Vec<_>>()
        };
        for scale in [1.0, 0.01, 100.0, 1.0 / 64.0] {
            let terms = found(scale, 1.0);
            for (terms, wanted) in terms.iter().zip([0.5, 1.0, 0.25]) {
                assert!((terms[0] - wanted).abs() < 1e-6 && terms[1] == 0.0, "{terms:?} at {scale}");
            }
            assert!(found(scale, 4e-7).iter().all(|terms| *terms == [0.0; 2]), "at {scale}");
        }
    }

    #[test]
    fn one_bone_has_no_children_and_depth_one() {
        let bone = Bone { name: String::new(), parent: None, rest: Transform::IDENTITY };
        let skeleton = Skeleton::of_joints(vec![bone]).expect("valid");
        let moves = keys(&[0.0, 1.0], &[[0.0; 4], [1.0, 0.0, 0.0, 0.0]]);
        let bones = [BoneKeys { translation: moves, ..BoneKeys::default() }];
        let clip = Clip::new("test", &skeleton, &bones, 0.0).expect("valid");
        let found =
            Priorities::new(&skeleton, &clip, Wrap::Loop, &Weights::default(), &[0.5]).expect("valid");
        assert_eq!(found.keys[0].terms, [1.0, 0.0, 0.0, 0.0, 1.0, 0.5]);
    }

    #[test]
    fn bad_weights_and_user_values_are_refused() {
        let refused = |weights: [f64; 6], user: &[f32]| {
            Priorities::new(&skeleton(), &clip(), Wrap::Loop, &Weights(weights), user)
                .expect_err("refused")
                .path
        };
        let good = Weights::default().0;
        assert_eq!(refused([0.5; 6], &[0.5; 4]), "weights");
        assert_eq!(refused([-1.0, 2.0, 0.0, 0.0, 0.0, 0.0], &[0.5; 4]), "weights.translation");
        assert_eq!(refused([f64::NAN, 1.0, 0.0, 0.0, 0.0, 0.0], &[0.5; 4]), "weights.translation");
        assert_eq!(refused(good, &[0.5; 3]), "user.len");
        assert_eq!(refused(good, &[0.5, 0.5, 1.5, 0.5]), "user[2]");
    }
}
