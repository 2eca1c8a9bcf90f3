//! Draws meshes with relief in the caller's render pass.

use glam::{Mat4, Vec4};

use crate::gpu::{Gpu, GpuError, Group, Uniform, shaders};
use crate::render::color::ColorTexture;
use crate::render::pipeline::{Draws, bind};
use crate::shared::render::relief::ReliefView;
use crate::shared::surface::ray::SurfaceMarch;
use crate::surface::material::{Green, Material, Shadow};
use crate::surface::mesh::{SurfaceMesh, SurfaceVertex};
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::relief::{March, Method};
use crate::{Error, InputError};

/// Options that are fixed when a pipeline is compiled. [`Material`] has the parameters that may change without
/// a new pipeline.
///
/// The default uses [`Method::Quadtree`], without shadow, with normals from the heights, without silhouette,
/// with the polygon's depth, and with mip level 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReliefOptions {
    /// The method that finds the surface; the [`SurfaceTextures`] must be made for it.
    pub method: Method,
    /// Self-shadow.
    pub shadow: Shadow,
    /// If set, normals come from a normal map whose green channel points in this direction; otherwise they
    /// follow from the heights.
    pub normal_map: Option<Green>,
    /// Whether to discard points outside the mesh's range of uv, so that silhouettes follow the relief.
    pub silhouette: bool,
    /// Whether to write the depth of the relief and not that of the polygon. This disables early depth tests.
    pub depth: bool,
    /// Whether to choose the mip level of the heights from the size of a pixel. Acceleration maps belong to
    /// level 0, so that `cone` and `quadtree` always march there.
    pub mip: bool,
}

impl Default for ReliefOptions {
    fn default() -> Self {
        Self {
            method: Method::Quadtree,
            shadow: Shadow::None,
            normal_map: None,
            silhouette: false,
            depth: false,
            mip: false,
        }
    }
}

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

/// The maps of a material.
#[derive(Debug, Clone, Copy)]
pub struct ReliefMaps<'a> {
    /// Heights and their acceleration map.
    pub textures: &'a SurfaceTextures,
    /// Colour, sRGB.
    pub albedo: &'a ColorTexture,
    /// Tangent-space normals: required if [`ReliefOptions::normal_map`] is set, else ignored.
    pub normals: Option<&'a ColorTexture>,
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
        let accelerated = matches!(options.method, Method::Cone | Method::Quadtree);
        let flag = |on: bool| f64::from(u8::from(on));
        let constants = [
            ("METHOD", f64::from(options.method.code())),
            ("SHADOW", f64::from(options.shadow as u32)),
            ("NORMAL_MAP", flag(options.normal_map.is_some())),
            ("GREEN_UP", flag(options.normal_map == Some(Green::Up))),
            ("SILHOUETTE", flag(options.silhouette)),
            ("CHOOSE_MIP", flag(options.mip && !accelerated)),
        ];
        let draws = Draws {
            shader: &shaders::RENDER_RELIEF,
            fragment: if options.depth { "fragment_depth" } else { "fragment" },
            constants: &constants,
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
