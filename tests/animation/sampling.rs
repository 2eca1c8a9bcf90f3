//! The sampling reference against glTF's own formulas in double precision.

use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::keyframe::KeyframeCursor;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::keyframe::keyframe_cursor;
use relievo::asset::{Bone, Skeleton, Transform};
use relievo::ops::animation::ClipSet;
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::keyframe_cursor::reference::{cursors, inside_clip};
use relievo::ops::animation::sample::SLERP_BOUND;
use relievo::ops::animation::sample::reference::{sample, sample_bone, sample_set_into, slerp};
use relievo::ops::hash::{LANES, threefry2x32};

use crate::player::{self, wide};

pub fn skeleton(bones: usize) -> Skeleton {
    let bone = |index: usize| Bone {
        name: format!("bone {index}"),
        parent: index.checked_sub(1).map(|parent| parent as u32 / 2),
        rest: Transform { translation: [index as f32, 0.5, -1.0], ..Transform::IDENTITY },
    };
    Skeleton::of_joints((0..bones).map(bone).collect()).expect("valid")
}

/// Random numbers in −1..1, the same everywhere.
pub fn noise(case: u32, count: usize) -> Vec<f32> {
    let word = |index: usize| threefry2x32([case, 77], [index as u32; LANES], [0; LANES]).0[0];
    (0..count).map(|index| word(index) as f32 / u32::MAX as f32 * 2.0 - 1.0).collect()
}

fn one_track(rotation: bool, keys: Keys) -> Clip {
    let keys = Some(keys);
    let bone = match rotation {
        true => BoneKeys { rotation: keys, ..BoneKeys::default() },
        false => BoneKeys { translation: keys, ..BoneKeys::default() },
    };
    Clip::new("test", &skeleton(1), &[bone], 0.0).expect("valid")
}

fn rotation_of(clip: &Clip, time: f32) -> [f64; 4] {
    wide(sample_bone(clip, 0, time, RotationPath::Slerp).rotation)
}

#[test]
fn slerp_is_within_its_bound_of_acos_and_sin() {
    let words = noise(1, 8 * 20_000);
    let mut worst = (0.0_f64, 0.0_f64);
    for (case, chunk) in words.chunks_exact(8).enumerate() {
        let a: [f32; 4] = std::array::from_fn(|i| chunk[i]);
        // The second rotation lies ever further from the first, from identical to opposite.
        let far = (case % 40) as f32 / 39.0;
        let b: [f32; 4] = std::array::from_fn(|i| (1.0 - far) * chunk[i] + far * chunk[4 + i]);
        if a.map(f32::abs).iter().sum::<f32>() < 0.1 || b.map(f32::abs).iter().sum::<f32>() < 0.1 {
            continue;
        }
        let keys = Keys { times: vec![0.0, 1.0], values: vec![a, b], interpolation: Interpolation::Linear };
        let clip = one_track(true, keys);
        for t in [0.0, 0.1, 0.25, 0.4999999, 0.5, 0.77, 0.9999] {
            let found = rotation_of(&clip, t);
            let expected = player::slerp(wide(a), wide(b), f64::from(t));
            worst.0 = worst.0.max(player::angle(found, expected));
            worst.1 = worst.1.max((player::dot(found, found).sqrt() - 1.0).abs());
        }
    }
    println!("slerp: {:e} rad, length {:e}", worst.0, worst.1);
    assert!(worst.0 <= f64::from(SLERP_BOUND) && worst.1 <= 1e-6, "{worst:?}");
}

#[test]
fn the_ends_of_a_slerp_are_its_keys() {
    let (a, b) = ([0.6, 0.0, 0.0, 0.8], [0.0, 0.8, 0.0, 0.6]);
    assert_eq!(slerp(a, b, 0.0), a);
    assert_eq!(slerp(a, b, 1.0), b);
}

