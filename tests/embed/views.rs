//! Several views in one frame, and several frames in one submission.

use glam::Vec3;
use relievo::render::{Layer, Renderer, TargetFormat};
use relievo::scene::{Camera, Placement, Quality, View};
use relievo::wgpu;

use crate::frame::{Frame, device};
use crate::world::{SIZE, World, camera};

/// From the side.
fn aside() -> Camera {
    Camera::looking_at(Vec3::new(-20.0, 8.0, -4.0), Vec3::new(0.0, 2.0, -6.0), 0.7, [0.5, 300.0], SIZE)
}

/// Two views in one submission equal two submissions.
#[test]
fn two_views_in_one_frame_are_two_pictures() {
    let gpu = device();
    let (mut world, mut alone) = (World::new(&gpu, 10), World::new(&gpu, 10));
    let frames = [Frame::plain(&gpu, SIZE), Frame::plain(&gpu, SIZE)];
    let renderer = frames[0].renderer(&gpu, &world.scene);
    // Full detail, so that a view's picture does not depend on what the other one needs.
    let mut views = [world.view(0.0), world.view(0.0)];
    views[1].set(aside()).expect("a camera");
    let mut encoder = gpu.encoder("split");
    {
        let [a, b] = &mut views;
        world.scene.record(&mut encoder, &mut [a, b]).expect("recorded");
    }
    for (frame, view) in frames.iter().zip(&views) {
        frame.pass(&mut encoder, |pass| {
            renderer.draw(pass, &world.scene, view, Layer::Color).expect("drawn");
        });
    }
    gpu.queue().submit([encoder.finish()]);
    let together = frames.each_ref().map(|frame| frame.read(&gpu));
    let renderer = frames[0].renderer(&gpu, &alone.scene);
    let mut apart = alone.view(0.0);
    for (camera, together) in [camera(SIZE), aside()].into_iter().zip(&together) {
        apart.set(camera).expect("a camera");
        let picture = frames[0].shot(&mut alone.scene, &mut apart, &renderer);
        assert!(&picture == together, "another picture together");
    }
    assert!(together[0] != together[1], "one camera for both");
}

/// Two frames that are recorded before either is submitted are two frames.
#[test]
fn two_frames_in_one_submission_are_two_frames() {
    let gpu = device();
    let (mut world, mut alone) = (World::new(&gpu, 6), World::new(&gpu, 6));
    let frames = [Frame::plain(&gpu, SIZE), Frame::plain(&gpu, SIZE)];
    let renderer = frames[0].renderer(&gpu, &world.scene);
    let mut view = world.view(1.0);
    let mut encoder = gpu.encoder("two frames");
    for (at, frame) in frames.iter().enumerate() {
        change(&mut world, at);
        view.set(if at == 0 { camera(SIZE) } else { aside() }).expect("a camera");
        world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
        frame.pass(&mut encoder, |pass| {
            renderer.draw(pass, &world.scene, &view, Layer::Color).expect("drawn");
        });
    }
    gpu.queue().submit([encoder.finish()]);
    let together = frames.each_ref().map(|frame| frame.read(&gpu));
    let renderer = frames[0].renderer(&gpu, &alone.scene);
    let mut view = alone.view(1.0);
    for (at, together) in together.iter().enumerate() {
        change(&mut alone, at);
        view.set(if at == 0 { camera(SIZE) } else { aside() }).expect("a camera");
        assert!(&frames[0].shot(&mut alone.scene, &mut view, &renderer) == together, "frame {at}");
    }
}

fn change(world: &mut World, at: usize) {
    world.scene.advance(0.1).expect("finite");
    if at == 1 {
        world.scene.despawn(world.crowd[2]).expect("there");
        world.spawn(7);
    }
}

/// A fifth frame that is recorded before the first is submitted is refused; frames whose encoders were dropped are given
/// up by `invalidate`, and the next picture is right.
#[test]
fn the_ring_is_full_after_four_recordings() {
    let gpu = device();
    let mut world = World::new(&gpu, 4);
    let mut view = world.view(1.0);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let expected = frame.shot(&mut world.scene, &mut view, &renderer);
    let mut encoder = gpu.encoder("dropped");
    for _ in 0..relievo::scene::FRAMES_IN_FLIGHT {
        world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    }
    let fifth = world.scene.record(&mut encoder, &mut [&mut view]).expect_err("refused").to_string();
    assert!(fifth.contains("recordings") && fifth.contains("invalidate"), "{fifth}");
    drop(encoder);
    world.scene.invalidate().expect("afresh");
    assert!(frame.shot(&mut world.scene, &mut view, &renderer) == expected, "another picture");
}

