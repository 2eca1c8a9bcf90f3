//! Which side of triangles is seen, and how many draws that takes.

use glam::{Mat4, Vec3, Vec4};
use image::RgbaImage;
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::render::TargetFormat;
use relievo::scene::{Camera, Depth, Placement, Quality, Scene};

use crate::frame::{COLOR, Frame, device};
use crate::harness::{Difference, Tolerance};
use crate::solids::solid;
use crate::targets::coverage;
use crate::world::{SIZE, World};

/// A perspective or parallel camera, with forward or reversed depth.
fn camera(is_parallel: bool, is_reversed: bool) -> Camera {
    let mut camera = Camera::looking_at(Vec3::new(1.5, 1.0, 4.0), Vec3::ZERO, 0.7, [0.5, 20.0], SIZE);
    if is_parallel {
        let (wide, high) = (1.6 * SIZE[0] as f32 / SIZE[1] as f32, 1.6);
        camera.clip_from_view =
            glam::camera::rh::proj::directx::orthographic(-wide, wide, -high, high, 0.5, 20.0);
    }
    if is_reversed {
        // Depth becomes w − depth.
        let reverse = Mat4::from_cols(Vec4::X, Vec4::Y, -Vec4::Z, Vec4::new(0.0, 0.0, 1.0, 1.0));
        camera.clip_from_view = reverse * camera.clip_from_view;
        camera.depth = Depth::Reversed;
    }
    camera
}

fn shot(gpu: &Gpu, model: &Model, scale: Vec3, camera: Camera) -> RgbaImage {
    let mut scene = Scene::new(gpu).expect("compiled");
    let object = scene.add_mesh(model, 1).expect("added");
    scene.spawn(object, Placement { scale, ..Placement::default() }.turned(0.4)).expect("room");
    let mut view = scene.view(Quality::default()).expect("a view");
    view.set(camera).expect("a camera");
    let format = TargetFormat::new(COLOR);
    let format = if camera.depth == Depth::Reversed { format.reversed() } else { format };
    let frame = Frame::new(gpu, format, SIZE);
    let renderer = frame.renderer(gpu, &scene);
    frame.shot(&mut scene, &mut view, &renderer)
}

/// Faces that look away are left out, and no others, whatever the projection, the direction of depth and the placement: a
/// closed solid looks as if all of its faces were drawn, and a mirrored one as its mirror image.
#[test]
fn closed_solids_are_seen_from_outside() {
    let gpu = device();
    let tolerance = Tolerance { levels: 1, outliers: 0.002, flip: 0.002 };
    for is_parallel in [false, true] {
        let usual = camera(is_parallel, false);
        let pictures = [false, true].map(|mirrors| shot(&gpu, &solid(mirrors, true), Vec3::ONE, usual));
        assert!(coverage(&pictures[0]) > 0.05 && pictures[0] != pictures[1], "not much of a solid");
        for (is_reversed, is_mirrored) in [(false, false), (false, true), (true, false), (true, true)] {
            let name = format!("parallel {is_parallel}, reversed {is_reversed}, mirrored {is_mirrored}");
            let camera = camera(is_parallel, is_reversed);
            let scale = Vec3::new(if is_mirrored { -1.0 } else { 1.0 }, 1.0, 1.0);
            for double_sided in [false, true] {
                let picture = shot(&gpu, &solid(false, double_sided), scale, camera);
                let difference =
                    Difference::of(&picture, &pictures[usize::from(is_mirrored)], tolerance.levels);
                assert!(difference.within(tolerance), "{name}, both sides {double_sided}: {difference:?}");
            }
        }
    }
}

/// Mirrored instances have draws of their own only where there are some, and lose nothing when they come and go between
/// frames.
#[test]
fn mirrored_instances_have_draws_where_there_are_some() {
    let gpu = device();
    let mut world = World::new(&gpu, 6);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let mut view = world.view(1.0);
    let plain = world.scene.draws(world.creature).expect("there");
    let expected = frame.shot(&mut world.scene, &mut view, &renderer);
    assert!((1..=32).contains(&plain), "{plain} draws");
    assert_eq!(world.scene.draws(world.land).expect("there"), 1);
    let usual = world.placement(2);
    let mirrored = Placement { scale: Vec3::new(-1.0, 1.0, 1.0) * usual.scale, ..usual };
    world.scene.move_to(world.crowd[2], mirrored).expect("there");
    assert_eq!(world.scene.draws(world.creature).expect("there"), 2 * plain);
    let both = frame.shot(&mut world.scene, &mut view, &renderer);
    let hidden = {
        world.scene.set_visibility_mask(world.crowd[2], 0).expect("there");
        frame.shot(&mut world.scene, &mut view, &renderer)
    };
    assert!(both != expected && both != hidden, "the mirrored instance is not drawn");
    world.scene.set_visibility_mask(world.crowd[2], u16::MAX).expect("there");
    world.scene.move_to(world.crowd[2], usual).expect("there");
    assert_eq!(world.scene.draws(world.creature).expect("there"), plain);
    assert!(frame.shot(&mut world.scene, &mut view, &renderer) == expected, "another picture");
}

/// What is drawn is what was recorded, although an instance is mirrored and the camera set between recording and drawing.
#[test]
fn changes_after_recording_belong_to_the_next_frame() {
    let gpu = device();
    let mut world = World::new(&gpu, 3);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let mut view = world.view(1.0);
    let expected = frame.shot(&mut world.scene, &mut view, &renderer);
    let mut encoder = gpu.encoder("frame");
    world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    for at in 0..3 {
        let placement = world.placement(at);
        let scale = Vec3::new(1.0, 1.0, -1.0) * placement.scale;
        world.scene.move_to(world.crowd[at], Placement { scale, ..placement }).expect("there");
    }
    let usual = crate::world::camera(SIZE);
    let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    view.set(Camera { view_from_cell: usual.view_from_cell * mirror, ..usual }).expect("a camera");
    frame.pass(&mut encoder, |pass| {
        renderer.draw(pass, &world.scene, &view, relievo::render::Layer::Color).expect("drawn");
    });
    gpu.queue().submit([encoder.finish()]);
    assert!(frame.read(&gpu) == expected, "another picture");
}
