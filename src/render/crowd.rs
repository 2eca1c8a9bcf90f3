//! Crowds of several characters in one picture: who is seen, how far each fades and with which level of detail is decided
//! in one compute pass; meshes are skinned once; every level of a mesh, which has one material, is two indirect draws, all
//! in the caller's render pass with its depth buffer.

use glam::{Mat4, Vec3};

use crate::animation::ModelMatrices;
use crate::asset::Model;
use crate::asset::transform::Affine;
use crate::gpu::{Buffer, Gpu, GpuError};
use crate::render::albedo::Albedo;
use crate::render::skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
use crate::skinning::bounding_sphere::bounding_sphere_in_clips;
use crate::skinning::frame::SkinFrame;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::lod::{LevelRanges, LodJob, LodPass, LodView, list_words, numbers_at};
use crate::skinning::picture::Light;
use crate::skinning::vertex::Blend;
use crate::{Error, InputError};

/// Steps of the fade.
const STEPS: u32 = 64;

/// Instances of a character, as [`CrowdScene::add`] takes them.
#[derive(Debug, Clone, Copy)]
pub struct Character<'a> {
    /// Its skeleton and meshes.
    pub model: &'a Model,
    /// Where the bones of each instance are: of a crowd under a gate
    /// [`GatedFrame::model_matrices`](crate::animation::frame::GatedFrame::model_matrices). Where it is not known which of
    /// them a frame updates, all vertices are skinned in every frame.
    pub matrices: &'a ModelMatrices,
    /// From the model's space into the world, one an instance. They may mirror.
    pub placements: &'a Buffer<Affine>,
    /// World units up to which every influence counts, and from which on vertices follow one bone, as [`LodView::away`]
    /// counts them.
    pub fade: [f32; 2],
    /// From which on levels 1, 2 … of the character are used, likewise, not descending: where each of its
    /// [`level_errors`](crate::skinning::level_errors) may be, by
    /// [`Extent::level_ranges`](crate::skinning::Extent::level_ranges). Without, meshes are drawn whole.
    pub levels: &'a [f32],
    /// How influences are blended.
    pub blend: Blend,
    /// Colours, one a mesh: [`Albedo::of_meshes`].
    pub albedos: &'a [Albedo],
}

/// Characters that are drawn together.
#[derive(Debug, Clone)]
pub struct CrowdScene {
    renderer: SkinnedRenderer,
    lod: LodPass,
    light: Light,
    characters: Vec<DrawnCharacter>,
}

/// A character on the device.
#[derive(Debug, Clone)]
pub struct DrawnCharacter {
    /// One a mesh. The caller may write weights of morph targets here.
    pub frames: Vec<SkinFrame>,
    /// One a mesh. The second of the first's ten arguments of each level is how many instances are drawn.
    pub scenes: Vec<SkinnedScene>,
    /// Which instances these are, level by level, [`list_stride`](crate::skinning::lod::list_stride) words each.
    pub drawn: Buffer<u32>,
    view: LodView,
    lod: LodJob,
    is_gated: bool,
}