/// What an encoder that is dropped should have told the device is told again by the next frame, which nobody has to ask for.
#[test]
fn dropped_encoders_are_harmless() {
    let gpu = device();
    let mut world = World::new(&gpu, 4);
    let mut view = world.view(1.0);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let mut before = frame.shot(&mut world.scene, &mut view, &renderer);
    for is_finished in [false, true] {
        let placement = world.scene.placement(world.crowd[0]).expect("there");
        let away = Placement { offset: placement.offset + Vec3::new(2.0, 1.0, 0.0), ..placement };
        world.scene.move_to(world.crowd[0], away).expect("there");
        let mut encoder = gpu.encoder("dropped");
        world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
        if is_finished {
            drop(encoder.finish())
        } else {
            drop(encoder)
        }
        let found = frame.shot(&mut world.scene, &mut view, &renderer);
        world.scene.refresh().expect("afresh");
        assert!(found == frame.shot(&mut world.scene, &mut view, &renderer), "the move is lost");
        assert!(found != before, "nothing has moved");
        before = found;
    }
}

/// A frame that the caller's own passes could not finish is not drawn, and the next one is whole, though its encoder was submitted.
#[test]
fn a_frame_that_failed_is_not_drawn() {
    let gpu = device();
    let mut world = World::new(&gpu, 4);
    let mut view = world.view(1.0);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let before = frame.shot(&mut world.scene, &mut view, &renderer);
    world.scene.advance(0.3).expect("finite");
    let mut encoder = gpu.encoder("failed");
    let failure = || relievo::InputError::new("solver", 0, "must converge");
    let failed = world.scene.record_with(&mut encoder, &mut [&mut view], |_, _| Err(failure()));
    assert!(failed.expect_err("told").to_string().contains("solver"));
    frame.pass(&mut encoder, |pass| {
        let drawn = renderer.draw(pass, &world.scene, &view, Layer::Color);
        assert_eq!(drawn.expect_err("refused").value, "left out of the last frame");
    });
    gpu.queue().submit([encoder.finish()]);
    let found = frame.shot(&mut world.scene, &mut view, &renderer);
    world.scene.refresh().expect("afresh");
    assert!(found == frame.shot(&mut world.scene, &mut view, &renderer) && found != before);
}

/// A view that the last frame left out is not drawn, since its lists are those of an earlier frame; once it is recorded again it is.
#[test]
fn a_view_that_was_left_out_is_refused() {
    let gpu = device();
    let mut world = World::new(&gpu, 4);
    let mut views = [world.view(1.0), world.view(1.0)];
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let record = |world: &mut World, views: &mut [&mut View]| {
        let mut encoder = gpu.encoder("frame");
        world.scene.record(&mut encoder, views).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
    };
    let drawn = |world: &World, view: &View| {
        let (mut encoder, mut drawn) = (gpu.encoder("drawn"), Ok(()));
        frame.pass(&mut encoder, |pass| {
            drawn = [Layer::Color, Layer::Transparent]
                .into_iter()
                .try_for_each(|layer| renderer.draw(pass, &world.scene, view, layer));
        });
        drawn
    };
    let [one, other] = &mut views;
    record(&mut world, &mut [one, other]);
    assert_eq!((drawn(&world, one), drawn(&world, other)), (Ok(()), Ok(())));
    record(&mut world, &mut [one]);
    assert_eq!(drawn(&world, one), Ok(()));
    let refused = drawn(&world, other).expect_err("left out");
    assert_eq!((refused.path.as_str(), refused.value.as_str()), ("view", "left out of the last frame"));
    record(&mut world, &mut [other]);
    assert!(drawn(&world, other).is_ok() && drawn(&world, one).is_err());
}

/// A view of another scene, a view without a camera, and no view at all are refused.
#[test]
fn views_are_checked() {
    let gpu = device();
    let (mut world, other) = (World::new(&gpu, 1), World::new(&gpu, 1));
    let mut encoder = gpu.encoder("refused");
    let mut refused =
        |views: &mut [&mut View]| world.scene.record(&mut encoder, views).expect_err("refused").to_string();
    assert!(refused(&mut []).contains("views"));
    assert!(refused(&mut [&mut other.view(1.0)]).contains("views[0]"));
    let mut blind = world.scene.view(Quality::default()).expect("a view");
    let mut refused =
        |views: &mut [&mut View]| world.scene.record(&mut encoder, views).expect_err("refused").to_string();
    assert!(refused(&mut [&mut blind]).contains("camera"));
    let path = |quality: f32| other.scene.view(Quality::pixels(quality)).expect_err("refused").to_string();
    assert!(path(-1.0).contains("quality.pixels") && path(f32::NAN).contains("quality.pixels"));
}

/// The light of these tests: a parallel camera around the crowd.
fn light() -> Camera {
    let look =
        glam::camera::rh::view::look_at_mat4(Vec3::new(20.0, 60.0, 20.0), Vec3::new(0.0, 0.0, -6.0), Vec3::Y);
    let project = glam::camera::rh::proj::directx::orthographic(-14.0, 14.0, -14.0, 14.0, 1.0, 200.0);
    Camera { view_from_cell: look, clip_from_view: project, ..camera([256; 2]) }
}

