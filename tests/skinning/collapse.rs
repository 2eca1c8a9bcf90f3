//! Models with fewer bones: the places of their bones and vertices, compared with independent code in double
//! precision.

use std::collections::BTreeSet;

use glam::{DAffine3, DVec3};
use relievo::asset::clip::{Clip, Interpolation, TransformPart};
use relievo::asset::{Model, Transform};
use relievo::ops::skinning::collapse::{CollapseOptions, Collapsed, KeptBones, collapse_bones};

use crate::rigs::{Rig, at_rest, local, posed, skinned};
use crate::shapes;

/// The largest error of a bone between keys, as a fraction of the model's size.
const BETWEEN_KEYS: f64 = 1e-3;

/// Half of the diagonal of a box around the rigs is about this, in metres.
const SIZE: f64 = 1.1;

const RIGS: [Rig; 4] = [
    Rig::PLAIN,
    Rig { unit: 0.01, ..Rig::PLAIN },
    Rig { is_mirrored: true, ..Rig::PLAIN },
    Rig { unit: 0.01, is_mirrored: true, has_clips: true },
];

fn options(count: usize) -> CollapseOptions {
    CollapseOptions::new(KeptBones::Count(count))
}

fn collapsed(model: &Model, count: usize) -> Collapsed {
    let collapsed = collapse_bones(model, &options(count)).expect("valid");
    let reduced = &collapsed.model;
    assert_eq!(reduced.skins.iter().try_for_each(|skin| skin.validate(&reduced.skeleton)), Ok(()));
    assert_eq!(reduced.meshes.iter().try_for_each(|mesh| mesh.validate(&reduced.skins)), Ok(()));
    collapsed
}

/// Pairs of the index of a kept bone and the index that it became. Names do not change, and tell which is
/// which.
fn kept(model: &Model, collapsed: &Collapsed) -> Vec<(usize, usize)> {
    let names = |model: &Model| -> Vec<String> {
        model.skeleton.bones().iter().map(|bone| bone.name.clone()).collect()
    };
    let before = names(model);
    let place = |name: &String| before.iter().position(|other| other == name).expect("one of the model's");
    let pairs: Vec<_> =
        (names(&collapsed.model).iter().enumerate()).map(|(at, name)| (place(name), at)).collect();
    assert!(pairs.iter().all(|(old, new)| collapsed.remap[*old] as usize == *new));
    pairs
}

/// The bones from below the next kept bone above a kept one down to it.
fn chain(model: &Model, collapsed: &Collapsed, old: usize) -> Vec<usize> {
    let name = |model: &Model, bone: usize| model.skeleton.bones()[bone].name.clone();
    let into = |bone: usize| collapsed.remap[bone] as usize;
    let has_gone = |bone: &usize| name(model, *bone) != name(&collapsed.model, into(*bone));
    let parent = |bone: &usize| model.skeleton.bones()[*bone].parent.map(|parent| parent as usize);
    let mut chain: Vec<usize> =
        std::iter::successors(Some(old), |bone| parent(bone).filter(has_gone)).collect();
    chain.reverse();
    chain
}

fn apart(a: &DAffine3, b: &DAffine3, size: f64) -> f64 {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|point| size * point);
    points
        .map(|point| a.transform_point3(point).distance(b.transform_point3(point)))
        .into_iter()
        .fold(0.0, f64::max)
}

#[test]
fn kept_bones_are_where_they_were_at_key_times() {
    for rig in RIGS {
        let model = rig.model();
        let size = SIZE / f64::from(rig.unit);
        for count in [16, 12, 9] {
            let collapsed = collapsed(&model, count);
            let mut composed = 0;
            for (clip, reduced) in model.clips.iter().zip(&collapsed.model.clips) {
                assert_eq!((clip.name(), clip.duration()), (reduced.name(), reduced.duration()));
                for (old, new) in kept(&model, &collapsed) {
                    let chain = chain(&model, &collapsed, old);
                    let tracks =
                        chain.iter().flat_map(|bone| TransformPart::ALL.map(|part| clip.track(*bone, part)));
                    let times = tracks.flat_map(|track| clip.times_of(track));
                    composed += usize::from(chain.len() > 1);
                    for time in times.map(|time| f64::from(*time)) {
                        let locals = chain.iter().map(|bone| local(clip, *bone, time));
                        let before = locals.fold(DAffine3::IDENTITY, |above, local| above * local);
                        let off = apart(&before, &local(reduced, new, time), size);
                        assert!(off < 3e-6 * size, "{rig:?} {count}: {off} in {old} at {time}");
                    }
                }
            }
            assert!(composed > 0);
        }
    }
}

