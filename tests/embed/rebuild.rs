//! Lost devices, and devices whose memory ends.

use image::RgbaImage;
use relievo::Error;
use relievo::asset::Transform;
use relievo::asset::material::{Alpha, Material};
use relievo::gpu::{Gpu, GpuError};
use relievo::render::{Layer, Renderer, SunShadow};
use relievo::scene::{InstanceId, ObjectId, Placement, Quality, Relief, Scene, View};
use relievo::wgpu;
use relievo_samples::maps::BuiltInMap;

use crate::frame::{Frame, devices, new_device};
use crate::world::{SIZE, World, model};

/// A world with every kind of object, in its twentieth frame or any other.
struct Whole {
    world: World,
    view: View,
    carried: InstanceId,
}

impl Whole {
    fn new(gpu: &Gpu) -> Self {
        let mut world = World::new(gpu, 6);
        let statue = world.scene.add_mesh(&model(), 4).expect("added");
        world.scene.spawn(statue, Placement::at([-6.0, 4.0, 4.0])).expect("room");
        let carried = world.scene.spawn(statue, Placement::default()).expect("room");
        let offset = Transform { scale: [0.2; 3], ..Transform::IDENTITY };
        world.scene.attach(carried, world.crowd[1], "40", offset).expect("a bone");
        let bricks = BuiltInMap::Bricks;
        let relief =
            Relief::wall(2.0, bricks.height_map(64).expect("a map"), bricks.albedo(64).expect("a map"));
        let wall = world.scene.add_relief(&relief, 1).expect("added");
        world.scene.spawn(wall, Placement::at([7.0, 6.0, 2.0]).scaled(5.0)).expect("room");
        let view = world.view(1.0);
        Self { world, view, carried }
    }

    /// A frame later: someone moves, comes or goes.
    fn step(&mut self, at: usize) {
        let World { scene, crowd, .. } = &mut self.world;
        scene.advance(1.0 / 30.0).expect("finite");
        let moved = scene.placement(crowd[at % 4]).expect("there").turned(0.1 * at as f32);
        scene.move_to(crowd[at % 4], moved).expect("there");
        if at.is_multiple_of(10) {
            scene.despawn(crowd[5]).expect("there");
            let heir = self.world.spawn(5 + at % 7);
            self.world.crowd[5] = heir;
        }
    }

    fn record(&mut self) -> Result<(), relievo::Error> {
        let gpu = self.world.scene.gpu().clone();
        let mut encoder = gpu.encoder("frame");
        self.world.scene.record(&mut encoder, &mut [&mut self.view])?;
        gpu.queue().submit([encoder.finish()]);
        // No more frames in flight than a scene allows, as where a window waits for its next picture.
        gpu.wait()?;
        Ok(())
    }

    fn shot(&mut self, frame: &Frame, renderer: &Renderer) -> RgbaImage {
        frame.shot(&mut self.world.scene, &mut self.view, renderer)
    }
}

/// A device that is lost in the middle of 100 frames: handles stay valid, and once scene, view and renderer are rebuilt on
/// another device, its pictures are those of a run that was refreshed there, to the bit.
#[test]
fn a_lost_device_leaves_no_trace() {
    let first = new_device();
    // The suite's handler panics; a lost device reports errors, as it should.
    let [lost, second] = devices();
    lost.device().on_uncaptured_error(std::sync::Arc::new(|_| ()));
    let (mut undisturbed, mut disturbed) = (Whole::new(&first), Whole::new(&lost));
    let frames = [Frame::plain(&first, SIZE), Frame::plain(&lost, SIZE)];
    let renderer = frames[0].renderer(&first, &undisturbed.world.scene);
    let mut other = frames[1].renderer(&lost, &disturbed.world.scene);
    for at in 0..50 {
        undisturbed.step(at);
        undisturbed.record().expect("recorded");
        disturbed.step(at);
        disturbed.record().expect("recorded");
    }
    let before = undisturbed.shot(&frames[0], &renderer);
    assert!(disturbed.shot(&frames[1], &other) == before, "another picture before");
    lost.device().destroy();
    let told = disturbed.record().expect_err("lost");
    assert!(matches!(told, Error::Gpu(GpuError::DeviceLost { .. })), "{told}");
    let frame = Frame::plain(&second, SIZE);
    disturbed.world.scene.rebuild(&second).expect("a device");
    // What was not rebuilt is told, and nothing panics.
    let refused = disturbed.record().expect_err("an old view").to_string();
    assert!(refused.contains("views[0]") && refused.contains("rebuild"), "{refused}");
    disturbed.view.rebuild(&disturbed.world.scene).expect("a device");
    let mut encoder = second.encoder("an old renderer");
    frame.pass(&mut encoder, |pass| {
        let drawn = other.draw(pass, &disturbed.world.scene, &disturbed.view, Layer::Color);
        assert_eq!(drawn.expect_err("an old renderer").path, "scene");
    });
    drop(encoder);
    other.rebuild(&second).expect("compiled");
    undisturbed.world.scene.refresh().expect("afresh");
    for at in 50..100 {
        undisturbed.step(at);
        disturbed.step(at);
        if at % 7 == 1 || at == 50 {
            let picture = undisturbed.shot(&frames[0], &renderer);
            assert!(picture != before, "nothing moves");
            assert!(disturbed.shot(&frame, &other) == picture, "another picture in frame {at}");
        } else {
            undisturbed.record().expect("recorded");
            disturbed.record().expect("recorded");
        }
    }
    let carrier = disturbed.world.crowd[1];
    assert_eq!(disturbed.world.scene.attached_to(disturbed.carried).expect("there"), Some((carrier, 40)));
}

