//! Root motion against the poses that it was taken from.

use glam::{DAffine3, DQuat, DVec3};
use relievo::InputError;
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::keyframe::RotationPath;
use relievo::asset::{Bone, Skeleton, Transform};
use relievo::ops::animation::RootMotion;
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::root_motion::{Taken, YAW_BOUND, deltas};
use relievo::ops::animation::sample::reference::{sample, sample_bone};
use relievo_samples::creature;

use crate::sampling::noise;

const YAW: Taken = Taken { horizontal: true, vertical: false, yaw: true };

fn wide(transform: &Transform) -> DAffine3 {
    let [scale, translation] =
        [transform.scale, transform.translation].map(|v| DVec3::from(v.map(f64::from)));
    let rotation = DQuat::from_array(transform.rotation.map(f64::from)).normalize();
    DAffine3::from_scale_rotation_translation(scale, rotation, translation)
}

/// An armature, turned and scaled as exporters do, a root, and a bone below it.
fn skeleton() -> Skeleton {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let armature = Transform { rotation: [-half, 0.0, 0.0, half], scale: [0.01; 3], ..Transform::IDENTITY };
    let bone = |parent, rest| Bone { name: format!("{parent:?}"), parent, rest };
    let bones = vec![
        bone(None, Transform { translation: [0.5, 0.0, -1.0], ..armature }),
        bone(Some(0), Transform::from_translation([3.0, 2.0, 100.0])),
        bone(Some(1), Transform::from_translation([0.0, 30.0, 0.0])),
    ];
    Skeleton::of_joints(bones).expect("valid")
}

fn keys(times: &[f32], values: Vec<[f32; 4]>, interpolation: Interpolation) -> Option<Keys> {
    Some(Keys { times: times.to_vec(), values, interpolation })
}

/// A root that moves and rotates in every way, in the armature's centimetres, and optionally tilts; it jumps at
/// 1.5 s.
fn astray(case: u32, interpolation: Interpolation, tilt: f32) -> Clip {
    let times = [0.25, 0.5, 1.0, 1.5, 1.5, 1.75];
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let words = noise(case, 8 * each * times.len());
    let at = |index: usize| &words[8 * index..][..8];
    let translations =
        (0..each * times.len()).map(|i| [at(i)[0] * 100.0, at(i)[1] * 100.0, at(i)[2] * 9.0, 0.0]);
    // The armature's z points up.
    let rotations = (0..each * times.len()).map(|i| [tilt * at(i)[4], tilt * at(i)[5], at(i)[6], 1.1]);
    let root = BoneKeys {
        translation: keys(&times, translations.collect(), interpolation),
        rotation: keys(&times, rotations.collect(), interpolation),
        scale: keys(&[0.0], vec![[1.0, 2.0, 1.0, 0.0]; 1], Interpolation::Linear),
    };
    let child =
        BoneKeys { translation: keys(&[0.5], vec![[1.0; 4]; 1], Interpolation::Step), ..BoneKeys::default() };
    Clip::new("astray", &skeleton(), &[BoneKeys::default(), root, child], 2.0).expect("valid")
}

fn delta(motion: &RootMotion, wrap: Wrap, from: f64, to: f64) -> DAffine3 {
    wide(&motion.delta(&Instance::new(0, wrap, 0.0, 1.0), from, to).expect("finite"))
}

/// How far a point two metres from the root is from its position.
fn distance(a: &DAffine3, b: &DAffine3) -> f64 {
    let points = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0, DVec3::Z * 2.0];
    points.iter().map(|p| a.transform_point3(*p).distance(b.transform_point3(*p))).fold(0.0, f64::max)
}

/// Checks that root motion times the pose in place equals the pose.
fn check(skeleton: &Skeleton, clip: &Clip, taken: Taken, bound: f64) {
    let (in_place, motion) = RootMotion::extract(skeleton, clip, 1, taken).expect("extracted");
    let above = wide(&sample_bone(clip, 0, 0.0, RotationPath::Slerp));
    let mut worst = 0.0_f64;
    for step in 0..=400 {
        let time = step as f32 / 200.0;
        let [pose, placed] = [clip, &in_place].map(|clip| sample(clip, time, RotationPath::Slerp));
        assert_eq!((pose[0], pose[2], pose[1].scale), (placed[0], placed[2], placed[1].scale));
        let moved = delta(&motion, Wrap::Clamp, 0.0, time.into()) * above * wide(&placed[1]);
        // The armature's points are in centimetres; this converts to metres.
        let metres = DAffine3::from_scale(DVec3::splat(100.0));
        worst = worst.max(distance(&(moved * metres), &(above * wide(&pose[1]) * metres)));
    }
    assert!(worst <= bound, "{taken:?}: {worst:e} m");
}

