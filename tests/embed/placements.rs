//! Placements of every kind: far away, mirrored, scaled.

use glam::{Mat4, Quat, Vec3};
use image::RgbaImage;
use relievo::scene::{Camera, Placement, Quality, Scene};

use crate::frame::{Frame, device};
use crate::harness::{Difference, Tolerance};
use crate::targets::coverage;
use crate::world::{SIZE, model};

/// Two creatures in a picture, placed relative to a cell.
fn shot(gpu: &relievo::gpu::Gpu, cell: [i32; 3], mirror: bool) -> RgbaImage {
    let mut scene = Scene::new(gpu).expect("compiled");
    let creature = scene.add_character(&model(), 2).expect("added");
    for (at, x) in [(0.25, -1.5), (1.0, 1.5)] {
        let scale = Vec3::new(if mirror { -1.0 } else { 1.0 }, 1.0, 1.0);
        let placement = Placement {
            cell,
            offset: Vec3::new(if mirror { -x } else { x }, 0.0, 0.0),
            scale,
            ..Default::default()
        };
        let angle = if mirror { -at } else { at };
        scene.spawn(creature, placement.turned(angle)).expect("room");
    }
    scene.advance(0.4).expect("finite");
    let mut camera =
        Camera::looking_at(Vec3::new(0.0, 2.5, 9.0), Vec3::new(0.0, 1.5, 0.0), 0.6, [0.5, 60.0], SIZE);
    camera.cell = cell;
    if mirror {
        camera.view_from_cell *= Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    }
    let mut light = relievo::asset::Light::default();
    if mirror {
        light.direction.x = -light.direction.x;
    }
    scene.set_light(light).expect("a light");
    let mut view = scene.view(Quality::pixels(0.5)).expect("a view");
    view.set(camera).expect("a camera");
    let frame = Frame::plain(gpu, SIZE);
    let renderer = frame.renderer(gpu, &scene);
    frame.shot(&mut scene, &mut view, &renderer)
}

/// A million kilometres away the picture is the same, bit for bit: nothing shakes.
#[test]
fn far_from_the_origin_nothing_shakes() {
    let gpu = device();
    let near = shot(&gpu, [0; 3], false);
    assert!(coverage(&near) > 0.02);
    assert!(shot(&gpu, [3_906_250, 0, -3_906_250], false) == near, "another picture far away");
}

/// A mirrored scene in a mirrored view is the scene.
#[test]
fn mirrored_instances_show_their_outside() {
    let gpu = device();
    let plain = shot(&gpu, [0; 3], false);
    let mirrored = shot(&gpu, [0; 3], true);
    let difference = Difference::of(&mirrored, &plain, 1);
    assert!(difference.within(Tolerance { levels: 1, outliers: 0.01, flip: 0.005 }), "{difference:?}");
}

/// The scale of a placement and the distance of the eye cancel out.
#[test]
fn scale_counts() {
    let gpu = device();
    let shot = |scale: f32| {
        let mut scene = Scene::new(&gpu).expect("compiled");
        let creature = scene.add_character(&model(), 1).expect("added");
        let placement = Placement { turn: Quat::from_rotation_y(0.6), ..Placement::default().scaled(scale) };
        scene.spawn(creature, placement).expect("room");
        let mut view = scene.view(Quality::pixels(1.0)).expect("a view");
        let eye = Vec3::new(0.0, 2.5, 12.0) * scale;
        let planes = [0.5 * scale, 60.0 * scale];
        view.set(Camera::looking_at(eye, Vec3::new(0.0, 1.5, 0.0) * scale, 0.6, planes, SIZE))
            .expect("a camera");
        let frame = Frame::plain(&gpu, SIZE);
        let renderer = frame.renderer(&gpu, &scene);
        frame.shot(&mut scene, &mut view, &renderer)
    };
    let one = shot(1.0);
    assert!(coverage(&one) > 0.005);
    for scale in [8.0, 0.125] {
        let difference = Difference::of(&shot(scale), &one, 1);
        assert!(difference.outliers < 0.002, "scale {scale}: {difference:?}");
    }
}
