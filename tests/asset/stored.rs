//! Models stored with serde, and read again.

use glam::Vec3;
use image::{Rgba, RgbaImage};
use relievo::asset::material::{Alpha, Sampling, Texture};
use relievo::asset::morph::{MorphDelta, MorphTarget, WeightKeys};
use relievo::asset::{Interpolation, Material, Model};
use relievo::gpu::Gpu;
use relievo::ops::skinning::{Blend, InstanceLod, add_levels};
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{Camera, Placement, Play, Quality, Scene};
use relievo_lab::portrait::{Portrait, PosedModel};
use relievo_testing::gpu;
use serde_json::{Value, json};

/// The creature with levels of detail, a morph target, and a material with an image.
fn model() -> Model {
    let mut model = relievo_samples::creature().expect("valid");
    let texture = Texture { image: 0, sampling: Sampling::default() };
    let skin =
        Material { texture: Some(texture), alpha: Alpha::Mask(0.3), ..Material::opaque("skin", [0.9; 4]) };
    model.materials = vec![skin];
    model.images = vec![RgbaImage::from_fn(5, 3, |x, y| Rgba([50 * x as u8, 80 * y as u8, 7, 255])).into()];
    let mesh = &mut model.meshes[0];
    mesh.material = Some(0);
    let deltas = [0.01, -0.0, 1e-30].map(|x| MorphDelta { position: [x, 0.1, 0.0], ..MorphDelta::default() });
    mesh.targets = vec![MorphTarget { vertices: vec![3, 5, 8], deltas: deltas.to_vec() }];
    mesh.weights = vec![0.25];
    let keys = WeightKeys::new(["t", "v"], vec![0.0, 0.5], vec![0.1, 0.7], Interpolation::Linear, 1);
    mesh.weight_keys = vec![(1, keys.expect("valid"))];
    add_levels(&mut model, &[0], 3).expect("valid");
    assert!(model.meshes[0].levels.len() > 5 && !model.meshes[0].partners.is_empty());
    model
}

fn picture(model: &Model) -> RgbaImage {
    let posed =
        PosedModel { model, clip: 1, time: 0.3, instance_lod: InstanceLod::FULL, blend: Blend::Linear };
    let portrait = Portrait { edge: 48, finer: 2, background: [0.1; 3], clay: [0.5; 3] };
    posed.on_host(&portrait).expect("drawn").1
}

#[test]
fn models_are_read_back_to_the_bit_with_levels_and_images() {
    let model = model();
    let bytes = postcard::to_allocvec(&model).expect("stored");
    let again: Model = postcard::from_bytes(&bytes).expect("read");
    assert!(again == model);
    // Equality does not tell −0 from 0; bytes do.
    assert!(postcard::to_allocvec(&again).expect("stored") == bytes);
    assert_eq!(picture(&again), picture(&model));
    let text = serde_json::to_string(&model).expect("stored");
    let again: Model = serde_json::from_str(&text).expect("read");
    assert!(postcard::to_allocvec(&again).expect("stored") == bytes);
}

/// Four characters in a row, each three times as far away as the one before, where up to 4 pixels of error are allowed.
fn scene(gpu: &Gpu, model: &Model) -> RgbaImage {
    let mut scene = Scene::new(gpu).expect("compiled");
    let crowd = scene.add_character(model, 4).expect("added");
    for (at, away) in [3.0, 9.0, 27.0, 81.0].into_iter().enumerate() {
        let place = [0.25 * away * (at as f64 - 1.5), 0.0, -away];
        let walker = scene.spawn(crowd, Placement::at_world(place)).expect("room");
        scene.play(walker, &Play { start: -0.2 * at as f64, ..Play::new("0") }).expect("a clip");
    }
    let target = Offscreen::new(gpu, [160, 90]).expect("a target");
    let mut renderer = Renderer::new(gpu, target.format()).expect("compiled");
    renderer.prepare(&scene).expect("compiled");
    let mut view = scene.view(Quality::pixels(4.0)).expect("a view");
    let (eye, focus) = (Vec3::new(0.0, 1.5, 0.0), Vec3::new(0.0, 0.5, -10.0));
    view.set(Camera::looking_at(eye, focus, 0.8, [0.1, 200.0], target.size())).expect("a camera");
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    let draw =
        target.record(&mut encoder, [0.4, 0.6, 0.8], |pass| renderer.draw(pass, &scene, &view, Layer::Color));
    draw.expect("drawn");
    gpu.queue().submit([encoder.finish()]);
    target.read(gpu).expect("read")
}

#[test]
fn scenes_of_restored_models_are_those_of_the_originals() {
    let (gpu, model) = (gpu(), model());
    let bytes = postcard::to_allocvec(&model).expect("stored");
    let again: Model = postcard::from_bytes(&bytes).expect("read");
    let picture = scene(&gpu, &model);
    assert!(scene(&gpu, &again) == picture);
    // The levels are seen.
    let mut whole = model;
    whole.meshes[0].levels.clear();
    whole.meshes[0].partners.clear();
    assert!(scene(&gpu, &whole) != picture);
}

/// A stored model with another value at a path of names and numbers.
fn refused(stored: &Value, path: &str, value: Value) -> String {
    let mut changed = stored.clone();
    *changed.pointer_mut(path).expect(path) = value;
    serde_json::from_value::<Model>(changed).expect_err(path).to_string()
}

#[test]
fn what_does_not_match_is_refused_by_name() {
    let stored = serde_json::to_value(model()).expect("stored");
    assert!(serde_json::from_value::<Model>(stored.clone()).is_ok());
    let nine = || json!(999_999);
    for (path, value, named) in [
        ("/skins/0/bones/0", nine(), "skins[0].bones[0]"),
        ("/skeleton/bones/1/parent", json!(7), "bones[1].parent"),
        ("/skeleton/bones/1/rest/rotation", json!([0.0, 0.0, 0.0, 2.0]), "bones[1].rest.rotation"),
        ("/clips/0/tracks/1/first_value", nine(), "clip.tracks[1].values"),
        ("/clips/0/tracks/1/first_time", json!(u32::MAX), "clip.tracks[1].times"),
        ("/clips/0/duration", json!(0.0), "clip.duration"),
        ("/clips/1/tracks", json!([]), "clips[1].bones.len"),
        ("/meshes/0/skin", json!(1), "meshes[0].skin"),
        ("/meshes/0/material", json!(1), "meshes[0].material"),
        ("/meshes/0/indices/4", nine(), "meshes[0].indices[4]"),
        ("/meshes/0/levels/2/indices/4", nine(), "meshes[0].levels[2].indices[4]"),
        ("/meshes/0/levels/2/error", json!(-1.0), "meshes[0].levels[2].error"),
        ("/meshes/0/partners/0", nine(), "meshes[0].partners[0]"),
        ("/meshes/0/influences/6/0/weight", json!(0.3), "influences[6]"),
        ("/meshes/0/influences/6/0/bone", nine(), "influences[6]"),
        ("/meshes/0/weight_keys/0/0", nine(), "weight_keys.clip"),
        ("/meshes/0/weight_keys/0/1/targets", json!(u32::MAX), "weight_keys.targets"),
        ("/meshes/0/weight_keys/0/1/times/1", json!(-1.0), "weight_keys.times[1]"),
        ("/images/0/width", json!(6), "images[0].texels.len"),
        ("/materials/0/texture/image", json!(1), "texture.image"),
        ("/skinned", json!(2), "skinned"),
    ] {
        let error = refused(&stored, path, value);
        assert!(error.contains(named), "{path}: {error}");
    }
}
