//! The pipelines of a renderer, by what they are compiled from.

use std::borrow::Cow;

use super::programs::Program;
use crate::gpu::{Gpu, GpuError};
use crate::render::format::TargetFormat;
use crate::render::layer::Layer;
use crate::render::shading::{PREFIX, Shading};
use crate::scene::TerrainStyle;
use crate::scene::drawable::{MeshMaterials, MeshPart, SurfaceKind};
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::PartMaterials;
use crate::surface::{ReliefOptions, Shadow};

/// What a surface needs of a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    /// A mesh with materials.
    Mesh { surface: SurfaceKind, normal_mapped: bool, textured: bool },
    /// A mesh with relief.
    Relief { double_sided: bool, options: ReliefOptions },
    /// Patches of terrain, seen from both sides.
    Terrain { style: TerrainStyle },
}

impl Kind {
    pub fn of(part: &MeshPart) -> Self {
        match &part.materials {
            MeshMaterials::Plain(materials) => {
                let PartMaterials { normal_mapped, textured, .. } = *materials;
                Self::Mesh { surface: part.surface, normal_mapped, textured }
            }
            MeshMaterials::Relief(relief) => {
                Self::Relief { double_sided: part.surface.double_sided, options: relief.options }
            }
        }
    }

    /// Whether a layer shows it.
    pub fn is_in(self, layer: Layer) -> bool {
        let is_blended = matches!(self, Self::Mesh { surface, .. } if surface.blended);
        is_blended == (layer == Layer::Transparent)
    }

    /// The same with both sides of triangles.
    pub fn two_sided(self) -> Self {
        match self {
            Self::Mesh { surface, normal_mapped, textured } => {
                let surface = SurfaceKind { double_sided: true, ..surface };
                Self::Mesh { surface, normal_mapped, textured }
            }
            Self::Relief { options, .. } => Self::Relief { double_sided: true, options },
            Self::Terrain { style } => Self::Terrain { style },
        }
    }

    /// The same without what has no influence on a layer.
    fn in_layer(self, layer: Layer) -> Self {
        let is_lit = layer.is_shaded();
        let has_normals = is_lit || layer == Layer::Surface;
        match self {
            Self::Mesh { surface, normal_mapped, textured } => Self::Mesh {
                surface,
                normal_mapped: normal_mapped && has_normals,
                textured: textured && (has_normals || surface.cut_out),
            },
            Self::Relief { double_sided, options } => {
                let shadow = if is_lit { options.shadow } else { Shadow::None };
                let normal_map = options.normal_map.filter(|_| has_normals);
                Self::Relief { double_sided, options: ReliefOptions { shadow, normal_map, ..options } }
            }
            Self::Terrain { style } => {
                Self::Terrain { style: if is_lit { style } else { TerrainStyle::Textured } }
            }
        }
    }

    /// Whether pixels are left out by their alpha.
    pub fn discards(self) -> bool {
        match self {
            Self::Mesh { surface, .. } => surface.cut_out,
            Self::Relief { options, .. } => options.silhouette,
            Self::Terrain { .. } => false,
        }
    }

    /// Whether a layer writes the depth of the surface and not that of the triangles.
    pub fn is_deep(self, layer: Layer) -> bool {
        matches!(self, Self::Relief { options, .. } if options.depth || layer == Layer::Depth)
    }

    /// Whether triangles that turn away are seen.
    fn is_double_sided(self) -> bool {
        match self {
            Self::Mesh { surface, .. } => surface.double_sided,
            Self::Relief { double_sided, .. } => double_sided,
            Self::Terrain { .. } => true,
        }
    }
}

/// A pipeline of a renderer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    layer: Layer,
    kind: Kind,
    /// Whether triangles seen from outside run clockwise on the screen.
    is_flipped: bool,
    /// Whether surfaces are looked up in the map of a sun's shadow.
    is_shadowed: bool,
}

impl PipelineKey {
    /// The key, with what makes no difference set to one value.
    pub fn new(layer: Layer, kind: Kind, is_flipped: bool) -> Self {
        let kind = kind.in_layer(layer);
        Self { layer, kind, is_flipped: is_flipped && !kind.is_double_sided(), is_shadowed: false }
    }

    /// The same in the shadow of a sun, if its layer is shaded, or without.
    pub fn shadowed(self, is_shadowed: bool) -> Self {
        Self { is_shadowed: is_shadowed && self.layer.is_shaded(), ..self }
    }

    /// Compiles it, with the caller's shading if there is any.
    ///
    /// # Errors
    /// What the driver's compiler reports, and what the device does not allow of the format.
    pub fn pipeline(
        &self,
        gpu: &Gpu,
        format: &TargetFormat,
        layouts: &SceneLayouts,
        shading: Option<&Shading>,
    ) -> Result<wgpu::RenderPipeline, GpuError> {
        let shading = shading.filter(|_| self.layer.is_shaded());
        let program = Program::new(self.layer, self.kind, format, self.is_shadowed);
        let groups = match self.kind {
            Kind::Mesh { .. } => layouts.of_mesh(),
            Kind::Relief { .. } => layouts.of_relief(),
            Kind::Terrain { .. } => layouts.of_terrain(),
        };
        let own = shading.and_then(|shading| shading.layout.as_ref());
        let groups: Vec<_> = groups.into_iter().chain(own).map(Some).collect();
        let text = shading.map_or(program.shader.source.into(), |shading| shading.text(program.shader));
        gpu.scoped(|| self.compile(gpu, format, (&program, text), &groups))
    }

    fn compile(
        &self,
        gpu: &Gpu,
        format: &TargetFormat,
        (program, text): (&Program, Cow<'static, str>),
        groups: &[Option<&wgpu::BindGroupLayout>],
    ) -> wgpu::RenderPipeline {
        let (device, label) = (gpu.device(), Some(program.shader.name));
        let source = wgpu::ShaderSource::Wgsl(text);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let options =
            || wgpu::PipelineCompilationOptions { constants: &program.constants, ..Default::default() };
        let targets = format.targets(self.layer);
        let layout = wgpu::PipelineLayoutDescriptor { label, bind_group_layouts: groups, immediate_size: 0 };
        let vertex = format!("{PREFIX}{}", program.vertex);
        let fragment = program.fragment.as_ref().map(|entry| format!("{PREFIX}{entry}"));
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&device.create_pipeline_layout(&layout)),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(&vertex),
                compilation_options: options(),
                buffers: &[Some(INSTANCES)],
            },
            primitive: wgpu::PrimitiveState { cull_mode: self.cull(), ..Default::default() },
            depth_stencil: format.depth_state(self.layer),
            multisample: wgpu::MultisampleState { count: format.samples, ..Default::default() },
            fragment: fragment.as_deref().map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: options(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// The faces that are left out. Triangles seen from outside run counter-clockwise, unless they are flipped.
    fn cull(&self) -> Option<wgpu::Face> {
        match (self.kind.is_double_sided(), self.is_flipped) {
            (true, _) => None,
            (false, false) => Some(wgpu::Face::Back),
            (false, true) => Some(wgpu::Face::Front),
        }
    }
}

/// The one vertex buffer: for each instance of a draw, its index in the object.
const INSTANCES: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<u32>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &[wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Uint32,
        offset: 0,
        shader_location: 0,
    }],
};