impl CrowdScene {
    /// Nobody yet; compiles the pipelines for targets of `color` format with a
    /// [`DEPTH_FORMAT`](crate::render::target::DEPTH_FORMAT) depth buffer.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, color: wgpu::TextureFormat, light: Light) -> Result<Self, GpuError> {
        let (renderer, lod) = (SkinnedRenderer::new(gpu, color)?, LodPass::new(gpu)?);
        Ok(Self { renderer, lod, light, characters: Vec::new() })
    }

    /// Prepares a character, and says which it is among [`CrowdScene::characters`]. Morph targets are as at rest.
    ///
    /// # Errors
    /// [`InputError`] for a model without meshes, other than one colour a mesh, distances out of order, no
    /// instances, buffers that are too small, and dual quaternions under a gate that linear blending alone keeps
    /// ([`SkinFrame::new`]); [`GpuError`].
    pub fn add(&mut self, gpu: &Gpu, character: &Character<'_>) -> Result<usize, Error> {
        let Character { model, matrices, placements, fade, levels, blend, albedos } = *character;
        let (meshes, count) = (model.meshes.len(), placements.len());
        if meshes == 0 {
            return Err(InputError::new("model.meshes", "none", "must be at least one").into());
        }
        if albedos.len() != meshes {
            let bound = format!("must be {meshes}, one a mesh");
            return Err(InputError::new("albedos.len", albedos.len(), bound).into());
        }
        let levels = LevelRanges::new(levels)?;
        let drawn = Buffer::new(gpu, "drawn", list_words(count, 1 + levels.distances().len()))?;
        let (mut frames, mut scenes) = (Vec::with_capacity(meshes), Vec::with_capacity(meshes));
        for (mesh, albedo) in albedos.iter().enumerate() {
            let skin = SkinFrame::new(gpu, model, mesh, matrices, count, blend)?;
            skin.crowd.weights.write(gpu, &model.meshes[mesh].weights.repeat(count))?;
            scenes.push(self.renderer.scene(
                gpu,
                &SkinnedInstances {
                    mesh: &skin.mesh,
                    skinned: &skin.skinned,
                    placements,
                    drawn: &drawn,
                    albedo,
                    light: self.light,
                },
            )?);
            frames.push(skin);
        }
        let (center, radius) = bounding_sphere_in_clips(model);
        let [near, far] = fade;
        let (clip_from_world, eye) = (Mat4::IDENTITY, Vec3::ZERO);
        let most = InstanceLod::FULL.most;
        let view = LodView { clip_from_world, eye, near, far, steps: STEPS, most, center, radius, levels };
        let instance_lods = &frames[0].crowd.instance_lods;
        let lod = self.lod.prepare(gpu, &view, placements, instance_lods, &drawn, &scenes[0].arguments)?;
        let is_gated = matrices.updated_bones().is_some();
        self.characters.push(DrawnCharacter { frames, scenes, drawn, view, lod, is_gated });
        Ok(self.characters.len() - 1)
    }

    /// All of them, in the order in which they came.
    pub fn characters(&self) -> &[DrawnCharacter] {
        &self.characters
    }

    /// Chooses the camera of the next submission.
    ///
    /// # Errors
    /// [`InputError`] for what is not finite; [`GpuError`].
    pub fn set_camera(&mut self, gpu: &Gpu, clip_from_world: Mat4, eye: Vec3) -> Result<(), Error> {
        for character in &mut self.characters {
            character.view = LodView { clip_from_world, eye, ..character.view };
            character.lod.set(gpu, &character.view)?;
            character.scenes.iter_mut().try_for_each(|scene| scene.set_camera(gpu, clip_from_world))?;
        }
        Ok(())
    }

    /// Records what precedes the drawing: who is seen, how far they fade, and skinning.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        LodJob::record_together(encoder, self.characters.iter().map(|character| &character.lod));
        for character in &self.characters {
            character.share(encoder);
            for frame in &character.frames {
                match character.is_gated {
                    true => frame.record_updated_bones(encoder),
                    false => frame.record_all(encoder),
                }
            }
        }
    }

    /// Draws everybody.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        for scene in self.characters.iter().flat_map(|character| &character.scenes) {
            scene.draw(pass);
        }
    }
}

impl DrawnCharacter {
    /// Levels of detail that are told apart, the meshes themselves included.
    fn levels(&self) -> usize {
        1 + self.view.levels.distances().len()
    }

    /// What was decided for the first mesh holds for all of the character.
    fn share(&self, encoder: &mut wgpu::CommandEncoder) {
        let (frame, scene) = (&self.frames[0].crowd.instance_lods, &self.scenes[0].arguments);
        for (other, drawn) in self.frames.iter().zip(&self.scenes).skip(1) {
            let instance_lods = &other.crowd.instance_lods;
            encoder.copy_buffer_to_buffer(frame.raw(), 0, instance_lods.raw(), 0, instance_lods.bytes());
            for number in (0..self.levels()).flat_map(numbers_at) {
                encoder.copy_buffer_to_buffer(scene.raw(), number, drawn.arguments.raw(), number, 4);
            }
        }
    }
}