#[test]
fn motion_and_what_stays_in_place_make_the_clip() {
    let rounding = 4e-6;
    for interpolation in [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline] {
        for case in 0..20 {
            let (tilted, upright) =
                (astray(600 + case, interpolation, 0.5), astray(600 + case, interpolation, 0.0));
            for vertical in [false, true] {
                for horizontal in [!vertical, true] {
                    check(&skeleton(), &tilted, Taken { horizontal, vertical, yaw: false }, rounding);
                }
                let taken = Taken { vertical, ..YAW };
                // Points lie two metres from the root.
                let cut = 2.0 * YAW_BOUND + rounding;
                let is_spline = interpolation == Interpolation::CubicSpline;
                check(&skeleton(), &upright, taken, if is_spline { cut } else { rounding });
                let is_step = interpolation == Interpolation::Step;
                check(&skeleton(), &tilted, taken, if is_step { rounding } else { cut });
            }
        }
    }
}

#[test]
fn in_place_means_in_place() {
    let clip = astray(700, Interpolation::Linear, 0.4);
    let (in_place, _) = RootMotion::extract(&skeleton(), &clip, 1, YAW).expect("extracted");
    let at = |time| sample_bone(&in_place, 1, time, RotationPath::Slerp);
    let (start, moves) = (at(0.0), |time| sample_bone(&clip, 1, time, RotationPath::Slerp).translation);
    for time in [0.4, 0.9, 1.3, 1.6, 2.0] {
        // The armature's x and y are the model's horizontal.
        assert!((0..2).all(|i| (at(time).translation[i] - start.translation[i]).abs() < 1e-4), "{time}");
        assert_eq!(at(time).translation[2], moves(time)[2]);
    }
}

/// A root that moves two metres a second along z, with a hop, for one second.
fn straight() -> (Skeleton, Clip) {
    let bone = Bone { name: "root".to_owned(), parent: None, rest: Transform::IDENTITY };
    let skeleton = Skeleton::of_joints(vec![bone]).expect("valid");
    let values = vec![[0.0, 1.0, 0.0, 0.0], [0.0, 1.5, 1.0, 0.0], [0.0, 1.0, 2.0, 0.0]];
    let translation = keys(&[0.0, 0.5, 1.0], values, Interpolation::Linear);
    let clip = Clip::new("walk", &skeleton, &[BoneKeys { translation, ..BoneKeys::default() }], 0.0);
    (skeleton, clip.expect("valid"))
}

#[test]
fn loops_clamps_and_reverse_play() {
    let (skeleton, clip) = straight();
    let (in_place, motion) = RootMotion::extract(&skeleton, &clip, 0, Taken::default()).expect("extracted");
    assert_eq!(sample_bone(&in_place, 0, 0.5, RotationPath::Slerp).translation, [0.0, 1.5, 0.0]);
    let moved = |wrap, start, rate, from, to| {
        let delta = motion.delta(&Instance::new(0, wrap, start, rate), from, to).expect("finite");
        assert_eq!(
            (delta.rotation, delta.scale, delta.translation[0]),
            ([0.0, 0.0, 0.0, 1.0], [1.0; 3], 0.0)
        );
        assert_eq!(delta.translation[1], 0.0);
        delta.translation[2]
    };
    for (start, rate, from, to, looped, clamped) in [
        (0.0, 1.0, 0.0, 0.25, 0.5, 0.5),
        (0.0, 1.0, 0.75, 1.25, 1.0, 0.5),
        (0.5, 1.0, 0.0, 2.75, 5.5, 1.0),
        (0.0, 2.0, 0.25, 1000.25, 4000.0, 1.0),
        (0.0, -1.0, 0.0, 0.25, -0.5, 0.0),
        (0.75, -0.5, 0.0, 4.0, -4.0, -1.5),
        (0.0, 1.0, 3.25, 0.5, -5.5, -1.0),
        (0.0, 0.0, 0.0, 9.0, 0.0, 0.0),
        (-3.5, 1.0, 0.0, 4.0, 8.0, 1.0),
    ] {
        assert_eq!(moved(Wrap::Loop, start, rate, from, to), looped, "{start} {rate} {from} {to}");
        assert_eq!(moved(Wrap::Clamp, start, rate, from, to), clamped, "{start} {rate} {from} {to}");
    }
    // After eleven days, a frame still moves by the length of a frame.
    assert!((moved(Wrap::Loop, 0.0, 1.0, 1e6, 1e6 + 1.0 / 64.0) - 1.0 / 32.0).abs() < 1e-6);
}