/// The swing's bones have keys at the same eighths, or at some of them: at the whole and half seconds all do.
#[test]
fn kept_bones_stay_on_their_paths() {
    for rig in RIGS {
        let model = rig.model();
        let collapsed = collapsed(&model, 10);
        let kept = kept(&model, &collapsed);
        let off = |time: f64| {
            let before = posed(&model.skeleton, &model.clips[0], time);
            let after = posed(&collapsed.model.skeleton, &collapsed.model.clips[0], time);
            let distance =
                |(old, new): &(usize, usize)| before[*old].translation.distance(after[*new].translation);
            kept.iter().map(distance).fold(0.0, f64::max)
        };
        for time in [0.0, 0.5, 1.0] {
            assert!(off(time) < 1e-5 * SIZE, "{rig:?}: {} at {time}", off(time));
        }
        let most = (0..=600).map(|at| off(f64::from(at) / 600.0)).fold(0.0, f64::max);
        // Each bone of a chain adds at most this error, and some chains hang on others.
        assert!((1e-5..4.0 * BETWEEN_KEYS * SIZE).contains(&most), "{rig:?}: {most}");
        assert!((0.5 * most..=1.01 * most).contains(&collapsed.error.kept_bones.into()), "{rig:?} {most}");
    }
}

/// 60 poses a second of every clip, in double precision.
fn measured(model: &Model, reduced: &Model) -> [f64; 2] {
    let (mut largest, mut squares, mut count) = (0.0_f64, 0.0, 0);
    for (clip, of_reduced) in model.clips.iter().zip(&reduced.clips) {
        let poses = (60.0 * clip.duration()).ceil() as usize;
        for pose in 0..=poses {
            let time = f64::from(clip.duration()) * pose as f64 / poses as f64;
            let before = skinned(model, &posed(&model.skeleton, clip, time));
            let after = skinned(reduced, &posed(&reduced.skeleton, of_reduced, time));
            for (before, after) in before.iter().zip(&after) {
                largest = largest.max(before.distance(*after));
                squares += before.distance_squared(*after);
                count += 1;
            }
        }
    }
    [largest, (squares / f64::from(count)).sqrt()]
}

#[test]
fn the_error_is_that_of_a_dense_look() {
    for rig in RIGS {
        let model = rig.model();
        let mut before = 0.0;
        for count in [17, 13, 10, 8] {
            let Collapsed { model: reduced, error, .. } = collapsed(&model, count);
            assert_eq!(reduced.skeleton.len(), count);
            let [largest, rms] = measured(&model, &reduced);
            // A pose may lie at a jump, which is the one side or the other of it.
            let is_near = |a: f32, b: f64| (f64::from(a) - b).abs() < 0.01 * b + 1e-5;
            assert!(is_near(error.largest, largest), "{rig:?} {count}: {error:?}, {largest}");
            assert!(is_near(error.rms, rms), "{rig:?} {count}: {error:?}, {rms}");
            assert!(error.rms >= before && error.rms <= error.largest, "{rig:?} {count}: {error:?}");
            before = error.rms;
        }
        assert!(before > 0.01, "{before}");
    }
}

#[test]
fn units_do_not_matter() {
    for is_mirrored in [false, true] {
        let [metres, hundredths] =
            [1.0, 0.01].map(|unit| collapsed(&Rig { unit, is_mirrored, has_clips: true }.model(), 11));
        assert_eq!(metres.remap, hundredths.remap);
        let [a, b] = [&metres, &hundredths].map(|collapsed| collapsed.error);
        for (a, b) in [(a.largest, b.largest), (a.rms, b.rms), (a.kept_bones, b.kept_bones)] {
            assert!((a - b).abs() < 1e-3 * a, "{a} {b}");
        }
    }
}

#[test]
fn the_same_model_gives_the_same_result() {
    let model = Rig::PLAIN.model();
    assert_eq!(collapsed(&model, 9), collapsed(&model, 9));
    let whole = collapsed(&model, model.skeleton.len());
    assert_eq!(whole.model, model);
    assert_eq!([whole.error.largest, whole.error.rms, whole.error.kept_bones], [0.0; 3]);
}

