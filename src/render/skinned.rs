//! Draws skinned instances of a mesh into the caller's render pass: one indirect draw for all. A mesh has one material:
//! a model of several is drawn mesh by mesh.

use encase::ShaderType;
use glam::{Mat4, Vec4};

use crate::animation::transform::Affine;
use crate::gpu::{Buffer, Gpu, GpuError, Group, RenderPipeline, Uniform, bind, shaders};
use crate::render::albedo::Albedo;
use crate::render::pipeline::Draws;
use crate::skinning::buffers::MeshBuffers;
use crate::skinning::material::Alpha;
use crate::skinning::picture::Light;
use crate::skinning::skin::Vertex;
use crate::{Error, InputError};

/// `SkinnedView` of the shader.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct SkinnedView {
    pub clip_from_world: Mat4,
    pub light: Vec4,
    pub color: Vec4,
    pub vertices: u32,
    pub cutoff: f32,
}

/// The pipelines.
#[derive(Debug, Clone)]
pub struct SkinnedRenderer {
    /// Of meshes that are seen from outside, and from both sides; of each kind of alpha.
    pipelines: [[RenderPipeline; 3]; 2],
}

/// What is drawn.
#[derive(Debug, Clone, Copy)]
pub struct SkinnedInstances<'a> {
    /// Triangles and texture coordinates.
    pub mesh: &'a MeshBuffers,
    /// As [`crate::skinning::skin::SkinPass`] writes them.
    pub skinned: &'a Buffer<Vertex>,
    /// From the model's space into the world, one an instance.
    pub placements: &'a Buffer<Affine>,
    /// The instances that are drawn.
    pub drawn: &'a Buffer<u32>,
    /// Colour.
    pub albedo: &'a Albedo,
    /// What lights them.
    pub light: Light,
}

impl SkinnedRenderer {
    /// Compiles the pipelines, unless this device has them already, for targets of `color` format with a
    /// [`DEPTH_FORMAT`](crate::render::target::DEPTH_FORMAT) depth buffer.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, color: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let pipeline = |double_sided: bool, alpha: u32| {
            let draws = Draws {
                shader: &shaders::RENDER_SKINNED,
                fragment: "fragment",
                constants: &[("DOUBLE_SIDED", f64::from(double_sided)), ("ALPHA", f64::from(alpha))],
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull: (!double_sided).then_some(wgpu::Face::Back),
                vertices: &[],
            };
            let key = format!("{} {color:?} {double_sided} {alpha}", shaders::RENDER_SKINNED.name);
            gpu.render_pipelines.get(key, || draws.compile(gpu, color))
        };
        let sided = |double_sided| {
            Ok::<_, GpuError>([
                pipeline(double_sided, 0)?,
                pipeline(double_sided, 1)?,
                pipeline(double_sided, 2)?,
            ])
        };
        Ok(Self { pipelines: [sided(false)?, sided(true)?] })
    }

    /// Binds instances; all that `drawn` has room for are drawn until [`SkinnedScene::arguments`] says otherwise.
    ///
    /// # Errors
    /// [`InputError`] for too few vertices or places; [`GpuError`].
    pub fn scene(&self, gpu: &Gpu, instances: &SkinnedInstances<'_>) -> Result<SkinnedScene, Error> {
        let SkinnedInstances { mesh, skinned, placements, drawn, albedo, light } = *instances;
        light.validate()?;
        let vertices = mesh.vertices.len();
        let (kind, cutoff) = match albedo.alpha {
            Alpha::Opaque => (0, 0.0),
            Alpha::Mask(cutoff) => (1, cutoff),
            Alpha::Screen => (2, 0.0),
        };
        skinned.check_holds("skinned", vertices * placements.len())?;
        if drawn.len() > placements.len() {
            let bound = format!("must be at most {}, one a place", placements.len());
            return Err(InputError::new("drawn.len", drawn.len(), bound).into());
        }
        let view = SkinnedView {
            clip_from_world: Mat4::IDENTITY,
            light: light.direction.normalize().extend(light.ambient),
            color: albedo.factor.into(),
            vertices: vertices as u32,
            cutoff,
        };
        let uniform = Uniform::new(gpu, "skinned view", &view)?;
        let texture = albedo.texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let resources = [
            uniform.raw().as_entire_binding(),
            skinned.raw().as_entire_binding(),
            mesh.uv.raw().as_entire_binding(),
            placements.raw().as_entire_binding(),
            drawn.raw().as_entire_binding(),
            wgpu::BindingResource::TextureView(&texture),
            wgpu::BindingResource::Sampler(&albedo.texture.sampler),
        ];
        let (pipeline, layouts) = &self.pipelines[usize::from(mesh.double_sided)][kind];
        let group = bind(gpu, &shaders::RENDER_SKINNED, layouts, 0, &resources)?;
        let counts = [mesh.indices.len() as u32, drawn.len() as u32, 0, 0, 0];
        let arguments = Buffer::from_slice(gpu, "draw", &counts)?;
        let indices = mesh.indices.clone();
        Ok(SkinnedScene { pipeline: pipeline.clone(), view, uniform, group, indices, arguments })
    }
}

/// Instances of a mesh: set the camera, then draw in any render pass.
#[derive(Debug, Clone)]
pub struct SkinnedScene {
    /// Of the indirect draw: indices, instances, and three zeros. The caller or a kernel may change the second.
    pub arguments: Buffer<u32>,
    pipeline: wgpu::RenderPipeline,
    view: SkinnedView,
    uniform: Uniform<SkinnedView>,
    group: Group,
    indices: Buffer<u32>,
}

impl SkinnedScene {
    /// Chooses the camera of the next submission.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn set_camera(&mut self, gpu: &Gpu, clip_from_world: Mat4) -> Result<(), GpuError> {
        self.view.clip_from_world = clip_from_world;
        self.uniform.write(gpu, &self.view)
    }

    /// Draws the instances.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_index_buffer(self.indices.raw().slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed_indirect(self.arguments.raw(), 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(skinned_view_layout: SkinnedView = RENDER_SKINNED "SkinnedView");
}
