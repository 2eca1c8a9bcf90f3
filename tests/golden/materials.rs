//! Materials of glTF: textures, colours, holes and translucency, on the device and in the reference.

use image::RgbaImage;
use relievo::animation::ModelMatrices;
use relievo::animation::local_to_model::reference::local_to_model;
use relievo::animation::sample::reference::sample;
use relievo::asset::Light;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::{AFFINE_IDENTITY, Affine};
use relievo::gpu::Buffer;
use relievo::render::target::LINEAR_FORMAT;
use relievo::render::{Albedo, Character, ColorTexture, CrowdScene, Target};
use relievo::skinning::instance_lod::{FadeRange, InstanceLod};
use relievo::skinning::morph::reference::morph;
use relievo::skinning::palette::reference::palette_for;
use relievo::skinning::picture::framing;
use relievo::skinning::picture::texture::Surface;
use relievo::skinning::picture::{Part, Scene};
use relievo::skinning::skin::reference::skin;
use relievo::skinning::vertex::{Blend, Vertex};
use relievo::surface::linear_image::LinearImage;

use crate::figure::figure;
use crate::harness::{Difference, Tolerance, check_golden, gpu};
use crate::skinned::{SKY, checks};

const SIZE: [u32; 2] = [2 * 160; 2];

#[test]
fn a_figure_in_its_materials() {
    let (gpu, model) = (gpu(), figure());
    let models: Vec<Affine> =
        local_to_model(&model.skeleton, &sample(&model.clips[0], 0.8, RotationPath::Slerp));
    let vertices = |mesh: &relievo::asset::Mesh| -> Vec<Vertex> {
        let palette = palette_for(&model.skins[mesh.skin], &models, Blend::Linear);
        skin(&morph(mesh, &[]), &mesh.influences, &palette, InstanceLod::FULL)
    };
    let skinned: Vec<_> = model.meshes.iter().map(vertices).collect();
    let clip_from_model = framing(skinned.iter().flatten());

    let albedos = Albedo::of_meshes(&gpu, &model, &checks(&gpu), ColorTexture::linear).expect("uploaded");
    let mut crowd = CrowdScene::new(&gpu, LINEAR_FORMAT, Light::default()).expect("compiled");
    let matrices = Buffer::from_slice(&gpu, "model matrices", &models).expect("uploaded");
    let character = Character {
        model: &model,
        matrices: &ModelMatrices::new(&matrices),
        placements: &Buffer::from_slice(&gpu, "placements", &[AFFINE_IDENTITY]).expect("uploaded"),
        fade_range: FadeRange { start: 1e3, end: 2e3 },
        levels: &[],
        blend: Blend::Linear,
        albedos: &albedos,
    };
    crowd.add(&gpu, &character).expect("prepared");
    crowd.set_camera(&gpu, clip_from_model, glam::Vec3::ZERO).expect("set");
    let target = Target::linear(&gpu, SIZE).expect("allocated");
    gpu.run("skin", |encoder| crowd.record(encoder)).expect("run");
    target.draw(&gpu, SKY, |pass| crowd.draw(pass)).expect("drawn");
    let picture = LinearImage { size: SIZE, pixels: target.read_linear(&gpu).expect("read") };
    let picture: RgbaImage = picture.reduced(2).encoded();

    let surfaces: Vec<_> = (model.meshes.iter())
        .map(|mesh| Surface::of(&model, model.material(mesh).expect("fits").expect("has one")))
        .collect();
    let parts: Vec<_> = (model.meshes.iter().zip(&skinned).zip(&surfaces))
        .map(|((mesh, vertices), surface)| Part { mesh, level: 0, vertices, surface })
        .collect();
    let scene = Scene { clip_from_model, light: Light::default(), size: SIZE };
    let reference = scene.draw(&parts, SKY.map(|light| light as f32)).reduced(2).encoded();
    let difference = Difference::of(&picture, &reference, Tolerance::IMAGE.levels);
    assert!(difference.within(Tolerance::IMAGE), "{difference:?}");

    if let Err(error) = check_golden("skin_materials", &picture, Tolerance::IMAGE) {
        panic!("{error}");
    }
}
