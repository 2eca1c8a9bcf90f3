//! Statistics and watched bones: what arrives on the host some frames later.

use glam::Vec3;
use relievo::gpu::Gpu;
use relievo::scene::{Camera, InstanceBone, Placement, Quality, Scene, View};
use relievo::wgpu;

use crate::frame::new_device;
use crate::host;
use crate::world::{SIZE, World, model};

/// From so far away that everything is in view.
fn afar() -> Camera {
    Camera::looking_at(Vec3::new(0.0, 250.0, 250.0), Vec3::ZERO, 1.0, [0.5, 2000.0], SIZE)
}

fn submit(scene: &mut Scene, views: &mut [&mut View]) {
    let gpu = scene.gpu().clone();
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, views).expect("recorded");
    gpu.queue().submit([encoder.finish()]);
}

/// Counts are those of the frame that they name, by level and object.
#[test]
fn frames_are_counted() {
    let gpu = new_device();
    let mut world = World::new(&gpu, 10);
    let statue = world.scene.add_mesh(&model(), 4).expect("added");
    for at in 0..3 {
        world.scene.spawn(statue, Placement::at([at as f32, 0.0, 30.0])).expect("room");
    }
    let mut all = world.view(0.0);
    all.set(afar()).expect("a camera");
    let mut none = world.view(0.25);
    none.set(Camera::looking_at(Vec3::Y * 900.0, Vec3::Y * 2000.0, 0.5, [0.5, 90.0], SIZE))
        .expect("a camera");
    submit(&mut world.scene, &mut [&mut all, &mut none]);
    gpu.wait().expect("done");
    assert!(world.scene.statistics().is_none() && all.statistics().is_none(), "nobody asked");
    world.scene.set_statistics(true).expect("room");
    world.scene.refresh().expect("afresh");
    submit(&mut world.scene, &mut [&mut all, &mut none]);
    gpu.wait().expect("done");
    let of_all = all.statistics().expect("arrived").clone();
    assert_eq!((of_all.frame, of_all.pixels, of_all.objects.len()), (1, 0.0, 3));
    let triangles: u64 = model().meshes.iter().map(|mesh| mesh.indices.len() as u64 / 3).sum();
    for (object, instances, each) in
        [(world.land, 9, 2 * 32 * 32), (world.creature, 10, triangles), (statue, 3, triangles)]
    {
        let found = of_all.objects.iter().find(|found| found.object == object).expect("counted");
        assert_eq!((found.levels[0].instances, found.instances()), (instances, instances));
        assert_eq!(
            (found.levels[0].triangles, found.triangles()),
            (u64::from(instances) * each, found.triangles())
        );
    }
    let of_none = none.statistics().expect("arrived");
    assert!(of_none.objects.iter().all(|object| object.instances() == 0 && object.pixels == 0.25));
    let characters = world.scene.statistics().expect("arrived").characters.clone();
    // Everything afresh: every bone of every instance, and every cluster of 64 vertices.
    let (bones, vertices) = (model().skeleton.len() as u32, model().meshes[0].positions.len());
    assert_eq!((characters.len(), characters[0].object), (1, world.creature));
    assert_eq!(
        (characters[0].bones, characters[0].clusters),
        (10 * bones, 10 * vertices.div_ceil(64) as u32)
    );
    assert!(world.scene.stage_times().is_none(), "a device without timestamps");
    // Nothing moves: nothing is done. Coarser: fewer triangles.
    all.set_quality(Quality::pixels(2.0)).expect("a quality");
    world.scene.advance(0.0).expect("finite");
    for _ in 0..2 {
        submit(&mut world.scene, &mut [&mut all, &mut none]);
    }
    gpu.wait().expect("done");
    let still = world.scene.statistics().expect("arrived").clone();
    assert_eq!((still.frame, still.characters[0].bones, still.characters[0].clusters), (3, 0, 0));
    let coarser = all.statistics().expect("arrived");
    let creature = coarser.objects.iter().find(|found| found.object == world.creature).expect("counted");
    assert_eq!((coarser.frame, coarser.pixels, creature.instances()), (3, 2.0, 10));
    assert!(creature.levels.len() > 2 && creature.triangles() < 5 * triangles, "{creature:?}");
    world.scene.set_statistics(false).expect("no more");
    submit(&mut world.scene, &mut [&mut all, &mut none]);
    assert!(world.scene.statistics().is_none() && all.statistics().is_none());
}

