//! What a program may get wrong: each fault is refused by name, before wgpu sees it.

use relievo::InputError;
use relievo::asset::{Light, Model, Transform};
use relievo::gpu::{Gpu, GpuError};
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::{DepthFormat, Layer, Renderer, SunShadow, TargetFormat};
use relievo::scene::{Camera, Placement, Quality, Relief, Scene, TerrainSource};
use relievo::wgpu::{self, TextureFormat as Format};
use relievo_samples::maps::BuiltInMap;

use crate::frame::{COLOR, Frame, device, devices, new_device};
use crate::world::{SIZE, World, camera};

/// Path and value of what is wrong.
fn wrong<T>(result: Result<T, impl Into<relievo::Error>>) -> [String; 2] {
    match result.err().map(Into::into) {
        Some(relievo::Error::Input(InputError { path, value, .. })) => [path, value],
        Some(other) => panic!("no input error: {other}"),
        None => ["nothing".into(), String::new()],
    }
}

/// Handles of one scene name nothing in another, although the same slots are taken there.
#[test]
fn handles_of_another_scene_are_refused() {
    let gpu = device();
    let (one, mut other) = (World::new(&gpu, 2), World::new(&gpu, 2));
    let (object, instance, scene) = (one.creature, one.crowd[1], &mut other.scene);
    let own = other.crowd[1];
    let refused = [
        ("object", wrong(scene.spawn(object, Placement::default()))),
        ("object", wrong(scene.remove(object))),
        ("object", wrong(scene.set_visible(object, false))),
        ("object", wrong(scene.instances(object))),
        ("object", wrong(scene.lod_bias(object))),
        ("object", wrong(scene.ground(one.land, 0.0, 0.0))),
        ("instance", wrong(scene.despawn(instance))),
        ("instance", wrong(scene.move_to(instance, Placement::default()))),
        ("instance", wrong(scene.set_tint(instance, [1.0; 4]))),
        ("instance", wrong(scene.placement(instance))),
        ("instance", wrong(scene.clip_time(instance))),
        ("instance", wrong(scene.drive(instance, &["40"]))),
        ("mesh", wrong(scene.attach(instance, own, "40", Transform::IDENTITY))),
        ("character", wrong(scene.attach(own, instance, "40", Transform::IDENTITY))),
        ("mesh", wrong(scene.detach(instance))),
    ];
    for (at, (path, found)) in refused.iter().enumerate() {
        assert_eq!(*found, [*path, "of another scene"], "{at}");
    }
    assert_eq!(scene.instances(other.creature).expect("of this scene").len(), 2);
}

/// Patches of terrain stay where they are, since they would be drawn there anyway; they may be hidden.
#[test]
fn patches_of_terrain_stay() {
    let gpu = device();
    let mut world = World::new(&gpu, 1);
    let patch = world.scene.instances(world.land).expect("of this scene")[0];
    let scene = &mut world.scene;
    let refused = ["instance", "a patch of terrain"];
    assert_eq!(wrong(scene.move_to(patch, Placement::default())), refused);
    assert_eq!(wrong(scene.despawn(patch)), refused);
    assert_eq!(wrong(scene.set_tint(patch, [0.5; 4])), refused);
    scene.set_visibility_mask(patch, 0).expect("may be hidden");
    let twice = TerrainSource::new(TerrainConfig::new(33, 6.0, "twice").expect("valid"));
    let twice = twice.with_patches(&[[0, 0], [1, 0], [0, 0]]);
    assert_eq!(wrong(scene.add_terrain(&twice)), ["patches[2]", "[0, 0]"]);
}

/// A scene is drawn before anything is added, and after everything was removed: it shows nothing.
#[test]
fn an_empty_scene_shows_nothing() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let frame = Frame::plain(&gpu, SIZE);
    let mut view = scene.view(Quality::default()).expect("a view");
    let mut encoder = gpu.encoder("frame");
    assert_eq!(wrong(scene.record(&mut encoder, &mut [&mut view])), ["view.camera", "none"]);
    view.set(camera(SIZE)).expect("a camera");
    let renderer = frame.renderer(&gpu, &scene);
    let empty = frame.shot(&mut scene, &mut view, &renderer);
    assert!(empty.pixels().all(|pixel| pixel == empty.get_pixel(0, 0)), "something is drawn");
    let bricks = BuiltInMap::Bricks;
    let maps = (bricks.height_map(32).expect("heights"), bricks.albedo(32).expect("colours"));
    let wall = scene.add_relief(&Relief::wall(2.0, maps.0, maps.1), 1).expect("added");
    scene.spawn(wall, Placement::at([0.0, 2.0, -6.0]).scaled(8.0)).expect("room");
    let renderer = frame.renderer(&gpu, &scene);
    assert!(frame.shot(&mut scene, &mut view, &renderer) != empty, "no wall");
    scene.remove(wall).expect("there");
    assert!(frame.shot(&mut scene, &mut view, &renderer) == empty, "the wall is still there");
}