/// A device that is lost is called lost by everything that can fail, without a handler of the crate's; one call brings all back
/// on a device of another instance, and what it was not given is refused there.
#[test]
fn one_call_brings_all_back() {
    let [lost, second] = [new_device(), new_device()];
    let is_heard = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    let to = is_heard.clone();
    lost.device().set_device_lost_callback(move |_, _| to.store(true, std::sync::atomic::Ordering::Relaxed));
    let mut whole = Whole::new(&lost);
    let mut shadow = SunShadow::new(&mut whole.world.scene, 256).expect("a shadow");
    let frames = [Frame::plain(&lost, SIZE), Frame::plain(&second, SIZE)];
    let mut renderer = frames[0].renderer(&lost, &whole.world.scene);
    let mut forgotten = frames[0].renderer(&lost, &whole.world.scene);
    let shot = |whole: &mut Whole, shadow: &mut SunShadow, renderer: &Renderer, frame: &Frame| {
        let Whole { world: World { scene, .. }, view, .. } = whole;
        shadow.fit(scene, &mut [view], 60.0).expect("fitted");
        let gpu = scene.gpu().clone();
        let mut encoder = gpu.encoder("frame");
        scene.record(&mut encoder, &mut [view, shadow.view()]).expect("recorded");
        shadow.draw(&mut encoder, scene).expect("drawn");
        frame.pass(&mut encoder, |pass| renderer.draw(pass, scene, view, Layer::Color).expect("drawn"));
        gpu.queue().submit([encoder.finish()]);
        frame.read(&gpu)
    };
    let before = shot(&mut whole, &mut shadow, &renderer, &frames[0]);
    assert!(whole.world.scene.health().is_ok() && lost.check().is_ok());
    lost.device().destroy();
    let is_lost = |error: Error| matches!(error, Error::Gpu(GpuError::DeviceLost { .. }));
    let scene = &mut whole.world.scene;
    assert!(
        is_lost(scene.health().expect_err("lost").into()) && is_lost(lost.check().expect_err("lost").into())
    );
    assert!(is_lost(scene.add_mesh(&model(), 1).expect_err("lost")));
    assert!(is_lost(scene.view(Quality::default()).expect_err("lost")));
    assert!(is_lost(SunShadow::new(scene, 64).expect_err("lost")));
    assert!(is_lost(Renderer::new(&lost, &frames[0].format).expect_err("lost")));
    assert!(is_lost(scene.record(&mut second.encoder("frame"), &mut [&mut whole.view]).expect_err("lost")));
    let _ = lost.device().poll(wgpu::PollType::Poll);
    assert!(is_heard.load(std::sync::atomic::Ordering::Relaxed), "the program's own callback was replaced");
    scene.rebuild_all(&second, &mut [&mut whole.view, &mut shadow, &mut renderer]).expect("rebuilt");
    assert!(shot(&mut whole, &mut shadow, &renderer, &frames[1]) == before, "another picture");
    let scene = &whole.world.scene;
    let refused = forgotten.prepare(scene).expect_err("of the lost device").to_string();
    assert!(refused.contains("another device") && refused.contains("rebuild"), "{refused}");
    // A part that cannot be rebuilt is told by its number.
    let layout = lost_layout(&second);
    let shaded = Renderer::new(&second, &frames[1].format).expect("a format");
    let mut shaded = shaded.with_shading(SHADING, Some(&layout)).expect("valid");
    let refused = whole.world.scene.rebuild_all(&second, &mut [&mut whole.view, &mut shaded]);
    let refused = refused.expect_err("a layout of the lost device").to_string();
    assert!(refused.starts_with("parts[1].shading.layout = "), "{refused}");
    shaded.rebuild_with_layout(&second, &layout).expect("rebuilt");
    shaded.prepare(&whole.world.scene).expect("of the new device");
}

