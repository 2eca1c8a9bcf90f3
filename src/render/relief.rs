//! Draws meshes with relief in the caller's render pass.

use glam::{Mat4, Vec4};

use crate::gpu::bindings::render::relief::Constants;
use crate::gpu::{Gpu, GpuError, Group, Uniform, shaders};
use crate::render::pipeline::{Draws, bind};
use crate::shared::render::relief::ReliefView;
use crate::shared::surface::ray::SurfaceMarch;
use crate::surface::mesh::{SurfaceMesh, SurfaceVertex};
use crate::surface::relief::March;
use crate::surface::{Green, Material};
pub use crate::surface::{ReliefMaps, ReliefOptions};
use crate::{Error, InputError};

/// Draws meshes with relief on targets of one format.
#[derive(Debug, Clone)]
pub struct ReliefRenderer {
    pipeline: wgpu::RenderPipeline,
    layouts: Vec<wgpu::BindGroupLayout>,
    options: ReliefOptions,
}

/// The view of a relief.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReliefCamera {
    /// The matrix from world space to clip space, depth 0 to 1.
    pub clip_from_world: Mat4,
    /// The position of the eye with w = 1, or for a parallel projection the direction towards it with w = 0.
    pub eye: Vec4,
}

/// The override constants of options.
fn constants(options: &ReliefOptions) -> Constants {
    Constants {
        method: options.method.code(),
        shadow: options.shadow as u32,
        normal_map: options.normal_map.is_some(),
        green_up: options.normal_map == Some(Green::Up),
        silhouette: options.silhouette,
        choose_mip: options.chooses_mip(),
    }
}

const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2];

impl ReliefRenderer {
    /// Compiles the pipeline, unless it is cached for this device, for targets of `color` format with a
    /// [`DEPTH_FORMAT`](crate::render::target::DEPTH_FORMAT) depth buffer.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, color: wgpu::TextureFormat, options: ReliefOptions) -> Result<Self, GpuError> {
        let draws = Draws {
            shader: &shaders::RENDER_RELIEF,
            fragment: if options.depth { "fragment_depth" } else { "fragment" },
            constants: &constants(&options).list(),
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: None,
            vertices: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<SurfaceVertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &ATTRIBUTES,
            })],
        };
        let (pipeline, layouts) = draws.pipeline(gpu, color)?;
        Ok(Self { pipeline, layouts, options })
    }

    /// Uploads a mesh and binds its material. `world` is the length of a uv unit in world units.
    ///
    /// # Errors
    /// [`InputError`] for arguments that do not match each other; [`GpuError`].
    pub fn scene(
        &self,
        gpu: &Gpu,
        mesh: &SurfaceMesh,
        maps: ReliefMaps<'_>,
        material: &Material,
        march: &March,
        world: f32,
    ) -> Result<ReliefScene, Error> {
        mesh.validate()?;
        material.validate()?;
        march.validate()?;
        maps.textures.check(self.options.method, march)?;
        if self.options.normal_map.is_some() && maps.normals.is_none() {
            let bound = "must be a normal map, for which the pipeline was compiled";
            return Err(InputError::new("maps.normals", "nothing", bound).into());
        }
        let light = glam::Vec3::from(material.light).extend(material.ambient);
        let view = ReliefView {
            clip_from_world: Mat4::IDENTITY,
            eye: Vec4::W,
            light,
            range: uv_range(mesh),
            scale: material.scale,
            plane: material.plane,
            world,
            shadow_steps: material.shadow_steps,
            softness: material.softness,
        };
        let uniform = Uniform::new(gpu, "relief view", &view)?;
        let group = self.bind(gpu, maps, march, &uniform)?;
        let vertices = upload(gpu, bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX)?;
        let indices = upload(gpu, bytemuck::cast_slice(&mesh.indices), wgpu::BufferUsages::INDEX)?;
        let count = mesh.indices.len() as u32;
        Ok(ReliefScene { pipeline: self.pipeline.clone(), view, uniform, group, vertices, indices, count })
    }

    fn bind(
        &self,
        gpu: &Gpu,
        maps: ReliefMaps<'_>,
        march: &March,
        uniform: &Uniform<ReliefView>,
    ) -> Result<Group, GpuError> {
        let settings = Uniform::new(gpu, "march", &SurfaceMarch::from(*march))?;
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let textures = [
            view(&maps.textures.heights),
            view(&maps.textures.acceleration),
            view(&maps.albedo.texture),
            view(&maps.normals.unwrap_or(maps.albedo).texture),
        ];
        let mut resources = vec![uniform.raw().as_entire_binding(), settings.raw().as_entire_binding()];
        resources.extend(textures.iter().map(wgpu::BindingResource::TextureView));
        resources.push(wgpu::BindingResource::Sampler(&maps.albedo.sampler));
        bind(gpu, &shaders::RENDER_RELIEF, &self.layouts, 0, &resources)
    }
}

fn uv_range(mesh: &SurfaceMesh) -> Vec4 {
    let all = mesh.vertices.iter().map(|vertex| glam::Vec2::from(vertex.uv));
    let (low, high) =
        all.fold((glam::Vec2::MAX, glam::Vec2::MIN), |(low, high), uv| (low.min(uv), high.max(uv)));
    Vec4::new(low.x, low.y, high.x, high.y)
}

fn upload(gpu: &Gpu, bytes: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, GpuError> {
    let buffer = gpu.scoped(|| {
        gpu.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("relief mesh"),
            size: (bytes.len() as u64).max(4),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })?;
    gpu.scoped(|| gpu.queue().write_buffer(&buffer, 0, bytes))?;
    Ok(buffer)
}

/// A mesh with relief: set the camera, then draw in any render pass.
#[derive(Debug, Clone)]
pub struct ReliefScene {
    pipeline: wgpu::RenderPipeline,
    view: ReliefView,
    uniform: Uniform<ReliefView>,
    group: Group,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl ReliefScene {
    /// Sets the camera of the next submission.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn set_camera(&mut self, gpu: &Gpu, camera: ReliefCamera) -> Result<(), GpuError> {
        self.view.clip_from_world = camera.clip_from_world;
        self.view.eye = camera.eye;
        self.uniform.write(gpu, &self.view)
    }

    /// Draws the mesh.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
    }
}