/// What changed between recording and drawing is said to have changed.
#[test]
fn a_view_is_out_of_date_once_objects_change() {
    let gpu = device();
    let mut world = World::new(&gpu, 1);
    let mut view = world.view(1.0);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let draw = |scene: &Scene, view: &relievo::scene::View| {
        let (mut encoder, mut found) = (gpu.encoder("frame"), [String::new(), String::new()]);
        frame.pass(&mut encoder, |pass| found = wrong(renderer.draw(pass, scene, view, Layer::Color)));
        gpu.queue().submit([encoder.finish()]);
        found
    };
    assert_eq!(draw(&world.scene, &view), ["view", "not recorded"]);
    let mut encoder = gpu.encoder("frame");
    world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    gpu.queue().submit([encoder.finish()]);
    assert_eq!(draw(&world.scene, &view), ["nothing", ""]);
    world.scene.remove(world.creature).expect("there");
    assert_eq!(draw(&world.scene, &view), ["view", "out of date"]);
}

/// A renderer draws scenes of its own device; wgpu would panic.
#[test]
fn a_scene_of_another_device_is_refused() {
    let [own, other] = devices();
    let mut world = World::new(&own, 1);
    let mut view = world.view(1.0);
    let frame = Frame::plain(&own, SIZE);
    let mut renderer = Renderer::new(&other, &frame.format).expect("a format");
    let refused = ["scene", "of another device"];
    assert_eq!(wrong(renderer.prepare(&world.scene)), refused);
    let mut encoder = own.encoder("frame");
    world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    frame.pass(&mut encoder, |pass| {
        assert_eq!(wrong(renderer.draw(pass, &world.scene, &view, Layer::Color)), refused);
    });
    own.queue().submit([encoder.finish()]);
    let same = Gpu::from_wgpu(own.device().clone(), own.queue().clone());
    Renderer::new(&same, &frame.format).expect("a format").prepare(&world.scene).expect("the same device");
}

/// Devices of two instances have equal handles, and wgpu panics where their resources meet.
#[test]
fn another_instance_is_refused() {
    let [own, other] = [new_device(), new_device()];
    assert!(own.device() == other.device(), "wgpu tells instances apart");
    let mut world = World::new(&own, 1);
    let mut view = world.view(1.0);
    let frame = Frame::plain(&own, SIZE);
    let mut foreign = Renderer::new(&other, &frame.format).expect("a format");
    assert_eq!(wrong(foreign.prepare(&world.scene)), ["scene", "of another device"]);
    let mut encoder = other.encoder("of another instance");
    let recorded = world.scene.record(&mut encoder, &mut [&mut view]);
    assert_eq!(wrong(recorded), ["encoder", "of another wgpu::Instance"]);
    let (driven, bone) = (world.crowd[0], 40);
    world.scene.drive(driven, &["40"]).expect("a bone");
    let mut dropped = own.encoder("dropped");
    let recorded = world.scene.record_with(&mut dropped, &mut [&mut view], |_, poses| {
        poses.write(&mut encoder, driven, bone, relievo::asset::Transform::IDENTITY)
    });
    assert_eq!(wrong(recorded), ["encoder", "of another wgpu::Instance"]);
    drop(dropped);
    let layout = (0..2000).map(|_| {
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: None, entries: &[] };
        other.device().create_bind_group_layout(&descriptor)
    });
    // One that has no namesake in the renderer's instance.
    let layouts: Vec<_> = layout.collect();
    let text = "fn shade(surface: Surface, view: View) -> vec4<f32> { return vec4<f32>(1.0); }";
    let shaded = Renderer::new(&own, &frame.format).expect("a format").with_shading(text, layouts.last());
    assert_eq!(wrong(shaded), ["shading.layout", "of another wgpu::Instance"]);
    drop(layouts);
    let theirs = Frame::plain(&other, SIZE);
    let mut shadow = SunShadow::new(&mut world.scene, 64).expect("a shadow");
    shadow.fit(&world.scene, &mut [&mut view], 60.0).expect("fitted");
    let renderer = frame.renderer(&own, &world.scene);
    let mut own_encoder = own.encoder("frame");
    world.scene.record(&mut own_encoder, &mut [&mut view, shadow.view()]).expect("recorded");
    assert_eq!(wrong(shadow.draw(&mut encoder, &world.scene)), ["encoder", "of another wgpu::Instance"]);
    theirs.pass(&mut encoder, |pass| {
        let drawn = renderer.draw(pass, &world.scene, &view, Layer::Color);
        assert_eq!(wrong(drawn), ["pass", "of another wgpu::Instance"]);
    });
    other.queue().submit([encoder.finish()]);
    shadow.draw(&mut own_encoder, &world.scene).expect("drawn");
    own.queue().submit([own_encoder.finish()]);
    let renderer = frame.renderer(&own, &world.scene);
    let mut encoder = own.encoder("frame");
    world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    frame.pass(&mut encoder, |pass| {
        let drawn = foreign.draw(pass, &world.scene, &view, Layer::Color);
        assert_eq!(wrong(drawn), ["scene", "of another device"]);
        renderer.draw(pass, &world.scene, &view, Layer::Color).expect("drawn");
    });
    own.queue().submit([encoder.finish()]);
}

