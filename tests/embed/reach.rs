//! Poses on the host, bones that are written from it, and what boxes, rays and offsets make of them.

use glam::{DQuat, DVec3, Quat, Vec3};
use image::RgbaImage;
use relievo::asset::Transform;
use relievo::asset::material::Alpha;
use relievo::gpu::Gpu;
use relievo::render::Layer;
use relievo::scene::{
    Camera, InstanceBone, InstanceId, InstancePose, Placement, Play, Quality, Ray, Scene, View,
};

use crate::frame::{Frame, device};
use crate::host;
use crate::rays;
use crate::world::{SIZE, model};
#[path = "../../examples/reach/two_bones.rs"]
mod two_bones;
use two_bones::Limb;

const ARM: [&str; 3] = ["upper_arm_left", "forearm_left", "hand_left"];

/// A scene with a creature that waves.
struct Stage {
    gpu: Gpu,
    scene: Scene,
    waver: InstanceId,
    arm: Limb,
    view: View,
}

impl Stage {
    fn new(placement: Placement) -> Self {
        let gpu = device();
        let mut scene = Scene::new(&gpu).expect("compiled");
        let object = scene.add_character(&model(), 1).expect("added");
        let waver = scene.spawn(object, placement).expect("room");
        scene.play(waver, &Play::new("wave")).expect("the clip");
        let [upper, lower, end] = ARM.map(|name| scene.bone(waver, name).expect("a bone"));
        scene.drive(waver, &ARM[..2]).expect("bones");
        let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
        let (from, to) = (DVec3::new(0.0, 5.0, 20.0), DVec3::new(0.0, 3.0, 0.0));
        let at = placement.world();
        view.set(Camera::looking_at_world(at + from, at + to, 0.6, [0.5, 400.0], SIZE)).expect("a camera");
        Self { gpu, scene, waver, arm: Limb { upper, lower, end }, view }
    }

    fn pose(&self) -> InstancePose {
        self.scene.pose(self.waver).expect("a character")
    }

    /// Records, draws and submits a frame that writes both bones of the arm, if there is a pose.
    fn shot(&mut self, written: Option<&InstancePose>) -> RgbaImage {
        let frame = Frame::plain(&self.gpu, SIZE);
        let renderer = frame.renderer(&self.gpu, &self.scene);
        let mut encoder = self.gpu.encoder("frame");
        let (waver, arm) = (self.waver, self.arm);
        let views = &mut [&mut self.view];
        let recorded = self.scene.record_with(&mut encoder, views, |encoder, poses| {
            let Some(pose) = written else { return Ok(()) };
            // What is written last counts.
            poses.write(encoder, waver, arm.upper, Transform::IDENTITY)?;
            poses.write(encoder, waver, arm.upper, pose.local(arm.upper)?)?;
            poses.write(encoder, waver, arm.lower, pose.local(arm.lower)?)
        });
        recorded.expect("recorded");
        frame.pass(&mut encoder, |pass| {
            renderer.draw(pass, &self.scene, &self.view, Layer::Color).expect("drawn");
        });
        self.gpu.queue().submit([encoder.finish()]);
        frame.read(&self.gpu)
    }
}