/// The error of a mesh at full detail, which a package has by its quantization, counts into the pixels of statistics where it
/// exceeds what the view allows.
#[test]
fn the_error_of_full_detail_counts() {
    let gpu = new_device();
    let pixels_at = |error: f32, distance: f32, pixels: f32| {
        let mut scene = Scene::new(&gpu).expect("a scene");
        let mut quantized = relievo_samples::rock().expect("valid");
        quantized.meshes[0].error = error;
        let [exact, rock] = [relievo_samples::rock().expect("valid"), quantized]
            .map(|model| scene.add_mesh(&model, 1).expect("added"));
        scene.spawn(exact, Placement::at([0.0, 0.0, -distance])).expect("room");
        let id = scene.spawn(rock, Placement::at([0.0, 0.0, -distance]).scaled(2.0)).expect("room");
        scene.set_statistics(true).expect("room");
        let mut view = scene.view(Quality::pixels(pixels)).expect("a quality");
        view.set(Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, [0.5, 2000.0], SIZE)).expect("a camera");
        submit(&mut scene, &mut [&mut view]);
        gpu.wait().expect("done");
        let counted = view.statistics().expect("arrived");
        assert_eq!(counted.objects[0].pixels, pixels);
        assert_eq!(counted.pixels, counted.objects[1].pixels);
        // The corners of the instance's box are at least this far from the eye.
        let [low, high] = scene.bounds(id).expect("there").world();
        (counted.pixels, low.distance(high) as f32)
    };
    for distance in [30.0, 300.0] {
        assert_eq!(pixels_at(0.0, distance, 1.0).0, 1.0);
        assert_eq!(pixels_at(1e-4, distance, 1.0).0, 1.0);
        let focal = 0.5 * SIZE[1] as f32 / 0.5_f32.tan();
        for pixels in [0.0, 1.0] {
            let (found, diagonal) = pixels_at(4.0, distance, pixels);
            // A displacement of 8 world units at the nearest and at the middle depth.
            let at = |depth: f32| focal * 8.0 / (depth - 8.0);
            let most = 1.1 * at(distance - diagonal.min(0.5 * distance));
            assert!(
                (at(distance)..most).contains(&found),
                "{found} at {distance}: {} to {most}",
                at(distance)
            );
        }
    }
    assert_eq!(pixels_at(4.0, 5.0, 1.0).0, f32::INFINITY);
}

/// Bones are sampled and clusters are skinned once a frame for all views: two views of the same characters, one fine and one
/// coarse, take what the fine one takes alone, frame by frame.
#[test]
fn two_views_take_what_the_finer_takes() {
    let gpu = new_device();
    let of = |qualities: &[f32]| {
        let mut world = World::new(&gpu, 10);
        world.scene.set_statistics(true).expect("room");
        let mut views: Vec<View> = qualities.iter().map(|pixels| world.view(*pixels)).collect();
        for view in &mut views {
            view.set(afar()).expect("a camera");
        }
        let frames = (0..12).map(|_| {
            submit(&mut world.scene, &mut views.iter_mut().collect::<Vec<_>>());
            gpu.wait().expect("done");
            world.scene.advance(1.0 / 60.0).expect("finite");
            let counted = world.scene.statistics().expect("arrived");
            let [characters] = counted.characters[..] else { panic!("one character") };
            (counted.frame, characters.bones, characters.clusters)
        });
        frames.collect::<Vec<_>>()
    };
    let (fine, coarse) = (of(&[0.05]), of(&[1.0]));
    println!("frame, bones, clusters: fine {fine:?}, coarse {coarse:?}");
    let sums = |frames: &[(u64, u32, u32)]| {
        frames.iter().fold([0; 2], |[bones, clusters], frame| [bones + frame.1, clusters + frame.2])
    };
    let ([bones, clusters], [fewer, less]) = (sums(&fine), sums(&coarse));
    assert!(fewer < bones && less < clusters && fewer > 0, "{fewer} of {bones} bones, {less} of {clusters}");
    for both in [[0.05, 1.0], [1.0, 0.05], [0.05, 0.05]] {
        assert_eq!(of(&both), fine, "{both:?}");
    }
}

/// Many frames in a row are neither waited for nor lost for good: the last that has arrived is told, and dropped encoders
/// do no harm.
#[test]
fn counts_arrive_late() {
    let gpu = new_device();
    let mut world = World::new(&gpu, 3);
    world.scene.set_statistics(true).expect("room");
    let watched = [InstanceBone { instance: world.crowd[0], bone: "0" }];
    world.scene.watch_bones(&watched).expect("a bone");
    let mut view = world.view(1.0);
    let mut held = 0;
    for at in 0..40 {
        submit(&mut world.scene, &mut [&mut view]);
        if at % 4 == 3 {
            gpu.wait().expect("done");
            let frame = world.scene.statistics().expect("arrived").frame;
            assert!(frame <= at && frame + 4 > at, "{frame} after {at}");
            assert_eq!(view.statistics().expect("arrived").frame, frame);
            assert_eq!(world.scene.watched_bones().expect("arrived").frame, frame);
        }
        held = if at == 10 { gpu.memory().now() } else { held };
    }
    assert_eq!(gpu.memory().now(), held, "memory grows");
    for _ in 0..3 {
        let mut encoder = gpu.encoder("dropped");
        for _ in 0..4 {
            world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
        }
        drop(encoder);
        world.scene.invalidate().expect("afresh");
    }
    submit(&mut world.scene, &mut [&mut view]);
    gpu.wait().expect("done");
    assert_eq!(world.scene.statistics().expect("arrived").frame, 52);
    assert_eq!(view.statistics().expect("arrived").frame, 52);
    assert_eq!(world.scene.watched_bones().expect("arrived").frame, 52);
}

