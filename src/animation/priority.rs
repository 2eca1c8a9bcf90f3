//! Priority of each key of each bone: how much the key contributes to the shape of the character (A section 12). Priorities are
//! computed once per clip, at load time.
//!
//! The keys of a bone are the distinct times of its translation, rotation and scale keys together. Each key has six terms from
//! 0 to 1:
//!
//! | term | value | divided by |
//! |---|---|---|
//! | translation | distance from this key to the next, times the largest scales above it at rest | the clip's largest |
//! | rotation | angle from this key to the next, in radians | the clip's largest |
//! | scale | length of the difference of both scales, divided by the bone's largest at rest | the clip's largest |
//! | children | number of descendants | the skeleton's largest |
//! | depth | D − d + 1 for a bone d steps from the root, where D is the depth of the deepest | D + 1 |
//! | user | given for each bone; ½ by default | 1 |
//!
//! A priority is the weighted mean of the terms.
//!
//! A term is 0 if its largest value is below [`NOISE`] (for translations, relative to the model's size), so that noise never
//! becomes important. If the clip loops, the last key is followed by the bone's first. Otherwise nothing follows it, and its
//! first three terms are 0.
//!
//! **Decided**: a key is compared with the next one, as in A's equations (12.2 to 12.4). A's prose compares it with the
//! previous one (10.6, 14). A bone that skips updates after a key misses the motion towards the next.
//!
//! **Decided**: the rotation term is the angle, as A's prose means it (11.2). A's equation (12.3) is the dot product of two
//! quaternions, which is *largest* when nothing rotates, and which distinguishes q from −q.
//!
//! **Decided**: the depth term is highest at the root, as in A's prose (10.5, 11.5). The equation of 12.7, d/D, grows away from
//! the root; that of 10.5, D/d, divides by 0 at the root.

mod analyze;
mod differences;

use crate::InputError;
use crate::animation::instance::Wrap;
use crate::asset::clip::Clip;
use crate::asset::skeleton::Skeleton;

use differences::{Difference, Differences};
pub use differences::{key_times, size};

/// Threshold below which a term's largest value counts as 0: in radians, factors of the scale at rest, and fractions of the
/// model's size.
pub const NOISE: f64 = 1e-6;

/// Default of a bone's user term.
pub const USER_DEFAULT: f32 = 0.5;

/// Names of the terms, in order.
pub const TERMS: [&str; 6] = ["translation", "rotation", "scale", "children", "depth", "user"];

/// Weights of the six terms; they sum to 1.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Weights(pub [f64; 6]);

impl Default for Weights {
    /// Equal weights, as in A.
    fn default() -> Self {
        Self([1.0 / 6.0; 6])
    }
}

impl Weights {
    /// Checks each weight and the sum.
    ///
    /// # Errors
    /// [`InputError`] for weights outside 0..=1, and for a sum that is more than 1e-4 from 1.
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
    /// Index of the bone.
    pub bone: u32,
    /// Index of the key among the bone's keys.
    pub key: u32,
    /// Time in seconds.
    pub time: f32,
    /// The terms in the order of [`TERMS`], each 0 to 1.
    pub terms: [f32; 6],
    /// The weighted mean of the terms.
    pub priority: f32,
}

/// Priorities of all keys of a clip: bone by bone, key by key.
#[derive(Debug, Clone, PartialEq)]
pub struct Priorities {
    /// All keys.
    pub keys: Vec<KeyPriority>,
    /// Start of each bone's keys in `keys`; one entry more than there are bones.
    pub offsets: Vec<u32>,
}

impl Priorities {
    /// Computes the priorities of the keys of a clip that plays with `wrap`. `user` has one value per bone, 0 to 1.
    ///
    /// # Errors
    /// [`InputError`] for invalid weights ([`Weights::validate`]), for a clip of another skeleton, and for user values that are
    /// not one per bone or that are outside 0..=1.
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

    /// The keys of a bone.
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

    /// root ─ arm ─ hand, and a leg below the root. Descendants: 3, 1, 0, 0. Steps from the root: 0, 1, 2, 1.
    fn skeleton() -> Skeleton {
        let rest = Transform::from_translation([0.0, 1.0, 0.0]);
        let bone = |parent| Bone { name: String::new(), parent, rest };
        Skeleton::of_joints([None, Some(0), Some(1), Some(0)].map(bone).to_vec()).expect("valid")
    }

    fn keys(times: &[f32], values: &[[f32; 4]]) -> Option<Keys> {
        let (times, values) = (times.to_vec(), values.to_vec());
        Some(Keys { times, values, interpolation: Interpolation::Linear })
    }

    /// The root moves 2 m, then 1 m; the arm turns by ¼, then ⅛ of a turn; the hand grows by 0.6 in a key of its own.
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
        // The largest values: 2 m, ¼ turn, 0.6; 3 descendants, depth 2.
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
        // The keys at 0, 1 and 2 together; the scale is halfway at 1.
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

    /// The root stands still, jumps, and stands still: the key before the jump counts, not the key after it.
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
        // From (2, 1) to 0: √5 m is now the largest translation, and ⅜ of a turn the largest rotation.
        let far = 5.0_f32.sqrt();
        assert!(
            (found.of(0)[0].terms[0] - 2.0 / far).abs() < 1e-6
                && (found.of(0)[2].terms[0] - 1.0).abs() < 1e-6
        );
        assert!(
            (found.of(1)[0].terms[1] - 2.0 / 3.0).abs() < 1e-6
                && (found.of(1)[2].terms[1] - 1.0).abs() < 1e-6
        );
        // 0.3 + 0.3 forward, 0.6 back.
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
        // The skeleton is 2 m tall: 1e-6 m is less than 1e-6 of it.
        let found =
            Priorities::new(&skeleton(), &clip, Wrap::Loop, &Weights::default(), &[0.5; 4]).expect("valid");
        assert!((size(&skeleton()) - 2.0).abs() < 1e-6);
        assert!(found.keys.iter().all(|key| key.terms[..3] == [0.0; 3]));
    }

    /// Below a bone with another scale, translations count by their size in the model, and noise stays noise.
    #[test]
    fn units_do_not_matter() {
        // A model 2 m tall, and the same with bones scaled and animated in other units; the arm's scale is
        // twice the hand's.
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
            // The rounding of the scale, as large as noise can be.
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