/// The hand of each frame is on its target, on the device, anywhere in the world, mirrored or not; and where the clip has it
/// in a frame that writes nothing.
#[test]
fn hands_reach() {
    for (mirror, at) in [(1.0, DVec3::ZERO), (-1.0, DVec3::new(1e5, 30.0, -2e5))] {
        let scale = Vec3::new(3.0 * mirror, 3.0, 3.0);
        let turn = Quat::from_rotation_y(0.4) * Quat::from_rotation_x(0.1);
        let mut stage = Stage::new(Placement { scale, turn, ..Placement::at_world(at) });
        let watched = [ARM[2], "hand_right"].map(|bone| InstanceBone { instance: stage.waver, bone });
        stage.scene.watch_bones(&watched).expect("bones");
        let mut pictures = Vec::new();
        for (step, aside) in [(0.3, [0.4, 0.6]), (0.0, [0.9, -0.5]), (0.21, [0.1, -1.3])] {
            stage.scene.advance(step).expect("finite");
            let mut pose = stage.pose();
            let shoulder = pose.world(stage.arm.upper).expect("a bone");
            let clip = [stage.arm.end, stage.scene.bone(stage.waver, "hand_right").expect("a bone")]
                .map(|bone| pose.world(bone).expect("a bone"));
            let target = shoulder + DVec3::new(aside[0], aside[1], 0.3);
            stage.arm.reach(&mut pose, target).expect("bones");
            let written = pose.clone();
            pictures.push(stage.shot(Some(&written)));
            let places = |stage: &mut Stage| {
                let found = stage.scene.watched_bones().expect("arrived");
                [0, 1].map(|at| found.bones[at].world())
            };
            let found = places(&mut stage);
            // Half a unit of the last place of model matrices in f32, of sizes below 8, over a chain of bones.
            assert!(found[0].distance(target) < 1e-4, "{} of {target}", found[0]);
            assert!(found[1].distance(clip[1]) < 1e-4, "the other hand has moved");
            assert!(clip[0].distance(target) > 0.3, "the clip has the hand there");
            stage.shot(None);
            assert!(places(&mut stage)[0].distance(clip[0]) < 1e-4, "what was written stays");
        }
        assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
        // Too far away: the arm is straight, and points there.
        let mut pose = stage.pose();
        let shoulder = pose.world(stage.arm.upper).expect("a bone");
        stage.arm.reach(&mut pose, shoulder + DVec3::new(0.0, 300.0, 400.0)).expect("bones");
        let [elbow, hand] = [stage.arm.lower, stage.arm.end].map(|bone| pose.world(bone).expect("a bone"));
        let ahead = (hand - shoulder).normalize();
        assert!(ahead.distance(DVec3::new(0.0, 0.6, 0.8)) < 1e-4, "{ahead}");
        let lengths = shoulder.distance(elbow) + elbow.distance(hand);
        assert!((lengths - shoulder.distance(hand)).abs() < 1e-4, "bent");
    }
}

/// The pose on the host is the device's, and its joints are in the world.
#[test]
fn poses_on_the_host_are_those_of_the_device() {
    let mut stage = Stage::new(Placement::at_world([7e4, 3.0, 9e4]).turned(1.0).scaled(0.5));
    let bones = [0, 40, 80, 152];
    let names = bones.map(|bone| bone.to_string());
    stage.scene.drive(stage.waver, &[]).expect("there");
    let watched = names.each_ref().map(|bone| InstanceBone { instance: stage.waver, bone });
    stage.scene.watch_bones(&watched).expect("bones");
    stage.scene.advance(0.7).expect("finite");
    stage.shot(None);
    let pose = stage.pose();
    for bone in &stage.scene.watched_bones().expect("arrived").bones {
        let right = pose.world_from_bone(bone.bone).expect("a bone");
        let off = (right.matrix3 - bone.world_from_bone().matrix3).to_cols_array();
        let moved = right.translation.distance(bone.world());
        assert!(off.iter().fold(moved, |most, entry| most.max(entry.abs())) < 1e-4, "bone {}", bone.bone);
        assert!(right.translation.distance(DVec3::new(7e4, 3.0, 9e4)) < 2.0, "not in the world");
    }
    let expected = host::bones(&stage.scene, &model(), stage.waver);
    assert!(pose.world(152).expect("a bone").distance(expected[152].translation) < 1e-5);
    let statue = stage.scene.add_mesh(&model(), 1).expect("added");
    let statue = stage.scene.spawn(statue, Placement::default()).expect("room");
    assert_eq!(stage.scene.pose(statue).expect_err("refused").path, "instance");
}

