//! Packages in scenes: the bounds of motion that they have.

use std::ops::ControlFlow;

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::ops::skinning::cook;
use relievo::scene::{Camera, Placement, Play, Quality, Scene};

use crate::frame::{Frame, device};
use crate::world::SIZE;

/// Five walkers, two of them partly outside the picture.
fn picture(gpu: &Gpu, model: &Model) -> RgbaImage {
    let mut scene = Scene::new(gpu).expect("a scene");
    let crowd = scene.add_character(model, 5).expect("added");
    for at in 0..5 {
        let place =
            Placement::at([3.0 * at as f32 - 6.0, 0.0, -8.0 * (at % 2) as f32]).turned(at as f32).scaled(2.0);
        let walker = scene.spawn(crowd, place).expect("room");
        scene.play(walker, &Play { start: -0.4 * f64::from(at), ..Play::new("walk") }).expect("a clip");
    }
    let frame = Frame::plain(gpu, SIZE);
    let renderer = frame.renderer(gpu, &scene);
    let mut view = scene.view(Quality::pixels(0.5)).expect("a view");
    let (eye, middle) = (Vec3::new(0.0, 2.0, 7.0), Vec3::new(0.0, 1.0, 0.0));
    view.set(Camera::looking_at(eye, middle, 0.9, [0.1, 100.0], SIZE)).expect("a camera");
    scene.advance(0.9).expect("finite");
    frame.shot(&mut scene, &mut view, &renderer)
}

/// A scene draws the same with the bounds of a package as with bounds that it computes, to the bit.
#[test]
fn stored_bounds_draw_the_same() {
    let gpu = device();
    let source = relievo_samples::creature().expect("valid");
    let bytes =
        cook(&source.into(), &mut |_| ControlFlow::Continue(())).expect("cooked").expect("not broken off");
    let mut model = Model::from_rlv(&bytes).expect("read");
    assert!(model.motion.is_some());
    let stored = picture(&gpu, &model);
    model.motion = None;
    assert!(stored == picture(&gpu, &model), "the bounds change the picture");
    let sky = *stored.get_pixel(0, 0);
    assert!(stored.pixels().filter(|pixel| **pixel != sky).count() > 300, "nobody is drawn");
}
