//! Pictures of models: a model's vertices at one time of a clip, on the host or on the device, and how they are drawn.

#[cfg(not(target_arch = "wasm32"))]
mod device;
pub mod picture;
#[cfg(not(target_arch = "wasm32"))]
mod pose;

#[cfg(not(target_arch = "wasm32"))]
pub use device::{portrait, portraits};
#[cfg(not(target_arch = "wasm32"))]
pub use pose::pose;

use glam::Mat4;
use image::RgbaImage;
use picture::texture::Surface;
use picture::{Part, Scene, framing, framing_of};
use relievo::InputError;
use relievo::asset::{Light, Mesh, Model};
use relievo::ops::animation::Pose;
use relievo::ops::skinning::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::vertex::{Blend, Vertex, check_range, vertices_of};
#[cfg(not(target_arch = "wasm32"))]
use relievo::{
    gpu::Buffer,
    ops::{
        animation::ModelMatrices,
        skinning::frame::{SkinFrame, SkinOptions},
    },
};

/// A model at one time of a clip, and how it is skinned.
#[derive(Debug, Clone, Copy)]
pub struct PosedModel<'a> {
    /// The model.
    pub model: &'a Model,
    /// The index of the clip among the model's clips.
    pub clip: usize,
    /// Time inside the clip, in seconds.
    pub time: f32,
    /// The influences that vertices follow.
    pub instance_lod: InstanceLod,
    /// The way in which influences are blended.
    pub blend: Blend,
}

/// The camera, size and colours of a square picture of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Portrait {
    /// Width and height of the picture, in pixels.
    pub edge: u32,
    /// Number of samples per pixel along each axis.
    pub finer: u32,
    /// Colour behind the model, in linear light.
    pub background: [f32; 3],
    /// Colour of meshes without a material, in linear light.
    pub clay: [f32; 3],
}

impl Portrait {
    /// Draws models that stand still, such as those of [`at_rest`](relievo::ops::skinning::at_rest()), a picture each, on the host. One camera sees
    /// all of them, with the first in the middle.
    ///
    /// # Errors
    /// [`InputError`] for a material or an image that a model lacks.
    pub fn on_host(&self, models: &[&Model]) -> Result<Vec<RgbaImage>, InputError> {
        let [view_from_model, clip_from_view] = framing_of(models);
        let drawn = |model: &&Model| {
            let vertices: Vec<_> = model.meshes.iter().map(vertices_of).collect();
            self.drawn(model, &vertices, clip_from_view * view_from_model)
        };
        models.iter().map(drawn).collect()
    }

    fn drawn(
        &self,
        model: &Model,
        vertices: &[Vec<Vertex>],
        clip_from_model: Mat4,
    ) -> Result<RgbaImage, InputError> {
        let size = [self.finer * self.edge; 2];
        let scene = Scene { clip_from_model, light: Light::default(), size };
        let surface = |mesh: &Mesh| {
            let material = model.material(mesh)?;
            Ok(material.map_or(Surface::plain(self.clay), |material| Surface::of(model, material)))
        };
        let surfaces = model.meshes.iter().map(surface).collect::<Result<Vec<_>, InputError>>()?;
        let parts: Vec<_> = (model.meshes.iter().zip(vertices).zip(&surfaces))
            .map(|((mesh, vertices), surface)| Part { mesh, level: 0, vertices, surface })
            .collect();
        Ok(scene.draw(&parts, self.background).reduced(self.finer).encoded())
    }
}

impl PosedModel<'_> {
    /// Skins every mesh, and draws all of them in the middle of a picture. Returns the vertices of each mesh
    /// in its own order, in the model's space, and the picture.
    ///
    /// # Errors
    /// [`InputError`] for vertices outside the range of `f32`, as large scales produce, and for a material or
    /// an image that the model lacks.
    pub fn on_host(&self, portrait: &Portrait) -> Result<(Vec<Vec<Vertex>>, RgbaImage), InputError> {
        let vertices = self.vertices()?;
        let picture = portrait.drawn(self.model, &vertices, framing(vertices.iter().flatten()))?;
        Ok((vertices, picture))
    }

    fn vertices(&self) -> Result<Vec<Vec<Vertex>>, InputError> {
        let model = self.model;
        let pose = Pose::on_host(&model.skeleton, &model.clips[self.clip], self.time);
        let skinned = model.meshes.iter().map(|mesh| {
            let palette = palette_for(&model.skins[mesh.skin], &pose.model_matrices, self.blend);
            skin(&morph(mesh, &self.weights(mesh)), &mesh.influences, &palette, self.instance_lod)
        });
        let skinned: Vec<Vec<Vertex>> = skinned.collect();
        skinned.iter().enumerate().try_for_each(|(mesh, vertices)| check_range(mesh, vertices))?;
        Ok(skinned)
    }

    /// Skins every mesh on the device. Returns the vertices of each mesh in its own order, in the model's space; they equal
    /// those of [`PosedModel::on_host`] within rounding. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for vertices outside the range of `f32`, as large scales produce; [`relievo::gpu::GpuError`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn on_device(&self, gpu: &relievo::gpu::Gpu) -> Result<Vec<Vec<Vertex>>, relievo::Error> {
        let model = self.model;
        let pose = pose(gpu, &model.skeleton, &model.clips[self.clip], self.time)?;
        let bones = ModelMatrices::new(&Buffer::from_slice(gpu, "bones", &pose.model_matrices)?);
        let skinned = |mesh: usize| {
            let options = SkinOptions { mesh, instances: 1, blend: self.blend };
            let frame = SkinFrame::new(gpu, model, &bones, options)?;
            frame.crowd.instance_lods.write(gpu, &[self.instance_lod])?;
            frame.crowd.weights.write(gpu, &self.weights(&model.meshes[mesh]))?;
            gpu.run("skin", |encoder| frame.record_updated_bones(encoder))?;
            let vertices = frame.read(gpu, 0)?;
            check_range(mesh, &vertices)?;
            Ok(vertices)
        };
        (0..model.meshes.len()).map(skinned).collect()
    }

    /// The weights of a mesh's morph targets at the time.
    fn weights(&self, mesh: &Mesh) -> Vec<f32> {
        mesh.weights_at(self.clip, self.time)
    }
}