#[test]
fn opposite_quaternions_are_the_same_rotation() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let (a, b) = ([0.0, 0.0, 0.0, 1.0], [half, 0.0, 0.0, half]);
    let minus = |q: [f32; 4]| q.map(|component| -component);
    let times = vec![0.0, 1.0, 2.0];
    let clip = |values: Vec<[f32; 4]>| {
        one_track(true, Keys { times: times.clone(), values, interpolation: Interpolation::Linear })
    };
    let straight = clip(vec![a, b, a]);
    for other in [clip(vec![a, minus(b), a]), clip(vec![minus(a), b, minus(a)]), clip(vec![a, b, minus(a)])] {
        for time in [0.0, 0.3, 0.5, 1.0, 1.7, 2.0] {
            assert!(player::angle(rotation_of(&straight, time), rotation_of(&other, time)) < 1e-6);
        }
    }
    // Between q and −q there is no rotation.
    let still = clip(vec![b, minus(b), b]);
    assert!(player::angle(rotation_of(&still, 0.5), wide(b)) < 1e-6);
}

#[test]
fn half_a_turn_goes_one_way_or_the_other_at_constant_speed() {
    let keys = Keys {
        times: vec![0.0, 1.0],
        values: vec![[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0]],
        interpolation: Interpolation::Linear,
    };
    let clip = one_track(true, keys);
    let start = rotation_of(&clip, 0.0);
    for t in [0.1, 0.5, 0.9] {
        let angle = player::angle(start, rotation_of(&clip, t));
        assert!((angle - f64::from(t) * std::f64::consts::PI).abs() < 1e-6, "{angle}");
    }
}

#[test]
fn nlerp_ends_where_slerp_does_and_strays_between() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let values = vec![[0.0, 0.0, 0.0, 1.0], [half, 0.0, 0.0, half]];
    let clip = one_track(true, Keys { times: vec![0.0, 1.0], values, interpolation: Interpolation::Linear });
    let between = |time| {
        let nlerp = wide(sample_bone(&clip, 0, time, RotationPath::Nlerp).rotation);
        player::angle(nlerp, rotation_of(&clip, time))
    };
    assert!(between(0.0) < 1e-6 && between(1.0) < 1e-6 && between(0.5) < 1e-6);
    assert!((1e-3..0.1).contains(&between(0.25)), "{}", between(0.25));
}

#[test]
fn lines_and_steps() {
    let keys = |interpolation| Keys {
        times: vec![1.0, 2.0, 4.0],
        values: vec![[0.0; 4], [10.0, -10.0, 1.0, 0.0], [20.0, 0.0, 1.0, 0.0]],
        interpolation,
    };
    let at = |interpolation, time| {
        sample_bone(&one_track(false, keys(interpolation)), 0, time, RotationPath::Slerp).translation
    };
    for (time, line, step) in [
        (0.0, [0.0; 3], [0.0; 3]),
        (1.0, [0.0; 3], [0.0; 3]),
        (1.5, [5.0, -5.0, 0.5], [0.0; 3]),
        (2.0, [10.0, -10.0, 1.0], [10.0, -10.0, 1.0]),
        (3.0, [15.0, -5.0, 1.0], [10.0, -10.0, 1.0]),
        (4.0, [20.0, 0.0, 1.0], [20.0, 0.0, 1.0]),
        (9.0, [20.0, 0.0, 1.0], [20.0, 0.0, 1.0]),
    ] {
        assert_eq!((at(Interpolation::Linear, time), at(Interpolation::Step, time)), (line, step), "{time}");
    }
}

/// glTF 2.0, appendix C.5, term by term.
fn spline(values: &[[f32; 4]], key: usize, seconds: f64, t: f64) -> [f64; 4] {
    let value = |at: usize, i: usize| f64::from(values[3 * key + at][i]);
    std::array::from_fn(|i| {
        (2.0 * t.powi(3) - 3.0 * t * t + 1.0) * value(1, i)
            + seconds * (t.powi(3) - 2.0 * t * t + t) * value(2, i)
            + (-2.0 * t.powi(3) + 3.0 * t * t) * value(4, i)
            + seconds * (t.powi(3) - t * t) * value(3, i)
    })
}