/// The levels of detail of the light's view are those that the eye decides, and neither its own nor always the same.
#[test]
fn the_eye_decides_the_levels_of_the_light() {
    let gpu = device();
    let mut world = World::new(&gpu, 10);
    world.scene.set_statistics(true).expect("room");
    let (mut eye, mut sun) = (world.view(1.0), world.view(1.0));
    sun.set(light()).expect("a parallel camera");
    let looking = |distance: f32, viewport| {
        let from = Vec3::new(0.0, 0.5, 1.0) * distance;
        Camera::looking_at(from, Vec3::new(0.0, 2.0, -3.0), 1.0, [0.5, 900.0], viewport)
    };
    let (near, far) = (looking(20.0, [3840, 2560]), looking(300.0, SIZE));
    let (mut levels, creature) = (Vec::new(), world.creature);
    for (camera, decides) in [(near, true), (far, true), (near, false)] {
        eye.set(camera).expect("a camera");
        sun.set_lod_cameras(if decides { std::slice::from_ref(&camera) } else { &[] }).expect("a camera");
        let mut encoder = gpu.encoder("levels");
        world.scene.record(&mut encoder, &mut [&mut eye, &mut sun]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("done");
        let [of_eye, of_sun] = [&mut eye, &mut sun].map(|view| {
            let objects = &view.statistics().expect("arrived").objects;
            let found = objects.iter().find(|found| found.object == creature).expect("counted");
            found.levels.iter().map(|level| level.instances).collect::<Vec<_>>()
        });
        assert_eq!(of_eye.iter().sum::<u32>(), 10, "the eye sees all: {of_eye:?}");
        assert_eq!(of_eye == of_sun, decides, "the eye has {of_eye:?}, the light {of_sun:?}");
        levels.push(of_sun);
    }
    println!("levels near, far, and of the light itself: {levels:?}");
    assert!(levels[0] != levels[1] && levels[1] != levels[2], "the same levels: {levels:?}");
}

/// A shadow map of depth alone: what stands outside the eye's view casts there, and what does not cast is left out.
#[test]
fn casters_outside_the_view_are_in_the_shadow_map() {
    let gpu = device();
    let mut world = World::new(&gpu, 10);
    let mut eye = world.view(1.0);
    let away =
        Camera::looking_at(Vec3::new(0.0, 6.0, 40.0), Vec3::new(0.0, 6.0, 80.0), 0.6, [0.5, 300.0], SIZE);
    eye.set(away).expect("a camera");
    let mut sun = world.scene.view(Quality::default()).expect("a view");
    sun.set_casters_only(true);
    sun.set_lod_cameras(&[away]).expect("cameras");
    sun.set(light()).expect("a parallel camera");
    let depths = |world: &mut World, eye: &mut View, sun: &mut View| {
        let map = shadow_map(&gpu, world, eye, sun);
        map.iter().filter(|depth| **depth < 1.0).count()
    };
    world.scene.set_visible(world.land, false).expect("terrain");
    let all = depths(&mut world, &mut eye, &mut sun);
    assert!(all > 200, "{all} texels");
    for instance in world.crowd[..5].iter().copied() {
        world.scene.set_casts_shadow(instance, false).expect("there");
    }
    let half = depths(&mut world, &mut eye, &mut sun);
    assert!(half > 50 && half < 3 * all / 4, "{half} of {all}");
    sun.set_casters_only(false);
    assert_eq!(depths(&mut world, &mut eye, &mut sun), all);
}

/// Records a frame for both views, draws the sun's depth and reads it.
fn shadow_map(gpu: &relievo::gpu::Gpu, world: &mut World, eye: &mut View, sun: &mut View) -> Vec<f32> {
    const EDGE: u32 = 256;
    let size = wgpu::Extent3d { width: EDGE, height: EDGE, depth_or_array_layers: 1 };
    let map = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("the program's shadow map"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let mut renderer =
        Renderer::new(gpu, &TargetFormat::depth_only(wgpu::TextureFormat::Depth32Float)).expect("a format");
    renderer.prepare(&world.scene).expect("compiled");
    let read = relievo::gpu::Buffer::<f32>::new(gpu, "depths", (EDGE * EDGE) as usize).expect("room");
    let mut encoder = gpu.encoder("shadow");
    world.scene.record(&mut encoder, &mut [eye, sun]).expect("recorded");
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("the program's shadow pass"),
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &map.create_view(&wgpu::TextureViewDescriptor::default()),
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        renderer.draw(&mut pass, &world.scene, sun, Layer::Depth).expect("drawn");
    }
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo { aspect: wgpu::TextureAspect::DepthOnly, ..map.as_image_copy() },
        wgpu::TexelCopyBufferInfo {
            buffer: read.raw(),
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * EDGE),
                rows_per_image: None,
            },
        },
        size,
    );
    gpu.queue().submit([encoder.finish()]);
    read.read_blocking(gpu).expect("read")
}
