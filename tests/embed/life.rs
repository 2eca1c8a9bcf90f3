//! Instances that come and go: handles, growth, and long lives.

use relievo::render::Layer;
use relievo::scene::{Camera, InstanceId, Placement, Play, Quality, View};

use crate::frame::{Frame, new_device};
use crate::harness::Difference;
use crate::host::Draw;
use crate::world::{SIZE, World, camera, model};

/// Frames of a long life; `RELIEVO_FRAMES` asks for more.
fn frames() -> u32 {
    std::env::var("RELIEVO_FRAMES").ok().and_then(|frames| frames.parse().ok()).unwrap_or(1000)
}

/// A handle names its instance alone: when that is gone, it names nothing, although its place is used again.
#[test]
fn stale_handles_are_errors() {
    let gpu = new_device();
    let mut world = World::new(&gpu, 3);
    let old = world.crowd[1];
    world.scene.despawn(old).expect("there");
    let new = world.spawn(1);
    assert_ne!(old, new);
    let path = |result: Result<(), relievo::InputError>| result.expect_err("refused").path;
    let scene = &mut world.scene;
    assert_eq!(path(scene.despawn(old)), "instance");
    assert_eq!(path(scene.move_to(old, Placement::default())), "instance");
    assert_eq!(path(scene.play(old, &Play::new("walk"))), "instance");
    assert_eq!(path(scene.set_tint(old, [1.0; 4])), "instance");
    assert_eq!(path(scene.set_user_data(old, 3)), "instance");
    assert_eq!(path(scene.set_visibility_mask(old, 1)), "instance");
    assert_eq!(scene.play(new, &Play::new("hop")).expect_err("refused").path, "play.clip");
    assert_eq!(scene.set_tint(new, [0.0, 2.0, 0.0, 1.0]).expect_err("refused").path, "tint[1]");
    scene.remove(world.creature).expect("there");
    assert_eq!(path(scene.despawn(new)), "instance");
    assert_eq!(path(scene.remove(world.creature)), "object");
    assert!(
        scene.spawn(world.land, Placement::default()).expect_err("refused").to_string().contains("terrain")
    );
}

/// Scenes, views and renderers may move to other threads and back, and draw the same there.
#[test]
fn scenes_move_between_threads() {
    let gpu = new_device();
    let (mut here, mut other) = (World::new(&gpu, 3), World::new(&gpu, 3));
    let (frame, views) = (Frame::plain(&gpu, SIZE), [here.view(1.0), other.view(1.0)]);
    let renderers = [&here, &other].map(|world| frame.renderer(&gpu, &world.scene));
    let shots = |world: &mut World, view: &mut View, renderer: &relievo::render::Renderer| {
        [0.0, 0.3, 0.2].map(|seconds| {
            world.scene.advance(seconds).expect("finite");
            frame.shot(&mut world.scene, view, renderer)
        })
    };
    let ([mut mine, mut view], [own, renderer]) = (views, renderers);
    let expected = shots(&mut here, &mut mine, &own);
    assert!(expected[0] != expected[1] && expected[1] != expected[2], "nothing moves");
    let moved = std::thread::scope(|scope| {
        let drawn = scope.spawn(|| {
            let found = shots(&mut other, &mut view, &renderer);
            (found, other, view, renderer)
        });
        drawn.join()
    });
    let (found, mut other, mut view, renderer) = moved.expect("drawn");
    assert!(found == expected, "another thread draws another picture");
    // And back again.
    let [back, here] = [shots(&mut other, &mut view, &renderer), shots(&mut here, &mut mine, &own)];
    assert!(back == here, "what came back draws another picture");
}

