//! Clips over clips, and the motion of roots.

use glam::{DVec3, Quat, Vec3};
use relievo::asset::{BoneKeys, Clip, Interpolation, Keys};
use relievo::ops::animation::Pose;
use relievo::ops::animation::layers::mask_below;
use relievo::ops::animation::local_to_model::reference::local_to_model;

use relievo::ops::animation::sample::reference::blend;
use relievo::scene::{
    CharacterOptions, InstanceBone, InstanceId, LayerMask, Placement, Play, Quality, RootMotionParts,
    RootOptions, Scene, View,
};

use crate::frame::{Frame, device};
use crate::harness::Difference;
use crate::host;
use crate::world::{SIZE, model};

/// The bones that are compared; the second layer plays on the first of them and what lies below.
const BONES: [usize; 4] = [40, 0, 100, 152];

fn scene(gpu: &relievo::gpu::Gpu) -> (Scene, InstanceId, View) {
    let mut scene = Scene::new(gpu).expect("compiled");
    let layers = vec![LayerMask::All, LayerMask::Below("40")];
    let options = CharacterOptions { layers, ..CharacterOptions::default() };
    let creature = scene.add_character_with(&model(), 2, &options).expect("added");
    let instance = scene.spawn(creature, Placement::default()).expect("room");
    let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
    let eye = relievo::scene::Camera::looking_at(
        Vec3::new(0.0, 2.5, 9.0),
        Vec3::new(0.0, 1.5, 0.0),
        0.6,
        [0.5, 60.0],
        SIZE,
    );
    view.set(eye).expect("a camera");
    (scene, instance, view)
}

fn submit(scene: &mut Scene, view: &mut View) {
    let gpu = scene.gpu().clone();
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [view]).expect("recorded");
    gpu.queue().submit([encoder.finish()]);
    gpu.wait().expect("done");
}

/// Bones lie where the host blends them: by weight, by mask, and while a weight changes.
#[test]
fn layers_are_blended() {
    let gpu = device();
    let (mut scene, instance, mut view) = scene(&gpu);
    let model = model();
    let names = BONES.map(|bone| bone.to_string());
    let pairs: Vec<_> = names.iter().map(|bone| InstanceBone { instance, bone }).collect();
    scene.watch_bones(&pairs).expect("bones");
    scene.play(instance, &Play { start: -0.3, ..Play::new("0") }).expect("a clip");
    scene.play_layer(instance, 1, &Play { rate: 0.5, ..Play::new("1") }, 0.4).expect("a layer");
    scene.play_layer(instance, 2, &Play { start: -0.1, ..Play::new("2") }, 0.0).expect("a layer");
    scene.fade_layer(instance, 2, 1.0, 0.5).expect("a layer");
    let mask = mask_below(&model.skeleton, 40).expect("a bone");
    let mut found = Vec::new();
    for step in [0.0, 0.2, 0.2, 0.4] {
        scene.advance(step).expect("finite");
        submit(&mut scene, &mut view);
        let now = scene.time();
        let sampled = |clip: usize, seconds: f64| {
            let inside = seconds.rem_euclid(f64::from(model.clips[clip].duration())) as f32;
            Pose::on_host(&model.skeleton, &model.clips[clip], inside).locals
        };
        let mut locals = sampled(0, now + 0.3);
        let (first, second) = (sampled(1, 0.5 * now), sampled(2, now + 0.1));
        let weight = (now as f32 / 0.5).min(1.0);
        for bone in 0..locals.len() {
            locals[bone] = blend(&locals[bone], &first[bone], 0.4);
            if weight * mask[bone] > 0.0 {
                locals[bone] = blend(&locals[bone], &second[bone], weight * mask[bone]);
            }
        }
        let right = local_to_model(&model.skeleton, &locals);
        for bone in &scene.watched_bones().expect("arrived").bones {
            let (matrix, expected) = (host::affine(&bone.cell_from_bone), host::affine(&right[bone.bone]));
            let off = (matrix.matrix3 - expected.matrix3).to_cols_array();
            let moved = matrix.translation.distance(expected.translation);
            let most = off.iter().fold(moved, |most, entry| most.max(entry.abs()));
            assert!(most < 2e-4, "bone {} at {now}: {most}", bone.bone);
        }
        found.push(scene.watched_bones().expect("arrived").bones[0].cell_from_bone);
        let bounds = scene.bounds(instance).expect("there");
        let [low, high] = bounds.world();
        assert!(low.is_finite() && low.cmplt(high).all());
    }
    assert!(found.windows(2).all(|pair| pair[0] != pair[1]), "nothing moves");
    let refused = |result: Result<(), relievo::InputError>| result.expect_err("refused").path;
    assert_eq!(refused(scene.fade_layer(instance, 3, 1.0, 0.0)), "layer");
    assert_eq!(refused(scene.fade_layer(instance, 1, 1.5, 0.0)), "weight");
    assert_eq!(refused(scene.fade_layer(instance, 1, 1.0, -1.0)), "seconds");
    assert_eq!(refused(scene.cross_fade(instance, 2, &Play::new("1"), 0.2)), "layer");
    assert_eq!(refused(scene.play_layer(instance, 1, &Play::new("hop"), 1.0)), "play.clip");
}

