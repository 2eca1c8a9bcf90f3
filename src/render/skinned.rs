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

/// Draws meshes on targets of a format.
#[derive(Debug, Clone)]
pub struct SkinnedRenderer {
    color: wgpu::TextureFormat,
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
    /// Compiles the pipelines of what is opaque, unless this device has them already, for targets of `color` format with
    /// a [`DEPTH_FORMAT`](crate::render::target::DEPTH_FORMAT) depth buffer. The first mesh that is not compiles its own.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, color: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let renderer = Self { color };
        for double_sided in [false, true] {
            renderer.pipeline(gpu, double_sided, Alpha::Opaque)?;
        }
        Ok(renderer)
    }

    fn pipeline(&self, gpu: &Gpu, double_sided: bool, alpha: Alpha) -> Result<RenderPipeline, GpuError> {
        let draws = Draws {
            shader: &shaders::RENDER_SKINNED,
            fragment: match alpha {
                Alpha::Opaque => "opaque",
                Alpha::Mask(_) => "masked",
                Alpha::Screen => "screened",
            },
            constants: &[("DOUBLE_SIDED", f64::from(double_sided))],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: (!double_sided).then_some(wgpu::Face::Back),
            vertices: &[],
        };
        let key = format!("{} {:?} {double_sided} {}", draws.shader.name, self.color, draws.fragment);
        gpu.render_pipelines.get(key, || draws.compile(gpu, self.color))
    }

    /// Binds instances; all that `drawn` has room for are drawn until [`SkinnedScene::arguments`] says otherwise.
    ///
    /// # Errors
    /// [`InputError`] for too few vertices or places; [`GpuError`].
    pub fn scene(&self, gpu: &Gpu, instances: &SkinnedInstances<'_>) -> Result<SkinnedScene, Error> {
        let SkinnedInstances { mesh, skinned, placements, drawn, albedo, light } = *instances;
        light.validate()?;
        let vertices = mesh.vertices.len();
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
            cutoff: if let Alpha::Mask(cutoff) = albedo.alpha { cutoff } else { 0.0 },
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
        let (pipeline, layouts) = self.pipeline(gpu, mesh.double_sided, albedo.alpha)?;
        let group = bind(gpu, &shaders::RENDER_SKINNED, &layouts, 0, &resources)?;
        let counts = [mesh.indices.len() as u32, drawn.len() as u32, 0, 0, 0];
        let arguments = Buffer::from_slice(gpu, "draw", &counts)?;
        let indices = mesh.indices.clone();
        Ok(SkinnedScene { pipeline, view, uniform, group, indices, arguments })
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