/// Objects grow between frames that are recorded and not yet submitted: each frame shows what there was when it was
/// recorded, and equals that of a scene with enough room, whose frames are submitted one by one.
#[test]
fn objects_grow_in_flight() {
    let gpu = new_device();
    let (mut small, mut large) = (World::empty(&gpu, 1), World::empty(&gpu, 200));
    let frames = [Frame::plain(&gpu, SIZE), Frame::plain(&gpu, SIZE), Frame::plain(&gpu, SIZE)];
    let renderers = [&small, &large].map(|world| frames[0].renderer(&gpu, &world.scene));
    let mut views = [small.view(0.0), large.view(0.0)];
    let (mut encoders, mut held, mut expected) = (Vec::new(), Vec::new(), Vec::new());
    // Blocks hold 64 instances: there are one, two, and then three.
    for (frame, count) in frames.iter().zip([60, 120, 190]) {
        held.push(gpu.memory().now());
        next_row(&mut small, count);
        let mut encoder = gpu.encoder("in flight");
        small.scene.record(&mut encoder, &mut [&mut views[0]]).expect("recorded");
        frame.pass(&mut encoder, |pass| {
            renderers[0].draw(pass, &small.scene, &views[0], Layer::Color).expect("drawn");
        });
        encoders.push(encoder);
    }
    assert!(held[1] < held[2] && held[2] < gpu.memory().now(), "nothing grows: {held:?}");
    encoders.into_iter().for_each(|encoder| {
        gpu.queue().submit([encoder.finish()]);
    });
    let found = frames.each_ref().map(|frame| frame.read(&gpu));
    for count in [60, 120, 190] {
        next_row(&mut large, count);
        expected.push(frames[0].shot(&mut large.scene, &mut views[1], &renderers[1]));
    }
    for (at, (found, expected)) in found.iter().zip(&expected).enumerate() {
        println!("frame {at}: {:?}", Difference::of(found, expected, 0));
        assert!(found == expected, "frame {at}: another picture");
    }
    for at in [1, 2] {
        let difference = Difference::of(&found[at - 1], &found[at], 3);
        assert!(difference.outliers > 0.01, "frame {at} shows little more: {difference:?}");
    }
}

/// Spawns creatures until there are so many, on a wall of them in front of the camera; time goes on, and one of those that
/// are there moves.
fn next_row(world: &mut World, count: usize) {
    let place = |at: usize| {
        let (column, row) = ((at % 20) as f32, (at / 20) as f32);
        Placement::at([column - 9.5, 1.5 + 1.1 * row, -12.0 - 0.3 * row]).turned(0.7 * at as f32)
    };
    if let Some(first) = world.crowd.first().copied() {
        world.scene.move_to(first, place(count).scaled(2.0)).expect("there");
    }
    world.scene.advance(0.25).expect("finite");
    for at in world.crowd.len()..count {
        let instance = world.scene.spawn(world.creature, place(at)).expect("room");
        let play = Play { start: World::start(at), ..Play::new("walk") };
        world.scene.play(instance, &play).expect("the clip");
        world.crowd.push(instance);
    }
}