#[test]
fn splines_are_gltfs() {
    for case in 0..200 {
        let words = noise(100 + case, 24);
        let values: Vec<[f32; 4]> = (0..6).map(|v| std::array::from_fn(|i| words[4 * v + i])).collect();
        let is_rotation = case % 2 == 0;
        let interpolation = Interpolation::CubicSpline;
        let clip =
            one_track(is_rotation, Keys { times: vec![0.5, 2.5], values: values.clone(), interpolation });
        for time in [0.75_f32, 1.5, 2.25] {
            let expected = spline(&values, 0, 2.0, f64::from(time - 0.5) / 2.0);
            let found = sample_bone(&clip, 0, time, RotationPath::Slerp);
            if is_rotation {
                // Close to zero the direction is ill-conditioned.
                let length = player::dot(expected, expected).sqrt();
                assert!(player::angle(wide(found.rotation), expected) * length < 4e-6, "{case} {time}");
            } else {
                let error = (0..3).map(|i| (f64::from(found.translation[i]) - expected[i]).abs());
                assert!(error.fold(0.0, f64::max) < 2e-6, "{case} {time}");
            }
        }
        let first = sample_bone(&clip, 0, 0.0, RotationPath::Slerp);
        if is_rotation {
            assert!(player::angle(wide(first.rotation), wide(values[1])) < 1e-6);
        } else {
            assert_eq!(first.translation[..], values[1][..3]);
        }
    }
}

#[test]
fn a_spline_through_zero_keeps_the_key_before() {
    let (q, zero) = ([0.0, 0.0, 0.0, 1.0], [0.0; 4]);
    let values = vec![zero, q, zero, zero, q.map(|component| -component), zero];
    let keys = Keys { times: vec![0.0, 1.0], values, interpolation: Interpolation::CubicSpline };
    assert_eq!(sample_bone(&one_track(true, keys), 0, 0.5, RotationPath::Slerp).rotation, q);
}

#[test]
fn one_key_zero_length_and_repeated_times() {
    let linear = |times: &[f32], values: &[f32]| {
        let values = values.iter().map(|x| [*x, 0.0, 0.0, 0.0]).collect();
        one_track(false, Keys { times: times.to_vec(), values, interpolation: Interpolation::Linear })
    };
    let x = |clip: &Clip, time| sample_bone(clip, 0, time, RotationPath::Slerp).translation[0];
    let one = linear(&[3.0], &[7.0]);
    assert_eq!([0.0, 3.0, 9.0].map(|time| x(&one, time)), [7.0; 3]);
    let none = linear(&[0.0, 0.0], &[1.0, 2.0]);
    assert_eq!((none.duration(), x(&none, 0.0)), (0.0, 2.0));
    assert_eq!(inside_clip(Wrap::Loop, none.duration(), 5.0), 0.0);
    // At a jump the last of several equal times counts, at the ends too.
    let jump = linear(&[1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0], &[0.0, 1.0, 2.0, 9.0, 4.0, 6.0, 8.0]);
    for (time, expected) in
        [(0.5, 0.0), (1.0, 1.0), (1.5, 1.5), (2.0, 4.0), (2.5, 5.0), (3.0, 8.0), (4.0, 8.0)]
    {
        assert_eq!(x(&jump, time), expected, "{time}");
    }
}

#[test]
fn a_bone_without_tracks_rests() {
    for bones in [1, 2, 1000] {
        let skeleton = skeleton(bones);
        let clip = Clip::new("none", &skeleton, &vec![BoneKeys::default(); bones], 1.0).expect("valid");
        assert_eq!(sample(&clip, 0.5, RotationPath::Slerp), skeleton.rest());
    }
}