/// A skin that was bound at rest has one joint per kept bone, which gets every influence of what has
/// collapsed into it.
#[test]
fn influences_go_to_the_nearest_kept_bone_above() {
    for rig in RIGS {
        let model = rig.model();
        let collapsed = collapsed(&model, 9);
        for (skin, reduced) in model.skins.iter().zip(&collapsed.model.skins) {
            let followed: BTreeSet<u32> =
                skin.bones.iter().map(|bone| collapsed.remap[*bone as usize]).collect();
            let bones: BTreeSet<u32> = reduced.bones.iter().copied().collect();
            assert_eq!((&bones, reduced.bones.len()), (&followed, bones.len()));
        }
        for (mesh, reduced) in model.meshes.iter().zip(&collapsed.model.meshes) {
            let skin = &model.skins[mesh.skin].bones;
            let of_reduced = &collapsed.model.skins[mesh.skin].bones;
            for vertex in 0..mesh.vertices() {
                for bone in 0..collapsed.model.skeleton.len() as u32 {
                    let before = (mesh.influences.of(vertex).iter())
                        .filter(|one| collapsed.remap[skin[one.bone as usize] as usize] == bone)
                        .map(|one| one.weight);
                    let after = (reduced.influences.of(vertex).iter())
                        .filter(|one| of_reduced[one.bone as usize] == bone)
                        .map(|one| one.weight);
                    assert!((before.sum::<f32>() - after.sum::<f32>()).abs() < 1e-6);
                }
            }
        }
        // At rest no vertex moves.
        let [before, after] =
            [&model, &collapsed.model].map(|model| skinned(model, &at_rest(&model.skeleton)));
        let off = before.iter().zip(&after).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(off < 1e-5, "{off}");
    }
}

/// A joint whose bind pose differs from the rest pose stays a joint of its own, and its vertices stay in
/// place.
#[test]
fn joints_that_were_bound_elsewhere_stay_apart() {
    let mut model = Rig { has_clips: false, ..Rig::PLAIN }.model();
    let bone = model.skeleton.bones().iter().position(|bone| bone.name == "left lower").expect("there");
    let joint = model.skins[0].bones.iter().position(|other| *other as usize == bone).expect("a joint");
    model.skins[0].inverse_binds[joint][12] += 0.05;
    let collapsed = collapsed(&model, 5);
    let into = collapsed.remap[bone];
    let joints =
        |skin: usize| collapsed.model.skins[skin].bones.iter().filter(|other| **other == into).count();
    assert_eq!([joints(0), joints(1)], [2, 1]);
    let [before, after] = [&model, &collapsed.model].map(|model| skinned(model, &at_rest(&model.skeleton)));
    let off = before.iter().zip(&after).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(off < 1e-5, "{off}");
}

/// In the wave, only palms and fingers move: bones below bones that stand still keep their keys.
#[test]
fn below_bones_that_stand_still_keys_stay() {
    for rig in RIGS {
        let mut model = rig.model();
        model.clips.remove(0);
        let options = CollapseOptions { keep: vec!["left palm".into()], ..options(7) };
        let collapsed = collapse_bones(&model, &options).expect("valid");
        let palm = kept(&model, &collapsed).into_iter().find(|(old, _)| *old == 8).expect("named").1;
        let clip = &collapsed.model.clips[0];
        let track = clip.track(palm, TransformPart::Rotation);
        assert_eq!(track.interpolation, Interpolation::CubicSpline);
        assert_eq!(clip.times_of(track), [0.0, 0.2, 0.7]);
        for part in [TransformPart::Translation, TransformPart::Scale] {
            assert_eq!(clip.track(palm, part).keys, 0);
        }
        for time in (0..=70).map(|at| f64::from(at) / 100.0) {
            let before = posed(&model.skeleton, &model.clips[0], time)[8];
            let after = posed(&collapsed.model.skeleton, clip, time)[palm];
            let off = apart(&before, &after, SIZE / f64::from(rig.unit));
            assert!(off < 1e-5 * SIZE, "{rig:?}: {off} at {time}");
        }
    }
}