/// Of every other pixel of every other row: how many show the creature, and for how many a ray says otherwise.
fn wrong(stage: &Stage, picture: &RgbaImage) -> (usize, usize) {
    let sky = *picture.get_pixel(0, 0);
    let camera = stage.view.camera().expect("set");
    let mut counts = (0, 0);
    for (x, y, pixel) in picture.enumerate_pixels().filter(|(x, y, _)| x % 2 == 0 && y % 2 == 0) {
        let ray = Ray::through(camera, [x as f32 + 0.5, y as f32 + 0.5]).expect("a pixel");
        let hit = stage.scene.pick(&ray).expect("a ray");
        counts.0 += usize::from(*pixel != sky);
        counts.1 += usize::from(hit.is_some() != (*pixel != sky));
    }
    counts
}

/// Rays and boxes follow bones that were written, also out of the sphere of the clip, until a frame writes none.
#[test]
fn rays_and_boxes_follow_written_bones() {
    let mut stage = Stage::new(Placement::default().scaled(3.0));
    stage.scene.advance(0.6).expect("finite");
    let before = stage.scene.tight_bounds(stage.waver).expect("there").world();
    let mut pose = stage.pose();
    pose.turn(stage.arm.upper, DQuat::from_rotation_z(1.2)).expect("a bone");
    let local = pose.local(stage.arm.upper).expect("a bone");
    pose.set_local(stage.arm.upper, Transform { scale: [2.5; 3], ..local }).expect("a bone");
    let picture = stage.shot(Some(&pose));
    let (drawn, off) = wrong(&stage, &picture);
    println!("{off} of {drawn} pixels that are drawn are wrong");
    assert!(drawn > 150 && off <= 1, "{off} of {drawn}");
    let hand = pose.world(stage.arm.end).expect("a bone");
    let [low, high] = stage.scene.tight_bounds(stage.waver).expect("there").world();
    assert!((low - 0.5).cmple(hand).all() && hand.cmple(high + 0.5).all(), "{low} {hand} {high}");
    assert!(high.distance(before[1]) > 1.0, "the arm is not in the box");
    let around = stage.scene.bounds(stage.waver).expect("there").world();
    assert!(around[0].cmple(low).all() && high.cmple(around[1]).all(), "{around:?} {low} {high}");
    // A frame that writes nothing shows the clip, and rays meet the clip: most of the arm is elsewhere.
    let clip = stage.shot(None);
    let (_, off) = wrong(&stage, &clip);
    assert!(off <= 1, "{off}");
    let (_, off) = wrong(&stage, &picture);
    println!("{off} if rays ignore what is written");
    assert!(off > 15, "{off}: the comparison sees nothing");
    assert_eq!(stage.scene.tight_bounds(stage.waver).expect("there").world(), before);
}

/// What cannot be written is refused, and named.
#[test]
fn only_driven_bones_are_written() {
    let mut stage = Stage::new(Placement::default());
    let (waver, hand, upper) = (stage.waver, stage.arm.end, stage.arm.upper);
    let gone = stage.scene.spawn(waver.object(), Placement::default()).expect("room");
    stage.scene.despawn(gone).expect("there");
    let flat = Transform { rotation: [0.0; 4], ..Transform::IDENTITY };
    let cases = [
        (waver, hand, Transform::IDENTITY, "bone"),
        (waver, 500, Transform::IDENTITY, "bone"),
        (gone, upper, Transform::IDENTITY, "instance"),
        (waver, upper, flat, "local.rotation"),
    ];
    for (instance, bone, local, path) in cases {
        let mut encoder = stage.gpu.encoder("frame");
        let recorded = stage.scene.record_with(&mut encoder, &mut [&mut stage.view], |encoder, poses| {
            poses.write(encoder, instance, bone, local)
        });
        let error = recorded.expect_err("refused").to_string();
        assert!(error.starts_with(path), "{error}");
        drop(encoder);
        stage.scene.invalidate().expect("afresh");
    }
}

