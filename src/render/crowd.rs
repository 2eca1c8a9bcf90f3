//! Crowds of several characters in one picture. One compute pass decides which instances are seen, how far each
//! one's influences fade and which level of detail it has. Meshes are skinned once. Each level of a mesh, which
//! has one material, takes two indirect draws, all in the caller's render pass with its depth buffer.

use glam::{Mat4, Vec3};

use crate::animation::ModelMatrices;
use crate::asset::Light;
use crate::asset::Model;
use crate::asset::transform::Affine;
use crate::gpu::{Buffer, Gpu, GpuError};
use crate::render::albedo::Albedo;
use crate::render::skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::skinning::frame::SkinFrame;
use crate::skinning::instance_lod::{FadeRange, InstanceLod};
use crate::skinning::lod::{LevelRanges, LodBuffers, LodJob, LodPass, LodView, list_words, numbers_at};
use crate::skinning::vertex::Blend;
use crate::{Error, InputError};

/// Number of steps of the fade.
const STEPS: u32 = 64;

/// The instances of one character, as [`CrowdScene::add`] takes them.
#[derive(Debug, Clone, Copy)]
pub struct Character<'a> {
    /// The skeleton and meshes.
    pub model: &'a Model,
    /// The model matrices of each instance's bones; for a crowd under a gate,
    /// [`GatedFrame::model_matrices`](crate::animation::frame::GatedFrame::model_matrices). If the matrices do
    /// not record which bones a frame updates, all vertices are skinned in every frame.
    pub matrices: &'a ModelMatrices,
    /// The transforms from the model's space into the world, one per instance. They may mirror.
    pub placements: &'a Buffer<Affine>,
    /// The distances between which influences fade.
    pub fade_range: FadeRange,
    /// Distances, in world units as [`LodView::projected_distance`] measures them and not descending, from which on levels 1, 2 … of the character are used:
    /// those at which each of its [`level_errors`](crate::skinning::level_errors) is permitted, as computed by
    /// [`Extent::level_ranges`](crate::skinning::Extent::level_ranges). If empty, the meshes themselves are
    /// drawn.
    pub levels: &'a [f32],
    /// How influences are blended.
    pub blend: Blend,
    /// Base colours, one per mesh; see [`Albedo::of_meshes`].
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
    /// One per mesh. The caller may write the weights of morph targets here.
    pub frames: Vec<SkinFrame>,
    /// One per mesh. Of the ten arguments of each level in the first scene, the second is the number of
    /// instances that are drawn.
    pub scenes: Vec<SkinnedScene>,
    /// The indices of these instances, level by level, [`list_stride`](crate::skinning::lod::list_stride) words
    /// each.
    pub drawn: Buffer<u32>,
    view: LodView,
    lod: LodJob,
    is_gated: bool,
}

impl CrowdScene {
    /// An empty scene; compiles the pipelines for targets of `color` format with a
    /// [`DEPTH_FORMAT`](crate::render::target::DEPTH_FORMAT) depth buffer.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, color: wgpu::TextureFormat, light: Light) -> Result<Self, GpuError> {
        let (renderer, lod) = (SkinnedRenderer::new(gpu, color)?, LodPass::new(gpu)?);
        Ok(Self { renderer, lod, light, characters: Vec::new() })
    }

    /// Prepares a character and returns its index in [`CrowdScene::characters`]. Morph targets have their
    /// weights at rest.
    ///
    /// # Errors
    /// [`InputError`] for a model without meshes, a number of colours that is not one per mesh, distances out
    /// of order, no instances, buffers that are too small, and dual quaternions under a gate whose bound holds
    /// for linear blending only ([`SkinFrame::new`]); [`GpuError`].
    pub fn add(&mut self, gpu: &Gpu, character: &Character<'_>) -> Result<usize, Error> {
        let Character { model, matrices, placements, fade_range, levels, blend, albedos } = *character;
        let (meshes, count) = (model.meshes.len(), placements.len());
        if meshes == 0 {
            return Err(InputError::new("model.meshes.len", 0, "must be at least 1").into());
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
        let BoundingSphere { center, radius } = BoundingSphere::in_clips(model);
        let (clip_from_world, eye) = (Mat4::IDENTITY, Vec3::ZERO);
        let most = InstanceLod::FULL.max_influences;
        let view = LodView {
            clip_from_world,
            eye,
            fade_range,
            steps: STEPS,
            max_influences: most,
            center,
            radius,
            levels,
        };
        let buffers = LodBuffers {
            placements,
            instance_lods: &frames[0].crowd.instance_lods,
            drawn: &drawn,
            arguments: &scenes[0].arguments,
        };
        let lod = self.lod.prepare(gpu, &view, buffers)?;
        let is_gated = matrices.updated_bones().is_some();
        self.characters.push(DrawnCharacter { frames, scenes, drawn, view, lod, is_gated });
        Ok(self.characters.len() - 1)
    }

    /// The characters, in the order in which they were added.
    pub fn characters(&self) -> &[DrawnCharacter] {
        &self.characters
    }

    /// Sets the camera of the next submission.
    ///
    /// # Errors
    /// [`InputError`] for values that are not finite; [`GpuError`].
    pub fn set_camera(&mut self, gpu: &Gpu, clip_from_world: Mat4, eye: Vec3) -> Result<(), Error> {
        for character in &mut self.characters {
            character.view = LodView { clip_from_world, eye, ..character.view };
            character.lod.set(gpu, &character.view)?;
            character.scenes.iter_mut().try_for_each(|scene| scene.set_camera(gpu, clip_from_world))?;
        }
        Ok(())
    }

    /// Records the work before drawing: visibility, fade and level of detail, then skinning.
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

    /// Draws all characters.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        for scene in self.characters.iter().flat_map(|character| &character.scenes) {
            scene.draw(pass);
        }
    }
}

impl DrawnCharacter {
    /// Number of levels of detail of the character, the meshes themselves included.
    fn levels(&self) -> usize {
        1 + self.view.levels.distances().len()
    }

    /// Copies the decisions for the first mesh to the other meshes of the character.
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