#[test]
fn models_without_clips_lose_what_reaches_least() {
    let model = Rig { has_clips: false, ..Rig::PLAIN }.model();
    let free = CollapseOptions { keep_end_effectors: false, ..options(1) };
    let all = collapse_bones(&model, &free).expect("valid");
    assert_eq!((all.model.skeleton.len(), all.model.clips.len()), (1, 0));
    assert!(all.error.largest < 1e-5, "{:?}", all.error);
    let half = CollapseOptions { bones: KeptBones::Fraction(0.5), ..free.clone() };
    assert_eq!(collapse_bones(&model, &half).expect("valid").model.skeleton.len(), 9);
    // The first bone to collapse is the one whose vertices lie nearest to it, by weight.
    let first = collapse_bones(&model, &CollapseOptions { bones: KeptBones::Count(17), ..free });
    let first = first.expect("valid");
    let rests = at_rest(&model.skeleton);
    let mut bone_radii = vec![0.0_f64; rests.len()];
    for mesh in &model.meshes {
        let skin = &model.skins[mesh.skin];
        for (vertex, position) in mesh.positions.iter().enumerate() {
            for one in mesh.influences.of(vertex) {
                let bind = skin.inverse_binds[one.bone as usize].map(f64::from);
                let bone = skin.bones[one.bone as usize] as usize;
                let place = glam::DMat4::from_cols_array(&bind)
                    .transform_point3(DVec3::from(position.map(f64::from)));
                bone_radii[bone] = bone_radii[bone].max(f64::from(one.weight) * place.length());
            }
        }
    }
    let least = (1..18).min_by(|a, b| bone_radii[*a].total_cmp(&bone_radii[*b])).expect("bones");
    assert!(kept(&model, &first).iter().all(|(old, _)| *old != least), "{least}");
}

#[test]
fn what_must_stay_stays() {
    let model = Rig::PLAIN.model();
    let names = |options: &CollapseOptions| -> Vec<String> {
        let reduced = collapse_bones(&model, options).expect("valid").model;
        reduced.skeleton.bones().iter().map(|bone| bone.name.clone()).collect()
    };
    let fewest = ["scene", "hips", "head", "left finger", "right finger", "foot"];
    assert_eq!(names(&options(6)), fewest);
    let keep = vec!["chest".to_owned(), "left palm".to_owned()];
    let more = names(&CollapseOptions { keep: keep.clone(), ..options(8) });
    assert_eq!(more.len(), fewest.len() + 2);
    assert!(keep.iter().all(|name| more.contains(name)));
    let free = CollapseOptions { keep_end_effectors: false, ..options(2) };
    assert_eq!(names(&free), ["scene", "hips"]);
}

/// A translation, rotation and scale cannot represent the shear of a bone that rotates below a non-uniform
/// scale.
#[test]
fn uneven_scales_stay_above_kept_bones() {
    let mut model = Rig { has_clips: false, ..Rig::PLAIN }.model();
    let mut bones = model.skeleton.bones().to_vec();
    bones[2].rest = Transform { scale: [1.0, 2.0, 1.0], ..bones[2].rest };
    let joints = model.skeleton.joints().to_vec();
    model.skeleton = relievo::asset::Skeleton::new(bones, joints).expect("valid");
    let has_spine = |options: &CollapseOptions| {
        let reduced = collapse_bones(&model, options).expect("valid").model;
        reduced.skeleton.bones().iter().any(|bone| bone.name == "spine")
    };
    assert!(has_spine(&options(5)));
    assert!(!has_spine(&CollapseOptions { keep_end_effectors: false, ..options(1) }));
}

#[test]
fn requests_are_checked() {
    let model = Rig::PLAIN.model();
    let refused = |options: CollapseOptions, model: &Model| {
        let error = collapse_bones(model, &options).expect_err("refused");
        assert!(!error.bound.is_empty());
        (error.path, error.value)
    };
    let of = |bones| refused(CollapseOptions::new(bones), &model);
    let text = |field: &str, value: &str| (field.to_owned(), value.to_owned());
    assert_eq!(of(KeptBones::Count(0)), text("bones", "0"));
    assert_eq!(of(KeptBones::Count(19)), text("bones", "19"));
    // The bones that must stay are the root, the hips, and four ends.
    assert_eq!(of(KeptBones::Count(5)), text("bones", "5"));
    assert_eq!(of(KeptBones::Fraction(0.0)), text("bones", "0"));
    assert_eq!(of(KeptBones::Fraction(1.5)), text("bones", "1.5"));
    assert_eq!(of(KeptBones::Fraction(f32::NAN)), text("bones", "NaN"));
    let keep = vec!["hips".to_owned(), "tail".to_owned()];
    assert_eq!(refused(CollapseOptions { keep, ..options(9) }, &model), text("keep[1]", "tail"));
    let mut wrong = model.clone();
    wrong.clips[1] = shapes::model().clips[0].clone();
    assert_eq!(refused(options(9), &wrong), text("clips[1].bones", "153"));
    let mut wrong = model.clone();
    wrong.skins[0].bones[0] = 99;
    assert_eq!(refused(options(9), &wrong), text("skins[0].bones[0]", "99"));
    let mut wrong = model.clone();
    wrong.clips[0] = Clip::new("", &model.skeleton, &vec![Default::default(); 18], 4000.0).expect("valid");
    assert_eq!(refused(options(9), &wrong), text("clip.duration", "4000"));
}

