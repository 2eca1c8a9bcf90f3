//! A crowd that walks in and out of view: instances that are not seen are not skinned, and the picture equals
//! that of a crowd in which all are.

use glam::{Mat4, Vec3, camera};
use relievo::animation::ModelMatrices;
use relievo::animation::local_to_model::reference::local_to_model;
use relievo::animation::sample::reference::sample;
use relievo::asset::Light;
use relievo::asset::Model;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::gpu::{Buffer, Gpu};
use relievo::render::target::COLOR_FORMAT;
use relievo::render::{ColorTexture, SkinnedInstances, SkinnedRenderer, SkinnedScene, Target};
use relievo::samples::creature;
use relievo::skinning::bounding_sphere::BoundingSphere;
use relievo::skinning::frame::SkinFrame;
use relievo::skinning::instance_lod::{FadeRange, InstanceLod};
use relievo::skinning::lod::{LevelRanges, LodBuffers, LodJob, LodPass, LodView, placed};
use relievo::skinning::select::SKINNED_WORDS;
use relievo::skinning::vertex::Blend;
use relievo::surface::mips::Mips;

use crate::harness::gpu;

/// Creatures that walk abreast from left to right through a narrow view.
const CREATURES: usize = 9;

const FRAMES: usize = 24;

const SIZE: [u32; 2] = [160, 96];

/// One of the two crowds that are compared.
struct Crowd {
    skin: SkinFrame,
    lod: LodJob,
    scene: SkinnedScene,
}

struct Stage {
    gpu: Gpu,
    model: Model,
    models: Buffer<Affine>,
    placements: Buffer<Affine>,
    view: LodView,
}

impl Stage {
    fn new() -> Self {
        let (gpu, model) = (gpu(), creature().expect("valid"));
        let bones = CREATURES * model.skeleton.len();
        let eye = Vec3::new(0.0, 1.0, 9.0);
        let look = camera::rh::view::look_at_mat4(eye, Vec3::new(0.0, 0.8, 0.0), Vec3::Y);
        let projection = camera::rh::proj::directx::perspective(0.3, 160.0 / 96.0, 0.2, 100.0);
        let BoundingSphere { center, radius } =
            BoundingSphere::around(model.meshes[0].positions.iter().map(|position| Vec3::from(*position)));
        let clip_from_world: Mat4 = projection * look;
        Self {
            models: Buffer::new(&gpu, "model matrices", bones).expect("allocated"),
            placements: Buffer::new(&gpu, "placements", CREATURES).expect("allocated"),
            view: LodView {
                clip_from_world,
                eye,
                fade_range: FadeRange { start: 5.0, end: 12.0 },
                steps: 16,
                max_influences: 4,
                center,
                radius: 1.1 * radius,
                levels: LevelRanges::NONE,
            },
            gpu,
            model,
        }
    }

    fn crowd(&self) -> Crowd {
        let Self { gpu, model, models, placements, view } = self;
        let matrices = ModelMatrices::new(models);
        let skin = SkinFrame::new(gpu, model, 0, &matrices, CREATURES, Blend::Linear).expect("prepared");
        let everybody: Vec<u32> = (0..CREATURES as u32).collect();
        let drawn = Buffer::from_slice(gpu, "drawn", &everybody).expect("uploaded");
        let plain = Mips::of_color(image::RgbaImage::from_pixel(1, 1, image::Rgba([200, 150, 90, 255])));
        let instances = SkinnedInstances {
            mesh: &skin.mesh,
            skinned: &skin.skinned,
            placements,
            drawn: &drawn,
            albedo: &ColorTexture::new(gpu, &plain, true).expect("uploaded").into(),
            light: Light::default(),
        };
        let renderer = SkinnedRenderer::new(gpu, COLOR_FORMAT).expect("compiled");
        let mut scene = renderer.scene(gpu, &instances).expect("bound");
        scene.set_camera(gpu, view.clip_from_world).expect("set");
        let buffers = LodBuffers {
            placements,
            instance_lods: &skin.crowd.instance_lods,
            drawn: &drawn,
            arguments: &scene.arguments,
        };
        let lod = LodPass::new(gpu).expect("compiled").prepare(gpu, view, buffers).expect("prepared");
        Crowd { skin, lod, scene }
    }

