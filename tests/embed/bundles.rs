//! A scene in a render bundle of the program.

use glam::Vec3;
use relievo::gpu::Gpu;
use relievo::render::{Layer, Renderer};
use relievo::scene::{Camera, FRAMES_IN_FLIGHT, View};
use relievo::wgpu;

use crate::frame::{COLOR, Frame, device};
use crate::harness::Difference;
use crate::world::{SIZE, World};

/// A bundle of the scene's colours.
fn bundle(gpu: &Gpu, renderer: &Renderer, world: &World, view: &View) -> wgpu::RenderBundle {
    let mut encoder = gpu.device().create_render_bundle_encoder(&wgpu::RenderBundleEncoderDescriptor {
        label: Some("the program's bundle"),
        color_formats: &[Some(COLOR)],
        depth_stencil: renderer.format().depth.map(|depth| wgpu::RenderBundleDepthStencil {
            format: depth.format,
            depth_read_only: false,
            stencil_read_only: false,
        }),
        sample_count: 1,
        multiview: None,
    });
    renderer.draw(&mut encoder, &world.scene, view, Layer::Color).expect("drawn");
    encoder.finish(&wgpu::RenderBundleDescriptor::default())
}

/// A camera that goes around the crowd.
fn around(at: usize) -> Camera {
    let eye = Vec3::new(18.0 - 7.0 * at as f32, 9.0 + at as f32, 15.0);
    Camera::looking_at(eye, Vec3::new(0.0, 2.0, -4.0), 0.9, [0.5, 400.0], SIZE)
}

/// A bundle that is made once shows what every later recording shows: other cameras, poses, places and instances, over more
/// frames than may be recorded at once.
#[test]
fn a_bundle_shows_later_recordings() {
    let gpu = device();
    let mut world = World::new(&gpu, 10);
    let mut view = world.view(1.0);
    let frames = [Frame::plain(&gpu, SIZE), Frame::plain(&gpu, SIZE)];
    let renderer = frames[0].renderer(&gpu, &world.scene);
    let mut last = frames[0].shot(&mut world.scene, &mut view, &renderer);
    let bundle = bundle(&gpu, &renderer, &world, &view);
    for at in 0..FRAMES_IN_FLIGHT + 2 {
        view.set(around(at)).expect("a camera");
        world.scene.advance(0.2).expect("finite");
        world.scene.move_to(world.crowd[at], world.placement(10 + at)).expect("there");
        if at == 2 {
            world.scene.despawn(world.crowd[9]).expect("there");
        }
        let mut encoder = gpu.encoder("bundle");
        world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
        frames[0].pass(&mut encoder, |pass| pass.execute_bundles([&bundle]));
        frames[1].pass(&mut encoder, |pass| {
            renderer.draw(pass, &world.scene, &view, Layer::Color).expect("drawn");
        });
        gpu.queue().submit([encoder.finish()]);
        let [found, expected] = frames.each_ref().map(|frame| frame.read(&gpu));
        assert!(found == expected, "frame {at}: another picture");
        let difference = Difference::of(&found, &last, 3);
        assert!(difference.outliers > 0.1, "frame {at} is the one before: {difference:?}");
        last = found;
    }
}