/// Where the device has timestamps, each stage takes its time, and the pictures are the same.
#[test]
fn stages_take_their_time() {
    let gpu: Gpu = crate::harness::gpu();
    let has_stamps = gpu.device().features().contains(wgpu::Features::TIMESTAMP_QUERY);
    let mut world = World::new(&gpu, 10);
    let mut view = world.view(0.0);
    let frame = crate::frame::Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let expected = frame.shot(&mut world.scene, &mut view, &renderer);
    world.scene.set_statistics(true).expect("room");
    world.scene.refresh().expect("afresh");
    assert!(
        frame.shot(&mut world.scene, &mut view, &renderer) == expected,
        "another picture in passes of their own"
    );
    for _ in 0..3 {
        submit(&mut world.scene, &mut [&mut view]);
        gpu.wait().expect("done");
    }
    let times = world.scene.stage_times().copied();
    assert_eq!(times.is_some(), has_stamps);
    let Some(times) = times else { return };
    let all = [times.select, times.gate, times.sample, times.local_to_model, times.skin];
    assert!(all.iter().all(|time| (0.0..1e4).contains(time)) && times.total() > 0.0, "{times:?}");
    assert!((1..4).contains(&times.frame), "{times:?}");
}

/// Watched bones are where the host poses them, with the placement and at the time of their frame.
#[test]
fn bones_arrive_where_they_are() {
    let gpu = new_device();
    let mut world = World::new(&gpu, 4);
    let model = model();
    let name = &model.skeleton.bones()[40].name;
    let (near, far) = (world.crowd[1], world.crowd[2]);
    let mirrored =
        Placement { cell: [900_000, -3, 7], scale: Vec3::new(-3.0, 3.0, 2.0), ..world.placement(1) };
    world.scene.move_to(near, Placement { offset: mirrored.offset, ..mirrored }).expect("there");
    let watched = [(near, &name[..]), (far, "152"), (near, "0")];
    let watched = watched.map(|(instance, bone)| InstanceBone { instance, bone });
    world.scene.watch_bones(&watched).expect("bones");
    assert!(world.scene.watched_bones().is_none());
    let mut view = world.view(0.0);
    let eye = Camera {
        cell: mirrored.cell,
        ..Camera::looking_at(Vec3::new(0.0, 9.0, 30.0), mirrored.offset, 1.2, [0.5, 400.0], SIZE)
    };
    view.set(eye).expect("a camera");
    submit(&mut world.scene, &mut [&mut view]);
    gpu.wait().expect("done");
    let expected = host::bones(&world.scene, &model, near);
    let time = world.scene.time();
    // What happens later is not of that frame.
    world.scene.move_to(near, Placement::default()).expect("there");
    world.scene.advance(0.5).expect("finite");
    let found = world.scene.watched_bones().expect("arrived").clone();
    assert_eq!((found.frame, found.time, found.bones.len()), (0, time, 3));
    let current: Vec<bool> = found.bones.iter().map(|bone| bone.is_current).collect();
    assert_eq!(current, [true, false, true], "the other one is not in view");
    for (at, bone) in [(0, 40), (2, 0)] {
        let watched = &found.bones[at];
        assert_eq!((watched.instance, watched.bone, watched.cell), (near, bone, mirrored.cell));
        let right = expected[bone];
        let error = (right.inverse() * watched.world_from_bone()).matrix3 - glam::DMat3::IDENTITY;
        assert!(error.to_cols_array().iter().all(|entry| entry.abs() < 1e-4), "{error}");
        assert!((right.translation - watched.world()).length() < 2e-4);
    }
    // An instance that is gone is left out; a bone that is not there is refused.
    world.scene.despawn(far).expect("there");
    submit(&mut world.scene, &mut [&mut view]);
    gpu.wait().expect("done");
    let bones = &world.scene.watched_bones().expect("arrived").bones;
    assert_eq!(bones.iter().map(|bone| bone.bone).collect::<Vec<_>>(), [40, 0]);
    let refused = |result: Result<(), relievo::Error>| result.expect_err("refused").to_string();
    assert!(
        refused(world.scene.watch_bones(&[InstanceBone { instance: near, bone: "153" }]))
            .contains("bone = 153")
    );
    assert!(
        refused(world.scene.watch_bones(&[InstanceBone { instance: far, bone: "1" }])).contains("instance")
    );
}
