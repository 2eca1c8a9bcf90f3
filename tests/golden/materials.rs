//! Materials of glTF: textures, colours, holes and translucency, by a scene and in the reference.

use relievo::asset::Light;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::vertex::{Blend, Vertex};
use relievo::scene::{Placement, Play, Quality, Scene};
use relievo_lab::portrait::picture::texture::Surface;
use relievo_lab::portrait::picture::{self, Part, framing_camera};

use crate::figure::figure;
use crate::harness::{Difference, Tolerance, check_golden, gpu};
use crate::stage::{self, SKY, camera};

const SIZE: [u32; 2] = [160; 2];

/// The time in the clip.
const SECONDS: f32 = 0.8;

#[test]
fn a_figure_in_its_materials() {
    let (gpu, model) = (gpu(), figure());
    let models: Vec<Affine> =
        local_to_model(&model.skeleton, &sample(&model.clips[0], SECONDS, RotationPath::Slerp));
    let vertices = |mesh: &relievo::asset::Mesh| -> Vec<Vertex> {
        let palette = palette_for(&model.skins[mesh.skin], &models, Blend::Linear);
        skin(&morph(mesh, &[]), &mesh.influences, &palette, InstanceLod::FULL)
    };
    let skinned: Vec<_> = model.meshes.iter().map(vertices).collect();
    let [view_from_world, clip_from_view] = framing_camera(skinned.iter().flatten());

    let mut scene = Scene::new(&gpu).expect("compiled");
    let object = scene.add_character(&model, 1).expect("added");
    let instance = scene.spawn(object, Placement::default()).expect("room");
    scene.play(instance, &Play { start: -f64::from(SECONDS), ..Play::new("0") }).expect("the clip");
    let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
    view.set(camera(view_from_world, clip_from_view, SIZE)).expect("a camera");
    let found = stage::picture(&gpu, &mut scene, &mut view);

    let surfaces: Vec<_> = (model.meshes.iter())
        .map(|mesh| Surface::of(&model, model.material(mesh).expect("fits").expect("has one")))
        .collect();
    let parts: Vec<_> = (model.meshes.iter().zip(&skinned).zip(&surfaces))
        .map(|((mesh, vertices), surface)| Part { mesh, level: 0, vertices, surface })
        .collect();
    let reference = picture::Scene {
        clip_from_model: clip_from_view * view_from_world,
        light: Light::default(),
        size: SIZE.map(|edge| 2 * edge),
    };
    let reference = reference.draw(&parts, SKY).reduced(2).encoded();
    let difference = Difference::of(&found, &reference, Tolerance::IMAGE.levels);
    println!("{difference:?}");
    assert!(difference.within(Tolerance::IMAGE), "{difference:?}");
    // Materials make the picture: without them the comparison fails.
    let plain = Surface::plain([1.0; 3]);
    let parts: Vec<_> = parts.iter().map(|part| Part { surface: &plain, ..*part }).collect();
    let scene = picture::Scene {
        clip_from_model: clip_from_view * view_from_world,
        light: Light::default(),
        size: SIZE.map(|edge| 2 * edge),
    };
    let plain = scene.draw(&parts, SKY).reduced(2).encoded();
    assert!(!Difference::of(&found, &plain, Tolerance::IMAGE.levels).within(Tolerance::IMAGE));

    if let Err(error) = check_golden("skin_materials", &found, Tolerance::IMAGE) {
        panic!("{error}");
    }
}
