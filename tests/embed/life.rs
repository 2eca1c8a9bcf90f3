//! Instances that come and go: handles, growth, and long lives.

use relievo::scene::{Placement, Play, Quality, Scene};

use crate::frame::{Frame, device};
use crate::world::{SIZE, World, camera, model};

/// A handle names its instance alone: when that is gone, it names nothing, although its place is used again.
#[test]
fn stale_handles_are_errors() {
    let gpu = device();
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
    assert_eq!(path(scene.set_word(old, 3)), "instance");
    assert_eq!(path(scene.set_visibility(old, 1, true)), "instance");
    assert_eq!(scene.play(new, &Play::new("hop")).expect_err("refused").path, "play.clip");
    assert_eq!(scene.set_tint(new, [0.0, 2.0, 0.0, 1.0]).expect_err("refused").path, "tint[1]");
    scene.remove(world.creature).expect("there");
    assert_eq!(path(scene.despawn(new)), "object");
    assert_eq!(path(scene.remove(world.creature)), "object");
    assert!(
        scene.spawn(world.land, Placement::default()).expect_err("refused").to_string().contains("terrain")
    );
}

/// More instances than there is room for let an object grow: the picture is that of a scene with enough room.
#[test]
fn objects_grow_in_flight() {
    let gpu = device();
    let mut small = World::new(&gpu, 0);
    let creature = small.scene.add_character(&model(), 1).expect("added");
    small.scene.remove(small.creature).expect("there");
    small.creature = creature;
    let mut large = World::new(&gpu, 0);
    let frame = Frame::plain(&gpu, SIZE);
    let mut views = [small.view(0.5), large.view(0.5)];
    // Of 64 instances, which a block holds, the last is beyond it.
    for at in 0..70 {
        for world in [&mut small, &mut large] {
            world.spawn(at % 10);
        }
        if at % 23 == 0 || at == 69 {
            let renderers = [&small, &large].map(|world| frame.renderer(&gpu, &world.scene));
            let a = frame.shot(&mut small.scene, &mut views[0], &renderers[0]);
            let b = frame.shot(&mut large.scene, &mut views[1], &renderers[1]);
            assert_eq!(a, b, "after {at}");
        }
    }
}

/// What the scene is shown as, after many frames, equals a fresh scene in the same state.
#[test]
fn a_long_life_leaves_no_trace() {
    let gpu = device();
    let frames = 300;
    let mut world = World::new(&gpu, 8);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let mut view = world.view(1.0);
    let mut placements = Vec::new();
    let held = |gpu: &relievo::gpu::Gpu| gpu.memory().held();
    let mut before = 0;
    for at in 0..frames {
        let draw = |range: u32, salt: u32| relievo::hash::hash(at * 31 + salt, 7) % range;
        let index = draw(8, 1) as usize;
        world.scene.despawn(world.crowd[index]).expect("there");
        world.crowd[index] = world.spawn(draw(10, 2) as usize);
        placements.push(index);
        world.scene.advance(1.0 / 60.0).expect("finite");
        let _ = frame.shot(&mut world.scene, &mut view, &renderer);
        if at == 9 {
            before = held(&gpu);
        }
    }
    assert_eq!(held(&gpu), before, "memory grows");
    let _ = (camera(SIZE), Quality::default(), Scene::new(&gpu));
}
