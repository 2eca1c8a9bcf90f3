//! What all looks of a crowd share, and how a look is set up.

use glam::{Mat4, Vec3, camera};
use image::{Rgba, RgbaImage};

use super::look::{Drawable, Look};
use super::{ASPECT, Animation, Variant};
use crate::asset::Affine;
use crate::asset::Light;
use crate::gpu::{Buffer, Gpu};
use crate::measure::device::Device;
use crate::measure::options::SkinningDetail;
use crate::measure::placement::Placements;
use crate::measure::stage::{FIELD_OF_VIEW, Stage};
use crate::render::skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
use crate::render::target::COLOR_FORMAT;
use crate::render::{Albedo, ColorTexture};
use crate::skinning::Extent;
use crate::skinning::frame::SkinFrame;
use crate::skinning::instance_lod::{FadeRange, InstanceLod};
use crate::skinning::lod::{LevelRanges, LodBuffers, LodJob, LodPass, LodView, list_words};
use crate::skinning::morph_weights::{MorphWeightsJob, MorphWeightsPass, WeightSet};
use crate::skinning::vertex::Blend;
use crate::surface::mips::Mips;
use crate::{Error, InputError};

/// Number of steps of the influence fade.
const STEPS: u32 = 64;

/// The placements, camera and textures that all looks share.
pub(super) struct World<'a> {
    gpu: &'a Gpu,
    stage: &'a Stage<'a>,
    placements: Buffer<Affine>,
    clip_from_world: Mat4,
    renderer: SkinnedRenderer,
    /// One base-colour texture per mesh.
    albedos: Vec<Albedo>,
}

impl<'a> World<'a> {
    pub(super) fn new(gpu: &'a Gpu, stage: &'a Stage<'a>, placements: &Placements) -> Result<Self, Error> {
        let model = stage.subject.model;
        if model.meshes.is_empty() {
            let bound = "must be at least one that is not compressed with Draco";
            return Err(InputError::new("model.meshes.len", 0, bound).into());
        }
        let deepest = placements.origins.iter().map(|origin| origin[2]).fold(0.0, f32::max);
        let far = 2.0 * deepest + 4.0 * stage.options.size * stage.metres_a_unit;
        let aspect = ASPECT[0] as f32 / ASPECT[1] as f32;
        let checks = ColorTexture::new(gpu, &checks(), true)?.into();
        Ok(Self {
            placements: Buffer::from_slice(gpu, "placements", &placements.transforms())?,
            // The camera is at the origin and looks along -Z.
            clip_from_world: camera::rh::proj::directx::perspective(
                FIELD_OF_VIEW,
                aspect,
                stage.projection.near,
                far,
            ),
            renderer: SkinnedRenderer::new(gpu, COLOR_FORMAT)?,
            albedos: Albedo::of_meshes(gpu, model, &checks, ColorTexture::new)?,
            gpu,
            stage,
        })
    }

    pub(super) fn look(&self, device: &Device, variant: Variant) -> Result<Look, Error> {
        let meshes = 0..self.stage.subject.model.meshes.len();
        let meshes = meshes.map(|mesh| self.drawable(device, variant, mesh)).collect::<Result<_, _>>()?;
        Ok(Look::new(variant, meshes))
    }

    fn drawable(&self, device: &Device, variant: Variant, index: usize) -> Result<Drawable, Error> {
        let Self { gpu, stage, .. } = self;
        let (model, count) = (stage.model(variant.mesh), stage.instances.len());
        let levels = LevelRanges::new(&stage.level_begins(variant.mesh, index))?;
        let matrices = match variant.animation {
            Animation::Full => device.full.crowd.model_matrices(),
            Animation::Gated => device.gated.frame.model_matrices(),
        };
        let skin = SkinFrame::new(gpu, model, index, matrices, count, Blend::Linear)?;
        let drawn = Buffer::new(gpu, "drawn", list_words(count, 1 + levels.distances().len()))?;
        let scene = self.scene(&skin, &drawn, index)?;
        Ok(Drawable {
            slots: skin.clusters.slots(),
            weights: self.weights(device, variant, &skin, index)?,
            lod: self.lod(variant.skinning, levels, index, (&skin, &drawn, &scene))?,
            skin,
            scene,
        })
    }

    /// The scene that draws a mesh.
    fn scene(&self, skin: &SkinFrame, drawn: &Buffer<u32>, index: usize) -> Result<SkinnedScene, Error> {
        let instances = SkinnedInstances {
            mesh: &skin.mesh,
            skinned: &skin.skinned,
            placements: &self.placements,
            drawn,
            albedo: &self.albedos[index],
            light: Light::default(),
        };
        let mut scene = self.renderer.scene(self.gpu, &instances)?;
        scene.set_camera(self.gpu, self.clip_from_world)?;
        Ok(scene)
    }

    /// The weights of a mesh's morph targets, at the clip times of the crowd that animates it.
    fn weights(
        &self,
        device: &Device,
        variant: Variant,
        skin: &SkinFrame,
        index: usize,
    ) -> Result<MorphWeightsJob, Error> {
        let Self { gpu, stage, .. } = self;
        let playing = match variant.animation {
            Animation::Full => &device.full.crowd.instances,
            Animation::Gated => &device.gated.crowd.instances,
        };
        let mesh = &stage.model(variant.mesh).meshes[index];
        let keys = WeightSet::new(mesh, &stage.set, &[stage.subject.clip])?;
        MorphWeightsPass::new(gpu)?.prepare(gpu, &keys, playing, &skin.crowd)
    }

    /// The pass that decides which instances are seen and how far their influences fade.
    fn lod(
        &self,
        skinning: SkinningDetail,
        levels: LevelRanges,
        index: usize,
        (skin, drawn, scene): (&SkinFrame, &Buffer<u32>, &SkinnedScene),
    ) -> Result<LodJob, Error> {
        let Self { gpu, stage, placements, .. } = self;
        let Extent { center, radius, .. } = stage.extents[index];
        let max_influences = match skinning {
            SkinningDetail::Truncate { max_influences } => max_influences,
            _ => InstanceLod::FULL.max_influences,
        };
        let view = LodView {
            clip_from_world: self.clip_from_world,
            eye: Vec3::ZERO,
            fade_range: stage.fade(skinning, index).unwrap_or(FadeRange::NEVER),
            steps: STEPS,
            max_influences,
            center,
            radius,
            levels,
        };
        let buffers = LodBuffers {
            placements,
            instance_lods: &skin.crowd.instance_lods,
            drawn,
            arguments: &scene.arguments,
        };
        LodPass::new(gpu)?.prepare(gpu, &view, buffers)
    }
}

/// A checkerboard of clay in two colours, for meshes without a material.
fn checks() -> Mips {
    let square = |x: u32, y: u32| match (x / 16 + y / 16) % 2 {
        0 => Rgba([214, 150, 104, 255]),
        _ => Rgba([150, 82, 52, 255]),
    };
    Mips::of_color(RgbaImage::from_fn(64, 64, square))
}