/// An offset in world units is one on a character of any scale; without the conversion it shrinks with the character.
#[test]
fn offsets_in_world_units() {
    for scale in [0.01, 2.0] {
        let mut stage = Stage::new(Placement::at_world([500.0, 0.0, 0.0]).turned(0.7).scaled(scale));
        let cube = rays::model(&rays::cube(), rays::plain([1.0; 4], Alpha::Opaque), false);
        let cube = stage.scene.add_mesh(&cube, 1).expect("added");
        let cube = stage.scene.spawn(cube, Placement::default()).expect("room");
        let pose = stage.pose();
        let bone = pose.world_from_bone(stage.arm.end).expect("a bone");
        let (size, turn, _) = bone.to_scale_rotation_translation();
        // Along the axes of the world, with edges of 0.2 units.
        let rotation = turn.inverse().to_array().map(|part| part as f32);
        let offset = Transform { translation: [0.0, 0.3, 0.4], rotation, scale: [0.1; 3] };
        let converted = pose.offset_of_world_units(stage.arm.end, offset).expect("a bone");
        for (own, right) in [(converted, 1.0), (offset, size.x)] {
            stage.scene.attach(cube, stage.waver, ARM[2], own).expect("a bone");
            let [low, high] = stage.scene.tight_bounds(cube).expect("there").world();
            let edges = high - low;
            // Boxes are larger by a millionth of an offset in a cell, below 443.
            assert!((edges - 0.2 * right).abs().max_element() < 1e-3, "{edges} for {right}");
            let away = ((low + high) / 2.0).distance(bone.translation);
            assert!((away - 0.5 * right).abs() < 1e-3, "{away} for {right}");
        }
        assert!((size.x - f64::from(scale)).abs() < 0.3 * f64::from(scale), "{size}");
    }
}

/// Whatever has a place says it in world coordinates, far from the origin too, where each has a cell of its own.
#[test]
fn every_place_is_one_of_the_world() {
    let at = DVec3::new(1e6 + 0.25, 254.0, -2e6 - 10.0);
    let mut stage = Stage::new(Placement::at_world(at).scaled(3.0));
    stage.scene.watch_bones(&[InstanceBone { instance: stage.waver, bone: "pelvis" }]).expect("a bone");
    stage.shot(None);
    let pelvis =
        stage.pose().world(stage.scene.bone(stage.waver, "pelvis").expect("a bone")).expect("a bone");
    assert!(pelvis.distance(at + DVec3::Y * 3.0) < 1.5, "{pelvis}");
    let watched = stage.scene.watched_bones().expect("arrived").bones[0];
    assert!(watched.world().distance(pelvis) < 1e-4);
    assert!(watched.world_from_bone().translation == watched.world());
    assert_eq!(stage.scene.placement(stage.waver).expect("there").world(), at);
    // The eye lies in another cell than the creature.
    let camera = *stage.view.camera().expect("set");
    let eye = at + DVec3::new(0.0, 5.0, 20.0);
    assert!(camera.world().distance(eye) < 1e-4 && camera.cell != watched.cell, "{}", camera.world());
    let ray = Ray { offset: camera.world(), ..Ray::new(DVec3::ZERO, pelvis - eye) };
    assert_eq!((ray.cell, ray.world()), ([0; 3], camera.world()));
    let through = Ray::through(&camera, SIZE.map(|size| size as f32 / 2.0)).expect("a pixel");
    assert!((through.world().distance(eye) - 0.5).abs() < 1e-2 && through.cell == camera.cell);
    let [low, high] = stage.scene.bounds(stage.waver).expect("there").world();
    for ray in [ray, through] {
        let hit = stage.scene.pick(&ray).expect("a ray").expect("the creature");
        assert_eq!((hit.instance, hit.cell), (stage.waver, ray.cell));
        assert!((hit.world().distance(ray.world()) - hit.distance).abs() < 1e-6);
        assert!(
            hit.world().distance(pelvis) < 2.5 && (low.cmple(hit.world()) & hit.world().cmple(high)).all()
        );
    }
    let framed = Camera::framing(low, high, SIZE);
    assert!(framed.world().distance(at) < 60.0, "{}", framed.world());
}