    /// Creatures of odd index keep their pose.
    fn pose(&self, frame: usize) {
        let walk = self.model.clip("walk").expect("there");
        let pose = |at: usize| {
            let time = 0.13 * at as f32 + if at.is_multiple_of(2) { frame as f32 / 30.0 } else { 0.0 };
            local_to_model(&self.model.skeleton, &sample(walk, time % walk.duration(), RotationPath::Slerp))
        };
        let models: Vec<Affine> = (0..CREATURES).flat_map(pose).collect();
        self.models.write(&self.gpu, &models).expect("written");
        let place = |at: usize| {
            // The crowd walks out of view and back, the whole way in both directions.
            let fade_fraction = (frame as f32 / FRAMES as f32 * std::f32::consts::TAU).sin();
            placed(
                Vec3::new(8.0 * fade_fraction + 0.9 * (at as f32 - 4.0), 0.0, 0.3 * at as f32 - 1.5),
                1.57,
                1.0,
            )
        };
        let placements: Vec<Affine> = (0..CREATURES).map(place).collect();
        self.placements.write(&self.gpu, &placements).expect("written");
    }

    /// All bones of even creatures have moved.
    fn moved(&self, words: usize) -> Vec<u32> {
        (0..CREATURES * words).map(|at| if (at / words).is_multiple_of(2) { u32::MAX } else { 0 }).collect()
    }

    fn picture(&self, target: &Target, crowd: &Crowd) -> image::RgbaImage {
        target.draw(&self.gpu, [0.0; 3], |pass| crowd.scene.draw(pass)).expect("drawn");
        target.read(&self.gpu).expect("read")
    }
}

#[test]
fn what_is_not_seen_is_not_skinned_and_comes_back_whole() {
    let stage = Stage::new();
    let (gpu, [culled, whole]) = (&stage.gpu, [stage.crowd(), stage.crowd()]);
    let target = Target::new(gpu, SIZE).expect("allocated");
    let words = culled.skin.mesh.mask_words;
    let clusters = culled.skin.clusters.len();
    let mut seen_before = [0_u32; CREATURES];
    let (mut skinned, mut empty, mut back) = (0, 0, 0);
    for frame in 0..FRAMES {
        stage.pose(frame);
        culled.skin.select.updated_bones.write(gpu, &stage.moved(words)).expect("written");
        gpu.run("frame", |encoder| {
            culled.lod.record(encoder);
            culled.skin.record_updated_bones(encoder);
        })
        .expect("run");
        // The other crowd skins and draws every instance, with the same fade where that is known.
        let instance_lods = culled.skin.crowd.instance_lods.read_blocking(gpu).expect("read");
        let full = |instance_lod: &InstanceLod| {
            if instance_lod.max_influences == 0 { InstanceLod::FULL } else { *instance_lod }
        };
        let all: Vec<_> = instance_lods.iter().map(full).collect();
        whole.skin.crowd.instance_lods.write(gpu, &all).expect("written");
        gpu.run("whole", |encoder| whole.skin.record_all(encoder)).expect("run");
        let [some, all] = [&culled, &whole].map(|crowd| stage.picture(&target, crowd));
        // Two pipelines skin the crowds: a device may round one differently, so that a pixel on an edge
        // changes.
        let differing = some.pixels().zip(all.pixels()).filter(|(a, b)| a != b).count();
        let drawn = all.pixels().filter(|pixel| *pixel != all.get_pixel(0, 0)).count();
        assert!(differing <= drawn / 500, "frame {frame}: {differing} of {drawn} pixels differ");
        let known = culled.skin.select.skinned.read_blocking(gpu).expect("read");
        let mut expected = 0;
        for (at, instance_lod) in instance_lods.iter().enumerate() {
            let seen = known[SKINNED_WORDS * at + 3];
            let wanted = if instance_lod.max_influences == 0 { 0 } else { (seen_before[at] + 1).min(2) };
            assert_eq!(seen, wanted, "creature {at} of frame {frame}");
            // An instance that stands still is skinned when it comes back or fades.
            if instance_lod.max_influences > 0 && at.is_multiple_of(2) || seen == 1 {
                expected += clusters;
            }
            back += usize::from(seen == 1 && frame > 0);
            seen_before[at] = seen;
        }
        let now = culled.skin.active.dispatched.read_blocking(gpu).expect("read")[3] as usize;
        assert!((expected..=expected + 5 * clusters).contains(&now), "{now} of {expected}, frame {frame}");
        let drawn = culled.scene.arguments.read_blocking(gpu).expect("read")[1];
        assert_eq!(
            drawn as usize,
            instance_lods.iter().filter(|instance_lod| instance_lod.max_influences > 0).count()
        );
        if drawn == 0 {
            assert_eq!(now, 0, "frame {frame}");
            empty += 1;
        }
        skinned += now;
    }
    let all = FRAMES * CREATURES * clusters;
    assert!(back > CREATURES && empty >= 2, "{back} came back, {empty} frames without any");
    assert!(2 * skinned < all, "{skinned} of {all} clusters");
}