/// Whatever the spacing, the cursor equals the one that a linear search finds.
#[test]
fn keys_are_found_wherever_they_lie() {
    for case in 0..60 {
        let count = 1 + case as usize % 30;
        let bend = [1.0, 0.2, 6.0][case as usize % 3];
        let mut times: Vec<f32> = noise(500 + case, count).iter().map(|x| (x + 1.0).powf(bend)).collect();
        if case % 4 == 0 {
            times.iter_mut().for_each(|time| *time = (*time * 4.0).round() / 4.0);
        }
        times.sort_by(f32::total_cmp);
        let between = noise(900 + case, 50)
            .iter()
            .map(|x| (x + 1.0) * 1.1 * times[count - 1].max(0.1))
            .collect::<Vec<_>>();
        for time in times.iter().copied().chain(between) {
            let found = keyframe_cursor(&times, time);
            let key = times.iter().rposition(|key| *key <= time);
            let expected = key.unwrap_or(0);
            assert_eq!(found.key as usize, expected, "{times:?} at {time}");
            let inside = key.is_some() && expected + 1 < count;
            let width = if inside { times[expected + 1] - times[expected] } else { 0.0 };
            let fraction = if inside { (time - times[expected]) / width } else { 0.0 };
            assert_eq!(found, KeyframeCursor { key: expected as u32, fraction });
        }
    }
}

#[test]
fn times_wrap_in_float_as_in_double() {
    for (duration, time) in
        [(1.0, 0.0), (1.0, 1.0), (1.25, 7.3), (0.7, -0.1), (0.7, -0.7), (2.0, 1e4), (0.1, 99.99)]
    {
        for wrap in [Wrap::Loop, Wrap::Clamp] {
            let found = f64::from(inside_clip(wrap, duration, time));
            let expected = f64::from(wrap.inside(duration, f64::from(time)).expect("finite"));
            let distance = (found - expected).abs();
            let around = distance.min((f64::from(duration) - distance).abs());
            assert!(
                around < 1e-6 * f64::from(time.abs().max(1.0)),
                "{wrap:?} {duration} {time}: {found} {expected}"
            );
            assert!((0.0..=f64::from(duration)).contains(&found));
        }
    }
}

/// A clip of linear, step and spline tracks, with and without keys, each on one of two timelines.
fn mixed(bones: usize) -> Clip {
    let keys = |case: usize, is_rotation: bool| {
        let interpolation =
            [Interpolation::Linear, Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline]
                [case % 4];
        let times = if case.is_multiple_of(3) { vec![0.0, 0.25, 1.0] } else { vec![0.0, 0.5, 0.75, 2.0] };
        let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let words = noise(case as u32, 4 * each * times.len());
        let w = if is_rotation { 1.5 } else { 0.0 };
        let values = words.chunks_exact(4).map(|x| [x[0], x[1], x[2], (x[3] + 1.0) * w]).collect();
        (!case.is_multiple_of(7)).then_some(Keys { times, values, interpolation })
    };
    let bone = |bone| BoneKeys {
        translation: keys(3 * bone, false),
        rotation: keys(3 * bone + 1, true),
        scale: keys(3 * bone + 2, false),
    };
    Clip::new("mixed", &skeleton(bones), &(0..bones).map(bone).collect::<Vec<_>>(), 0.0).expect("valid")
}

#[test]
fn crowds_are_sampled_as_bones_are_one_by_one() {
    for bones in [1, 7, 8, 9, 153] {
        let clip = mixed(bones);
        let set = ClipSet::new(&[&clip]).expect("one skeleton");
        let starts = [0.0, 0.1, 0.25, 0.6, 0.75, 1.3, 1.9, 2.0];
        let instances = starts.map(|start| Instance::new(0, Wrap::Clamp, start, 1.0));
        let cursors = cursors(&set, &instances, 0.0);
        for path in [RotationPath::Slerp, RotationPath::Nlerp] {
            // Previous contents are overwritten.
            let mut transforms = vec![Transform { rotation: [9.0; 4], ..Transform::IDENTITY }; 8 * bones];
            sample_set_into(&set, &instances, &cursors, path, &mut transforms);
            let expected: Vec<_> = starts.iter().flat_map(|time| sample(&clip, *time, path)).collect();
            assert_eq!(transforms, expected, "{bones} bones, {path:?}");
        }
    }
}