/// Deltas join without a gap wherever loops end, and their sum leads back to the start.
#[test]
fn deltas_add_up() {
    for (case, interpolation) in [Interpolation::Linear, Interpolation::CubicSpline].into_iter().enumerate() {
        let clip = astray(800 + case as u32, interpolation, 0.3);
        let (_, motion) = RootMotion::extract(&skeleton(), &clip, 1, YAW).expect("extracted");
        let times: Vec<f64> = noise(810, 60).iter().map(|x| f64::from(*x) * 9.0).collect();
        for wrap in [Wrap::Loop, Wrap::Clamp] {
            for t in times.windows(3) {
                let (first, second, whole) = (
                    delta(&motion, wrap, t[0], t[1]),
                    delta(&motion, wrap, t[1], t[2]),
                    delta(&motion, wrap, t[0], t[2]),
                );
                assert!(distance(&(first * second), &whole) < 2e-5, "{wrap:?} {t:?}");
                let back = delta(&motion, wrap, t[1], t[0]);
                assert!(distance(&(first * back), &DAffine3::IDENTITY) < 2e-5, "{wrap:?} {t:?}");
            }
        }
        // Several loops in one step equal the same loops one by one.
        let one = delta(&motion, Wrap::Loop, 0.7, 2.7);
        assert!(distance(&(one * one * one), &delta(&motion, Wrap::Loop, 0.7, 6.7)) < 2e-5);
        assert!(distance(&(one * one).inverse(), &delta(&motion, Wrap::Loop, 4.7, 0.7)) < 2e-5);
    }
}

/// A quarter turn to the left and a metre ahead per loop leads back after four loops.
#[test]
fn four_left_turns_lead_back() {
    let (skeleton, _) = straight();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let root = BoneKeys {
        translation: keys(
            &[0.0, 1.0],
            vec![[5.0, 1.0, 0.0, 0.0], [5.0, 1.0, 1.0, 0.0]],
            Interpolation::Linear,
        ),
        // The same rotation, with the quaternions' sign reversed.
        rotation: keys(
            &[0.0, 1.0],
            vec![[0.0, 0.0, 0.0, 1.0], [0.0, -half, 0.0, -half]],
            Interpolation::Linear,
        ),
        ..BoneKeys::default()
    };
    let clip = Clip::new("left", &skeleton, &[root], 0.0).expect("valid");
    let (in_place, motion) = RootMotion::extract(&skeleton, &clip, 0, YAW).expect("extracted");
    for time in [0.0, 0.3, 1.0] {
        let root = sample_bone(&in_place, 0, time, RotationPath::Slerp);
        assert!(
            distance(&wide(&root), &wide(&Transform::from_translation([5.0, 1.0, 0.0]))) < 1e-6,
            "{root:?}"
        );
    }
    let root = DVec3::new(5.0, 1.0, 0.0);
    for (loops, expected) in
        [(1, [5.0, 1.0, 1.0]), (2, [6.0, 1.0, 1.0]), (3, [6.0, 1.0, 0.0]), (4, [5.0, 1.0, 0.0])]
    {
        let moved = delta(&motion, Wrap::Loop, 0.0, f64::from(loops)).transform_point3(root);
        assert!(moved.distance(DVec3::from(expected)) < 1e-5, "{loops}: {moved}");
    }
    assert!(distance(&delta(&motion, Wrap::Loop, 0.0, 4e6), &DAffine3::IDENTITY) < 1e-2);
}

#[test]
fn what_has_no_motion_stays() {
    let model = creature().expect("valid");
    for clip in &model.clips {
        let (in_place, motion) = RootMotion::extract(&model.skeleton, clip, 0, YAW).expect("extracted");
        let wrap = delta(&motion, Wrap::Loop, 0.1, 0.1 + 3.0 * f64::from(clip.duration()));
        // The creature walks on the spot.
        assert!(distance(&wrap, &DAffine3::IDENTITY) < 1e-5, "{}", clip.name());
        assert_eq!((in_place.name(), in_place.duration()), (clip.name(), clip.duration()));
    }
    // Clips with one key, without keys, and without duration.
    let (skeleton, _) = straight();
    let one =
        BoneKeys { translation: keys(&[0.0], vec![[1.0; 4]], Interpolation::Linear), ..BoneKeys::default() };
    let two = keys(&[0.0, 0.0], vec![[1.0; 4], [2.0; 4]], Interpolation::Linear);
    for root in [one, BoneKeys::default(), BoneKeys { translation: two.clone(), rotation: two, scale: None }]
    {
        let clip = Clip::new("still", &skeleton, &[root], 0.0).expect("valid");
        let (in_place, motion) = RootMotion::extract(&skeleton, &clip, 0, YAW).expect("extracted");
        assert_eq!(delta(&motion, Wrap::Loop, 0.0, 5.0), DAffine3::IDENTITY);
        assert_eq!(sample(&in_place, 0.0, RotationPath::Slerp), sample(&clip, 0.0, RotationPath::Slerp));
    }
}