/// Materials that were changed are as they were on another device: what cuts out still does.
#[test]
fn changed_materials_outlive_a_device() {
    let [first, second] = devices();
    first.device().on_uncaptured_error(std::sync::Arc::new(|_| ()));
    let mut world = World::new(&first, 1);
    let rock = relievo_samples::rock().expect("valid");
    let object = world.scene.add_mesh(&rock, 1).expect("added");
    world.scene.spawn(object, Placement::at([0.0, 5.0, 0.0]).scaled(4.0)).expect("room");
    let mut view = world.view(1.0);
    let frame = Frame::plain(&first, SIZE);
    let mut renderer = frame.renderer(&first, &world.scene);
    let opaque = frame.shot(&mut world.scene, &mut view, &renderer);
    let material = world.scene.material(object, "0").expect("a material").clone();
    let half = Material { color: [0.5, 0.5, 0.5, 0.3], alpha: Alpha::Dithered, ..material };
    world.scene.set_material(object, "0", &half).expect("changed");
    renderer.prepare(&world.scene).expect("compiled");
    let before = frame.shot(&mut world.scene, &mut view, &renderer);
    assert!(before != opaque, "the rock is opaque");
    world.scene.rebuild_all(&second, &mut [&mut view, &mut renderer]).expect("rebuilt");
    let frame = Frame::plain(&second, SIZE);
    assert!(frame.shot(&mut world.scene, &mut view, &renderer) == before, "another picture");
}

/// A shading that binds nothing.
const SHADING: &str = "fn shade(surface: Surface, view: View) -> vec4<f32> { return vec4<f32>(1.0); }";

fn lost_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &[] })
}

/// A device without memory refuses what needs some, and the scene goes on as before: then with memory, as if nothing had
/// happened.
#[test]
fn a_scene_survives_the_end_of_memory() {
    let gpu = new_device();
    let mut world = World::empty(&gpu, 64);
    let mut view = world.view(0.5);
    let frame = Frame::plain(&gpu, SIZE);
    let shot = |world: &mut World, view: &mut View| {
        let renderer = frame.renderer(&gpu, &world.scene);
        frame.shot(&mut world.scene, view, &renderer)
    };
    (0..64).for_each(|at| {
        world.spawn(at % 10);
    });
    let before = shot(&mut world, &mut view);
    let memory = gpu.memory().clone();
    memory.set_limit(memory.now());
    let refused = |result: Result<ObjectId, relievo::Error>| result.expect_err("refused").to_string();
    assert!(refused(world.scene.add_mesh(&model(), 3)).contains("no memory left"));
    assert!(refused(world.scene.add_character(&model(), 3)).contains("no memory left"));
    // No room to grow, in the middle of what growing takes too.
    let placement = world.placement(3);
    for further in [0, 100_000, 1_000_000, 4_000_000] {
        memory.set_limit(memory.now() + further);
        let refused = world.scene.spawn(world.creature, placement).expect_err("refused").to_string();
        assert!(refused.contains("no memory left"), "{refused}");
        memory.set_limit(u64::MAX);
        assert!(shot(&mut world, &mut view) == before, "another picture after {further} bytes");
    }
    assert_eq!(world.scene.instances(world.creature).expect("there").len(), 64);
    world.spawn(11);
    let grown = shot(&mut world, &mut view);
    let mut large = World::empty(&gpu, 128);
    (0..64).for_each(|at| {
        large.spawn(at % 10);
    });
    large.spawn(11);
    let mut fresh = large.view(0.5);
    assert!(shot(&mut large, &mut fresh) == grown, "another picture than with enough room");
    // A view that needs more pages than there is memory for.
    let mut near = world.view(8.0);
    let record = |world: &mut World, near: &mut View| {
        let mut encoder = gpu.encoder("frame");
        let recorded = world.scene.record(&mut encoder, &mut [near]);
        gpu.queue().submit([encoder.finish()]);
        recorded
    };
    record(&mut world, &mut near).expect("recorded");
    memory.set_limit(memory.now());
    near.set_quality(Quality::pixels(0.0)).expect("a quality");
    record(&mut world, &mut near).expect("coarser, but recorded");
    assert!(world.scene.lod_bias(world.creature).expect("there") > 1.0);
    memory.set_limit(u64::MAX);
    world.scene.refresh().expect("afresh");
    assert!(shot(&mut world, &mut view) == grown, "another picture afterwards");
    // A device whose limits are small says which.
    let small = crate::harness::gpu_of_bindings(1 << 16);
    let mut scene = relievo::scene::Scene::new(&small).expect("compiled");
    let refused = scene.add_character(&model(), 1000).expect_err("refused").to_string();
    assert!(refused.contains("maxStorageBufferBindingSize"), "{refused}");
    assert!(scene.add_mesh(&relievo::asset::Model { meshes: Vec::new(), ..model() }, 1).is_err());
}

/// What is awaited while a device is replaced may move to another thread.
#[test]
fn a_rebuild_may_move_to_another_thread() {
    fn moves<T: Send>(_: T) {}
    let gpu = new_device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    moves(scene.rebuild_async(&gpu));
}