/// After frames of spawning, moving and despawning under two views, nothing has grown, and the picture in full detail after
/// `refresh` is that of a fresh scene.
#[test]
fn a_long_life_leaves_no_trace() {
    let gpu = new_device();
    let mut world = World::new(&gpu, 24);
    let frame = Frame::plain(&gpu, SIZE);
    let mut views = [world.view(1.0), world.view(4.0)];
    let mut shown: Vec<Option<usize>> = (0..24).map(|at| Some(at % 15)).collect();
    shown.iter().zip(world.crowd.clone()).for_each(|(at, id)| put(&mut world, id, at.expect("there")));
    let (mut draw, mut held) = (Draw(7), 0);
    for at in 0..frames() {
        change(&mut world, &mut shown, &mut draw, at);
        let eye = camera(SIZE);
        let turned = glam::Mat4::from_rotation_y(0.02 * at as f32);
        views[1].set(Camera { view_from_cell: eye.view_from_cell * turned, ..eye }).expect("a camera");
        let mut encoder = gpu.encoder("frame");
        let [a, b] = &mut views;
        world.scene.record(&mut encoder, &mut [a, b]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("done");
        if at == frames() / 10 {
            held = gpu.memory().now();
        }
    }
    assert_eq!(gpu.memory().now(), held, "memory grows");
    let full = |world: &mut World, view: &mut View| {
        view.set_quality(Quality::pixels(0.0)).expect("a quality");
        let renderer = frame.renderer(&gpu, &world.scene);
        frame.shot(&mut world.scene, view, &renderer)
    };
    let kept = full(&mut world, &mut views[0]);
    world.scene.refresh().expect("afresh");
    let refreshed = full(&mut world, &mut views[0]);
    let mut fresh = World::empty(&gpu, 24);
    // The same time to the bit, in two summands.
    let time = world.scene.time();
    for seconds in [time as f32, (time - f64::from(time as f32)) as f32] {
        fresh.scene.advance(seconds).expect("finite");
    }
    assert!(fresh.scene.time() == time, "{time}");
    shown.iter().flatten().for_each(|at| {
        fresh.spawn(*at);
    });
    let mut view = fresh.view(0.0);
    assert!(full(&mut fresh, &mut view) == refreshed, "another picture than a fresh scene");
    // Without a refresh all that differs is the order in which rounding errors came.
    let difference = Difference::of(&kept, &refreshed, 1);
    assert!(difference.outliers < 0.01, "{difference:?}");
}

/// Changes a frame of a long life: an instance comes or goes, another moves, and now and then an object comes and goes.
/// `shown` says where in the grid each instance stands.
fn change(world: &mut World, shown: &mut [Option<usize>], draw: &mut Draw, at: u32) {
    let index = draw.below(shown.len());
    match shown[index].take() {
        Some(_) => world.scene.despawn(world.crowd[index]).expect("there"),
        None => {
            let place = draw.below(15);
            shown[index] = Some(place);
            world.crowd[index] = world.spawn(place);
        }
    }
    let moved = draw.below(shown.len());
    if shown[moved].is_some() {
        let place = draw.below(15);
        shown[moved] = Some(place);
        put(world, world.crowd[moved], place);
    }
    if at % 97 == 50 {
        let object = world.scene.add_mesh(&model(), 3).expect("added");
        world.scene.spawn(object, Placement::default()).expect("room");
        world.scene.remove(object).expect("there");
    }
    // Every few seconds starts are counted from a later moment: more than two minutes pass in any case.
    world.scene.advance(if at % 8 == 3 { 1.25 } else { 1.0 / 60.0 }).expect("finite");
}

/// Moves an instance to place `at` of the grid, and lets it play what is played there.
fn put(world: &mut World, instance: InstanceId, at: usize) {
    let placement = world.placement(at);
    world.scene.move_to(instance, placement).expect("there");
    let play = Play { start: World::start(at), ..Play::new("walk") };
    world.scene.play(instance, &play).expect("the clip");
}

/// Memory for vertices follows what is seen, and the picture does not tell: an object with room for many instances, whose
/// pages grow as the camera comes near, shows what a fresh scene shows, whose pages are all dealt out in its first frame.
#[test]
fn pages_follow_what_is_seen() {
    let gpu = new_device();
    let crowd = || {
        let mut world = World::empty(&gpu, 320);
        (0..60).for_each(|at| {
            world.spawn(at % 15);
        });
        world
    };
    let mut world = crowd();
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let mut view = world.view(0.05);
    let mut held = Vec::new();
    for distance in [300.0, 60.0, 14.0, 200.0] {
        let eye = glam::Vec3::new(0.0, 0.3, 1.0) * distance;
        let camera = Camera::looking_at(eye, glam::Vec3::ZERO, 0.6, [0.5, 900.0], SIZE);
        view.set(camera).expect("a camera");
        world.scene.advance(0.125).expect("finite");
        let kept = frame.shot(&mut world.scene, &mut view, &renderer);
        held.push(gpu.memory().now());
        let mut fresh = crowd();
        let renderer = frame.renderer(&gpu, &fresh.scene);
        let mut first = fresh.view(0.05);
        first.set(camera).expect("a camera");
        fresh.scene.advance(world.scene.time() as f32).expect("finite");
        let shown = frame.shot(&mut fresh.scene, &mut first, &renderer);
        // Bones that the gate holds back may be elsewhere, by less than a pixel.
        let difference = Difference::of(&kept, &shown, 3);
        assert!(difference.outliers < 0.01 && difference.flip < 0.01, "{distance}: {difference:?}");
    }
    println!("bytes while the camera comes near: {held:?}");
    // 320 instances in full detail would take 68 MB of pages.
    assert!(held[2] > held[1] + 1_000_000, "no page was added: {held:?}");
    assert!(held[2] < held[0] + 30_000_000, "more pages than are seen: {held:?}");
}

/// The host writes what has changed and not what there is.
#[test]
fn frames_upload_changes_alone() {
    let gpu = new_device();
    let mut world = World::empty(&gpu, 1000);
    world.crowd = (0..1000).map(|at| world.spawn(at % 15)).collect();
    let mut view = world.view(1.0);
    let mut record = |world: &mut World, moved: usize| {
        for at in 0..moved {
            let placement = world.placement(at % 15);
            // Far from each other in the buffer.
            world.scene.move_to(world.crowd[(37 * at) % 1000], placement).expect("there");
        }
        world.scene.advance(1.0 / 60.0).expect("finite");
        let mut encoder = gpu.encoder("frame");
        world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("done");
        world.scene.uploaded()
    };
    let first = record(&mut world, 0);
    let [still, one, twenty] = [0, 1, 20].map(|moved| record(&mut world, moved));
    println!("bytes: first {first}, still {still}, one moved {one}, twenty {twenty}");
    assert!(first > 80_000 && still < 2_000, "{first}, {still}");
    assert_eq!((one - still, twenty - still), (80, 20 * 80));
}