#[test]
fn crowds_move_as_their_instances_do() {
    let (skeleton, clip) = straight();
    let (_, motion) = RootMotion::extract(&skeleton, &clip, 0, Taken::default()).expect("extracted");
    let motions = [None, Some(motion)];
    let instances: Vec<_> = (0..20).map(|i| Instance::new(i % 2, Wrap::Loop, i as f32 / 7.0, 0.5)).collect();
    let mut found = vec![Transform::IDENTITY; 20];
    deltas(&motions, &instances, 1.0, 4.5, &mut found).expect("they fit");
    for (instance, found) in instances.iter().zip(&found) {
        let motion = motions[instance.clip as usize].as_ref();
        let own = motion.map(|motion| motion.delta(instance, 1.0, 4.5).expect("finite"));
        assert_eq!(*found, own.unwrap_or(Transform::IDENTITY));
    }
    let refused = |instances: &[Instance], to, room: usize| {
        deltas(&motions, instances, 0.0, to, &mut vec![Transform::IDENTITY; room]).expect_err("refused").path
    };
    assert_eq!(refused(&instances, 1.0, 19), "deltas.len");
    assert_eq!(refused(&instances, f64::NAN, 20), "to");
    assert_eq!(refused(&[Instance::new(2, Wrap::Loop, 0.0, 1.0)], 1.0, 1), "instance.clip");
    let instance = Instance::new(0, Wrap::Loop, f32::NAN, 1.0);
    let motion = motions[1].as_ref().expect("taken");
    assert_eq!(motion.delta(&instance, 0.0, 1.0).expect_err("refused").path, "instance.start");
}

#[test]
fn what_cannot_be_taken_is_refused() {
    let (skeleton, clip) = (skeleton(), astray(900, Interpolation::Linear, 0.2));
    let refused = |skeleton: &Skeleton, clip: &Clip, bone, taken| {
        RootMotion::extract(skeleton, clip, bone, taken).expect_err("refused").path
    };
    let nothing = Taken { horizontal: false, vertical: false, yaw: false };
    assert_eq!(refused(&skeleton, &clip, 1, nothing), "taken.horizontal");
    let tilted = Taken { horizontal: false, vertical: true, yaw: true };
    let error = RootMotion::extract(&skeleton, &clip, 1, tilted).expect_err("refused");
    let bound = "must be true unless taken.vertical is, and taken.yaw is not";
    assert_eq!(error, InputError::new("taken.horizontal", false, bound));
    assert_eq!(refused(&skeleton, &clip, 3, YAW), "bone");
    assert_eq!(refused(&straight().0, &clip, 0, YAW), "clip.bones");
    // The bone above the root moves.
    assert_eq!(refused(&skeleton, &clip, 2, YAW), "clip.bones[1]");
    // Scales above the root that are non-uniform, mirrored, or zero.
    let of_yaw = "must be even and not mirror, since a yaw is taken below it";
    for (scale, yaw, bound) in [
        ([1.0, 2.0, 1.0], true, Some(of_yaw)),
        ([1.0, 2.0, 1.0], false, None),
        ([-1.0, 1.0, 1.0], true, Some(of_yaw)),
        ([-1.0, 1.0, 1.0], false, None),
        ([1.0, 0.0, 1.0], false, Some("must not make the bones below it flat")),
    ] {
        let mut bones = skeleton.bones().to_vec();
        bones[0].rest.scale = scale;
        let skeleton = Skeleton::of_joints(bones).expect("valid");
        let root = BoneKeys {
            translation: keys(&[0.0, 1.0], vec![[0.0; 4], [1.0; 4]], Interpolation::Linear),
            ..BoneKeys::default()
        };
        let clip = Clip::new("scaled", &skeleton, &[BoneKeys::default(), root, BoneKeys::default()], 0.0);
        let found = RootMotion::extract(&skeleton, &clip.expect("valid"), 1, Taken { yaw, ..YAW });
        let expected = bound.map(|bound| InputError::new("clip.bones[0].scale", format!("{scale:?}"), bound));
        assert_eq!(found.err(), expected);
    }
    // Of several bones above, the one that mirrors is named, or else the one with the most uneven scale.
    for (scales, named) in [([[1.0, 9.0, 1.0], [1.0, 1.0, -1.0]], 1), ([[1.0, 2.0, 1.0], [1.0, 3.0, 1.0]], 1)]
    {
        let mut bones = skeleton.bones().to_vec();
        (bones[0].rest.scale, bones[1].rest.scale) = (scales[0], scales[1]);
        let skeleton = Skeleton::of_joints(bones).expect("valid");
        let clip = Clip::new("still", &skeleton, &vec![BoneKeys::default(); 3], 1.0).expect("valid");
        let expected =
            InputError::new(format!("clip.bones[{named}].scale"), format!("{:?}", scales[named]), of_yaw);
        assert_eq!(RootMotion::extract(&skeleton, &clip, 2, YAW).err(), Some(expected));
    }
}