/// The passes take a collapsed model as they take any other.
#[test]
fn a_crowd_of_it_is_skinned_on_the_device() {
    use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
    use relievo::ops::animation::keyframe_cursor::KeyframeCursorPass;
    use relievo::ops::animation::local_to_model::LocalToModelPass;
    use relievo::ops::animation::local_to_model::reference::local_to_model;
    use relievo::ops::animation::sample::SamplePass;
    use relievo::ops::animation::sample::reference::sample;
    use relievo::ops::animation::{ClipSet, Instance, RotationPath, Wrap};
    use relievo::ops::skinning::frame::{SkinFrame, SkinOptions};
    use relievo::ops::skinning::morph::reference::morph;
    use relievo::ops::skinning::palette::reference::palette_for;
    use relievo::ops::skinning::skin::reference::skin;
    use relievo::ops::skinning::{Blend, InstanceLod};

    let gpu = crate::harness::gpu();
    let creature = shapes::model();
    let model = collapsed(&creature, 80).model;
    assert_eq!((creature.skeleton.len(), model.skeleton.len()), (153, 80));
    let set = ClipSet::new(&model.clips.iter().collect::<Vec<_>>()).expect("one skeleton");
    let plays = [(0, 0.3), (1, 0.9), (2, 0.4)];
    let instances = plays.map(|(clip, time)| Instance::new(clip, Wrap::Clamp, time, 0.0));
    let clips = ClipBuffers::new(&gpu, &set).expect("uploaded");
    let crowd = Crowd::new(&gpu, &set, &instances).expect("fits");
    let place = KeyframeCursorPass::new(&gpu).expect("compiled").prepare(&gpu, &clips, &crowd).expect("fits");
    let pass = SamplePass::new(&gpu, RotationPath::Slerp).expect("compiled");
    let sampled = pass.prepare(&gpu, &clips, &crowd).expect("fits");
    let pass = LocalToModelPass::new(&gpu).expect("compiled");
    let concatenated = pass.prepare(&gpu, &model.skeleton, &crowd).expect("fits");
    let options = SkinOptions { mesh: 0, instances: 3, blend: Blend::Linear };
    let frame = SkinFrame::new(&gpu, &model, crowd.model_matrices(), options).expect("fits");
    frame.crowd.instance_lods.write(&gpu, &[InstanceLod::FULL; 3]).expect("written");
    gpu.run("test", |encoder| {
        place.record(encoder);
        sampled.record(encoder);
        concatenated.record(encoder);
        frame.record_updated_bones(encoder);
    })
    .expect("run");
    let models = crowd.model_matrices().read_blocking(&gpu).expect("read");
    assert_eq!(models.len(), 3 * 80);
    for (instance, (clip, time)) in plays.into_iter().enumerate() {
        let clip = &model.clips[clip as usize];
        let bones = local_to_model(&model.skeleton, &sample(clip, time, RotationPath::Slerp));
        let palette = palette_for(&model.skins[0], &bones, Blend::Linear);
        let mesh = &model.meshes[0];
        let expected = skin(&morph(mesh, &[]), &mesh.influences, &palette, InstanceLod::FULL);
        let found = frame.read(&gpu, instance).expect("read");
        let off = found
            .iter()
            .zip(&expected)
            .map(|(a, b)| glam::Vec3::from(a.position).distance(glam::Vec3::from(b.position)));
        assert!(off.fold(0.0, f32::max) < 1e-5);
    }
}
