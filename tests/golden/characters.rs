//! Several characters in one picture, near and far: seen, faded, skinned and drawn together.

use glam::{Vec3, camera};
use relievo::animation::local_to_model::reference::local_to_model;
use relievo::animation::order::Order;
use relievo::animation::sample::reference::sample;
use relievo::animation::{ModelMatrices, UpdatedBones};
use relievo::asset::Light;
use relievo::asset::Model;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::gpu::{Buffer, Gpu};
use relievo::render::target::LINEAR_FORMAT;
use relievo::render::{Albedo, Character, ColorTexture, CrowdScene, Target};
use relievo::samples::creature;
use relievo::skinning::FadeRange;
use relievo::skinning::lod::placed;
use relievo::skinning::vertex::Blend;
use relievo::surface::linear_image::LinearImage;

use crate::figure::figure;
use crate::harness::{Tolerance, check_golden, gpu};
use crate::skinned::{SKY, checks};

/// Number of instances of each character, in rows away from the eye; the first row is behind it.
const COUNT: usize = 20;

struct Instances {
    matrices: ModelMatrices,
    placements: Buffer<Affine>,
}

impl Instances {
    /// A crowd in which each instance has its own clip time; with `gated`, under a gate that updates no
    /// instance.
    fn new(gpu: &Gpu, model: &Model, aside: f32, gated: bool) -> Self {
        let clip = &model.clips[0];
        let pose = |index: usize| {
            let time = (index as f32 * 0.618).fract() * clip.duration();
            local_to_model(&model.skeleton, &sample(clip, time, RotationPath::Slerp))
        };
        let place = |index: usize| {
            let z = [18.0, 2.0, -3.0, -9.0, -18.0][index / 4];
            let at = Vec3::new((index % 4) as f32 * 2.2 - 3.9 + aside, 0.0, z);
            placed(at, 0.4 * index as f32, 1.0)
        };
        let models: Vec<Affine> = (0..COUNT).flat_map(pose).collect();
        let places: Vec<Affine> = (0..COUNT).map(place).collect();
        let matrices =
            ModelMatrices::new(&Buffer::from_slice(gpu, "model matrices", &models).expect("uploaded"));
        let words = COUNT * Order::new(&model.skeleton).words();
        let updated = UpdatedBones::new(gpu, words).expect("allocated");
        Self {
            matrices: if gated { matrices.with_updated_bones(&updated) } else { matrices },
            placements: Buffer::from_slice(gpu, "placements", &places).expect("uploaded"),
        }
    }

    fn character<'a>(&'a self, model: &'a Model, albedos: &'a [Albedo], blend: Blend) -> Character<'a> {
        let Self { matrices, placements } = self;
        Character {
            model,
            matrices,
            placements,
            fade_range: FadeRange { start: 5.0, end: 25.0 },
            levels: &[],
            blend,
            albedos,
        }
    }
}

#[test]
fn creatures_and_figures_in_one_picture() {
    let gpu = gpu();
    let all = [creature().expect("valid"), figure()];
    let mut crowd = CrowdScene::new(&gpu, LINEAR_FORMAT, Light::default()).expect("compiled");
    for ((model, aside), blend) in all.iter().zip([0.0, 1.1]).zip([Blend::Linear, Blend::DualQuaternion]) {
        let albedos = Albedo::of_meshes(&gpu, model, &checks(&gpu), ColorTexture::linear).expect("uploaded");
        let instances = Instances::new(&gpu, model, aside, blend == Blend::Linear);
        let none = instances.character(model, &[], blend);
        assert!(crowd.add(&gpu, &none).expect_err("refused").to_string().contains("albedos.len = 0"));
        crowd.add(&gpu, &instances.character(model, &albedos, blend)).expect("prepared");
    }
    let size = [176, 112].map(|edge| 2 * edge);
    let eye = Vec3::new(-1.0, 2.6, 7.0);
    let look = camera::rh::view::look_at_mat4(eye, Vec3::new(0.5, 0.6, -4.0), Vec3::Y);
    let clip_from_world = camera::rh::proj::directx::perspective(0.75, 176.0 / 112.0, 0.2, 100.0) * look;
    crowd.set_camera(&gpu, clip_from_world, eye).expect("set");
    let target = Target::linear(&gpu, size).expect("allocated");
    // The whole frame is one submission with one render pass.
    gpu.run("frame", |encoder| {
        crowd.record(encoder);
        target.record(encoder, SKY, |pass| crowd.draw(pass));
    })
    .expect("run");

    for (character, meshes) in crowd.characters().iter().zip([1, 4]) {
        assert_eq!((character.frames.len(), character.scenes.len()), (meshes, meshes));
        let counts = |scene: &relievo::render::SkinnedScene| {
            let words = scene.arguments.read_blocking(&gpu).expect("read");
            let [indices, instances, ref rest @ ..] = words[..] else { panic!("ten words") };
            // No instance is mirrored.
            assert!(indices > 0 && *rest == [0, 0, 0, indices, 0, 0, 0, 0]);
            instances as usize
        };
        let seen = counts(&character.scenes[0]);
        assert!((10..17).contains(&seen), "{seen} of {COUNT}");
        let mut drawn = character.drawn.read_blocking(&gpu).expect("read")[..seen].to_vec();
        drawn.sort_unstable();
        drawn.dedup();
        assert!(
            drawn.len() == seen && drawn.iter().all(|index| (4..COUNT as u32).contains(index)),
            "{drawn:?}"
        );
        // All meshes of a character fade alike, and are drawn at the same instances.
        let fades = |frame: &relievo::skinning::frame::SkinFrame| {
            frame
                .crowd
                .instance_lods
                .read_blocking(&gpu)
                .expect("read")
                .iter()
                .map(|r| r.influence_fade)
                .collect::<Vec<_>>()
        };
        let first = fades(&character.frames[0]);
        assert!([9, 13, 17].iter().all(|index| drawn.contains(index)), "{drawn:?}");
        assert!(first[17] > 0.7 && first[9] < first[13] && first[13] < first[17], "{first:?}");
        for (frame, scene) in character.frames.iter().zip(&character.scenes) {
            assert_eq!((fades(frame), counts(scene)), (first.clone(), seen));
        }
    }
    // No instance moves and visibility does not change: nothing is skinned again.
    let skinned = || {
        let frames = &crowd.characters()[0].frames;
        frames[0].active.dispatched.read_blocking(&gpu).expect("read")[3]
    };
    assert!(skinned() > 0);
    gpu.run("frame", |encoder| crowd.record(encoder)).expect("run");
    assert_eq!(skinned(), 0);
    target.draw(&gpu, SKY, |pass| crowd.draw(pass)).expect("drawn");
    let picture = LinearImage { size, pixels: target.read_linear(&gpu).expect("read") };
    if let Err(error) = check_golden("skin_characters", &picture.reduced(2).encoded(), Tolerance::IMAGE) {
        panic!("{error}");
    }
}