/// A device with smaller limits than WebGPU's defaults is told by the limit, what is needed and what helps.
#[test]
fn small_limits_are_named() {
    let gpu = crate::frame::device_of(&wgpu::Limits::downlevel_defaults());
    for refused in [Scene::new(&gpu).map(|_| ()), Renderer::new(&gpu, &TargetFormat::new(COLOR)).map(|_| ())]
    {
        let refused = refused.expect_err("too small");
        let is_limit = matches!(refused, relievo::Error::Gpu(GpuError::Limit { needed, available, .. }) if needed > available);
        assert!(is_limit && refused.to_string().contains("wgpu::Limits::default()"), "{refused}");
    }
}

/// Places that are no numbers, and cameras that see nothing.
#[test]
fn what_is_no_place_and_no_camera_is_refused() {
    let gpu = device();
    let world = World::new(&gpu, 1);
    for (place, path) in [([f64::NAN, 0.0], "x"), ([0.0, f64::NAN], "z"), ([0.0, f64::INFINITY], "z")] {
        assert_eq!(wrong(world.scene.ground(world.land, place[0], place[1]))[0], path);
    }
    assert!(world.scene.ground(world.land, 1e300, 0.0).expect("a place").is_none());
    let mut view = world.view(1.0);
    let camera = |eye: glam::Vec3, field_of_view| {
        Camera::looking_at(eye, glam::Vec3::ONE, field_of_view, [0.1, 100.0], SIZE)
    };
    assert_eq!(wrong(view.set(camera(glam::Vec3::ZERO, 4.0))), ["camera.field_of_view", "4"]);
    assert_eq!(wrong(view.set(camera(glam::Vec3::ONE, 0.8))), ["camera.target", "[1, 1, 1]"]);
    assert_eq!(wrong(view.set(camera(glam::Vec3::NAN, 0.8))), ["camera.eye[0]", "NaN"]);
    let nowhere = glam::DVec3::NAN;
    assert_eq!(wrong(view.set(Camera::framing(nowhere, nowhere, SIZE))), ["camera.low[0]", "NaN"]);
    view.set(camera(glam::Vec3::ZERO, 0.8)).expect("a camera");
}

/// Formats that a device without features does not have are refused by field, not by the driver's compiler.
#[test]
fn formats_that_the_device_lacks_are_refused() {
    let gpu = device();
    let large = || Some(Format::Rgba32Float.into());
    let depth = |format| Some(DepthFormat { format, reversed: true });
    let blend = wgpu::ColorTargetState {
        blend: Some(wgpu::BlendState::ALPHA_BLENDING),
        ..Format::Rgba32Float.into()
    };
    let first = "format.color[0].format";
    let any = "wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES";
    for (format, path, feature) in [
        (TargetFormat::new(Format::Bc1RgbaUnorm), first, "wgpu::Features::TEXTURE_COMPRESSION_BC"),
        (TargetFormat::new(Format::Rgba16Unorm), first, "wgpu::Features::TEXTURE_FORMAT_16BIT_NORM"),
        (TargetFormat::new(Format::Rg11b10Ufloat), first, "wgpu::Features::RG11B10UFLOAT_RENDERABLE"),
        (TargetFormat::new(Format::Rgb9e5Ufloat), first, any),
        (TargetFormat::new(Format::Rgba32Float).with_samples(4), "format.samples", any),
        (
            TargetFormat::new(Format::Rgba32Float).with_color(large()).with_color(large()),
            "format.color",
            "limit",
        ),
        (
            TargetFormat { color: vec![Some(blend)], ..TargetFormat::new(COLOR) },
            "format.color[0].blend",
            "wgpu::Features::FLOAT32_BLENDABLE",
        ),
        (
            TargetFormat::new(COLOR).with_depth(depth(Format::Depth32FloatStencil8)),
            "format.depth.format",
            "wgpu::Features::DEPTH32FLOAT_STENCIL8",
        ),
    ] {
        match Renderer::new(&gpu, &format) {
            Err(relievo::Error::Input(error)) => {
                assert!(error.path == path && error.bound.contains(feature), "{format:?}: {error}");
            }
            other => panic!("{format:?}: {other:?}"),
        }
    }
    let world = World::new(&gpu, 1);
    for format in [
        TargetFormat::new(Format::Rgba32Float).with_color(large()),
        TargetFormat::new(Format::Rgba16Float).with_samples(4),
        TargetFormat::depth_only(Format::Depth16Unorm).with_samples(4),
    ] {
        Renderer::new(&gpu, &format).expect("a format").prepare(&world.scene).expect("compiled");
    }
}

/// A file that is no glTF, and light without a direction.
#[test]
fn what_is_no_model_and_no_light_is_refused() {
    let error = Model::from_gltf(b"v 1 2 3\n", None).expect_err("an OBJ");
    assert_eq!(error.path, "JSON");
    assert!(error.bound.contains("must be glTF"), "{error}");
    let mut scene = Scene::new(&device()).expect("compiled");
    let dark = Light { direction: glam::Vec3::ZERO, ..Light::default() };
    assert_eq!(wrong(scene.set_light(dark)), ["light.direction", "[0, 0, 0]"]);
}