/// After a cross-fade the base plays the clip alone, without a jump; nothing of the layer stays, not even for who comes next.
#[test]
fn clips_fade_into_each_other() {
    let gpu = device();
    let (mut scene, instance, mut view) = scene(&gpu);
    let next = Play { start: -0.2, ..Play::new("1") };
    scene.cross_fade(instance, 1, &next, 0.25).expect("a layer");
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &scene);
    let mut pictures = Vec::new();
    for step in [0.0, 0.12, 0.12999, 0.00002, 0.0] {
        scene.advance(step).expect("finite");
        pictures.push(frame.shot(&mut scene, &mut view, &renderer));
    }
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    let jump = Difference::of(&pictures[2], &pictures[3], 3);
    assert!(jump.outliers < 0.002, "{jump:?}");
    assert_eq!(scene.clip_time(instance).expect("there").expect("a character").clip, 1);
    let (mut alone, other, mut eye) = self::scene(&gpu);
    alone.play(other, &next).expect("a clip");
    alone.advance(scene.time() as f32).expect("finite");
    let expected = frame.shot(&mut alone, &mut eye, &renderer);
    let difference = Difference::of(&pictures[4], &expected, 1);
    assert!(difference.outliers < 0.001, "{difference:?}");
    // The next instance in the same place plays nothing above its base.
    scene.play_layer(instance, 1, &Play::new("2"), 1.0).expect("a layer");
    let object = instance.object();
    scene.despawn(instance).expect("there");
    let heir = scene.spawn(object, Placement::default()).expect("room");
    scene.play(heir, &next).expect("a clip");
    let difference = Difference::of(&frame.shot(&mut scene, &mut view, &renderer), &expected, 1);
    assert!(difference.outliers < 0.001, "{difference:?}");
}

/// A clip that walks and turns, played in place by instances that are moved by its motion, is where the clip has it.
#[test]
fn roots_keep_their_place() {
    let gpu = device();
    let mut model = model();
    let mut keys = vec![BoneKeys::default(); model.skeleton.len()];
    let height = model.skeleton.bones()[0].rest.translation[1];
    let linear = |values: Vec<[f32; 4]>| Keys {
        times: vec![0.0, 0.6, 1.0],
        values,
        interpolation: Interpolation::Linear,
    };
    keys[0].translation =
        Some(linear(vec![[0.0, height, 0.0, 0.0], [0.4, height + 0.2, 1.0, 0.0], [1.0, height, 1.5, 0.0]]));
    let turned = |angle: f32| Quat::from_rotation_y(angle).to_array();
    keys[0].rotation = Some(linear(vec![turned(0.0), turned(0.5), turned(0.9)]));
    model.clips = vec![Clip::new("stride", &model.skeleton, &keys, 1.0).expect("valid")];
    let mut scene = Scene::new(&gpu).expect("compiled");
    let taken = RootMotionParts { yaw: true, ..RootMotionParts::default() };
    let root = Some(RootOptions { bone: "0", taken });
    let options = CharacterOptions { root_motion: root, ..CharacterOptions::default() };
    let walker = scene.add_character_with(&model, 1, &options).expect("added");
    let still = scene.add_character(&model, 1).expect("added");
    let begin = Placement::at([3.0, 0.0, -2.0]).turned(0.7).scaled(2.0);
    let [mut moved, fixed] = [walker, still].map(|object| scene.spawn(object, begin).expect("room"));
    assert!(scene.root_motion(fixed, 0.0, 1.0).expect_err("refused").bound.contains("root_motion"));
    let mut at = 0.0;
    for step in [0.3, 0.25, 0.4] {
        scene.advance(step).expect("finite");
        let motion = scene.root_motion(moved, at, scene.time()).expect("taken");
        at = scene.time();
        let before = scene.placement(moved).expect("there");
        scene.move_to(moved, before.moved_by(&motion)).expect("there");
        let boxes = [moved, fixed].map(|instance| scene.bounds(instance).expect("there"));
        let middle = boxes.map(|found| found.world().into_iter().sum::<DVec3>() / 2.0);
        assert!(middle[0].distance(middle[1]) < 0.1, "{middle:?}");
        // Bones, more precisely.
        scene
            .watch_bones(&[moved, fixed].map(|instance| InstanceBone { instance, bone: "40" }))
            .expect("bones");
        let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
        let eye = relievo::scene::Camera::looking_at(
            Vec3::new(0.0, 20.0, 40.0),
            Vec3::ZERO,
            1.0,
            [0.5, 200.0],
            SIZE,
        );
        view.set(eye).expect("a camera");
        submit(&mut scene, &mut view);
        let found = scene.watched_bones().expect("arrived");
        let places = [0, 1].map(|at| found.bones[at].world());
        assert!(places[0].distance(places[1]) < 5e-3, "{places:?}");
    }
    // In place, the walker has not moved by itself.
    let motion = scene.root_motion(moved, 0.0, 0.95).expect("taken");
    assert!(Vec3::from(motion.translation).length() > 1.0, "{motion:?}");
    let old = moved;
    scene.despawn(old).expect("there");
    moved = scene.spawn(walker, begin).expect("room");
    assert_eq!(scene.root_motion(old, 0.0, 1.0).expect_err("refused").path, "instance");
    assert!(scene.root_motion(moved, 0.0, f64::NAN).is_err());
}
