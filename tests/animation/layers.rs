//! Layers against their definition in double precision.

use relievo::asset::Transform;
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::keyframe::RotationPath;
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::keyframe_cursor::reference::cursors;
use relievo::ops::animation::layers::{all_instances, mask_below};
use relievo::ops::animation::sample::reference::{blend, sample, sample_layers};
use relievo::ops::animation::{AnimationLayer, ClipSet};
use relievo_samples::creature;

use crate::player::{angle, dot, unit, wide};
use crate::sampling::{noise, skeleton};

/// below + (over − below) · weight, part by part.
fn expected(below: &Transform, over: &Transform, weight: f64) -> ([f64; 3], [f64; 4], [f64; 3]) {
    let line = |a: [f32; 3], b: [f32; 3]| {
        std::array::from_fn(|i| f64::from(a[i]) + (f64::from(b[i]) - f64::from(a[i])) * weight)
    };
    let (a, b) = (wide(below.rotation), wide(over.rotation));
    let sign = if dot(a, b) < 0.0 { -1.0 } else { 1.0 };
    let rotation = unit(std::array::from_fn(|i| a[i] + (sign * b[i] - a[i]) * weight));
    (line(below.translation, over.translation), rotation, line(below.scale, over.scale))
}

fn random(words: &[f32]) -> Transform {
    let rotation = unit(wide([words[3], words[4], words[5], words[6]])).map(|x| x as f32);
    Transform { translation: [words[0], words[1], words[2]], rotation, scale: [words[7], words[8], words[9]] }
}

#[test]
fn blends_are_their_definition() {
    for (case, words) in noise(31, 21 * 2000).chunks_exact(21).enumerate() {
        let (below, over) = (random(&words[..10]), random(&words[10..]));
        let weight = [0.0, 1.0, (words[20] + 1.0) / 2.0][case % 3];
        let found = blend(&below, &over, weight);
        let (translation, rotation, scale) = expected(&below, &over, f64::from(weight));
        let error = |a: [f32; 3], b: [f64; 3]| {
            a.iter().zip(b).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max)
        };
        assert!(error(found.translation, translation) < 2e-7 && error(found.scale, scale) < 2e-7, "{case}");
        assert!(angle(wide(found.rotation), rotation) < 2e-6, "{case}");
        assert!((dot(wide(found.rotation), wide(found.rotation)).sqrt() - 1.0).abs() < 3e-7);
        if weight == 1.0 {
            assert_eq!((found.translation, found.scale), (over.translation, over.scale));
        }
    }
}

#[test]
fn opposite_quaternions_blend_to_the_same_rotation() {
    let below = random(&noise(32, 10));
    for rotation in [below.rotation, below.rotation.map(|x| -x)] {
        let found = blend(&below, &Transform { rotation, ..below }, 0.5);
        assert!(angle(wide(found.rotation), wide(below.rotation)) < 1e-6);
    }
}

/// A wave of one arm over a walk: the arm waves, the rest walks.
#[test]
fn masks_confine_a_layer() {
    let model = creature().expect("valid");
    let set = ClipSet::new(&model.clips.iter().collect::<Vec<_>>()).expect("one skeleton");
    let shoulder = model.skeleton.bones().iter().position(|bone| bone.name.contains("arm")).expect("an arm");
    let mask = mask_below(&model.skeleton, shoulder).expect("a bone");
    let (walk, wave) = (Instance::new(0, Wrap::Loop, 0.3, 1.0), Instance::new(2, Wrap::Loop, 0.7, 1.0));
    let layers = |weight| [AnimationLayer::new(vec![wave], vec![weight]).masked(mask.clone())];
    let pose = |weight| {
        let layers = layers(weight);
        let found = cursors(&set, &all_instances(&[walk], &layers), 0.0);
        sample_layers(&set, &[walk], &layers, &found, RotationPath::Slerp)
    };
    let (walking, waving) = (
        sample(&model.clips[0], 0.3, RotationPath::Slerp),
        sample(&model.clips[2], 0.7, RotationPath::Slerp),
    );
    assert_eq!(pose(0.0), walking);
    let (half, full) = (pose(0.5), pose(1.0));
    for bone in 0..model.skeleton.len() {
        if mask[bone] == 0.0 {
            assert_eq!((half[bone], full[bone]), (walking[bone], walking[bone]));
            continue;
        }
        assert_eq!(full[bone].translation, waving[bone].translation);
        assert!(angle(wide(full[bone].rotation), wide(waving[bone].rotation)) < 1e-6);
        let (_, rotation, _) = expected(&walking[bone], &waving[bone], 0.5);
        assert!(angle(wide(half[bone].rotation), rotation) < 1e-6);
    }
    assert!(angle(wide(full[shoulder].rotation), wide(walking[shoulder].rotation)) > 0.01, "nothing waves");
}

/// Three layers fold from the base upwards: the last one counts most.
#[test]
fn layers_fold_upwards() {
    let at = |x: f32| {
        let keys =
            Keys { times: vec![0.0], values: vec![[x, 0.0, 0.0, 0.0]], interpolation: Interpolation::Step };
        let bone = BoneKeys { translation: Some(keys), ..BoneKeys::default() };
        Clip::new("at", &skeleton(1), &[bone], 1.0).expect("valid")
    };
    let clips = [at(0.0), at(8.0), at(100.0)];
    let set = ClipSet::new(&clips.iter().collect::<Vec<_>>()).expect("one skeleton");
    let plays = |clip| Instance::new(clip, Wrap::Loop, 0.0, 1.0);
    let layers = [
        AnimationLayer::new(vec![plays(1)], vec![0.5]),
        AnimationLayer::new(vec![plays(2)], vec![0.25]).masked(vec![0.5]),
    ];
    let found = cursors(&set, &all_instances(&[plays(0)], &layers), 0.0);
    let pose = sample_layers(&set, &[plays(0)], &layers, &found, RotationPath::Slerp);
    // The sum grows from 0 to 4, and then to 4 + 96/8.
    assert_eq!(pose[0].translation, [16.0, 0.0, 0.0]);
}
