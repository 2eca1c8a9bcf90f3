//! The pipelines of a renderer, by what they are compiled from.

use super::Layer;
use crate::gpu::bindings::render::{scene_mesh, scene_relief};
use crate::gpu::{Gpu, GpuError, module, shaders};
use crate::render::format::TargetFormat;
use crate::scene::drawable::{MeshMaterials, MeshPart, SurfaceKind};
use crate::scene::layouts::SceneLayouts;
use crate::surface::{Green, ReliefOptions, Shadow};

/// What a surface needs of a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    /// A mesh with materials.
    Mesh {
        surface: SurfaceKind,
        normal_mapped: bool,
        /// Whether the only material of an opaque part without a normal map has a texture; `None` for other parts.
        only_textured: Option<bool>,
    },
    /// A mesh with relief.
    Relief { double_sided: bool, options: ReliefOptions },
    /// Patches of terrain, seen from both sides.
    Terrain,
}

impl Kind {
    pub fn of(part: &MeshPart) -> Self {
        match &part.materials {
            MeshMaterials::Plain(materials) => {
                let (surface, normal_mapped) = (part.surface, materials.normal_mapped);
                let is_plain = !surface.cut_out && !normal_mapped;
                Self::Mesh {
                    surface,
                    normal_mapped,
                    only_textured: materials.only_textured.filter(|_| is_plain),
                }
            }
            MeshMaterials::Relief(relief) => {
                Self::Relief { double_sided: part.surface.double_sided, options: relief.options }
            }
        }
    }

    /// The same without what has no influence on depth.
    fn without_shading(self) -> Self {
        match self {
            Self::Mesh { surface, .. } => Self::Mesh { surface, normal_mapped: false, only_textured: None },
            Self::Relief { double_sided, options } => {
                let options = ReliefOptions { shadow: Shadow::None, normal_map: None, ..options };
                Self::Relief { double_sided, options }
            }
            Self::Terrain => Self::Terrain,
        }
    }

    /// Whether triangles that turn away are seen.
    fn is_double_sided(self) -> bool {
        match self {
            Self::Mesh { surface, .. } => surface.double_sided,
            Self::Relief { double_sided, .. } => double_sided,
            Self::Terrain => true,
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
}

/// The shader of a pipeline with its entry points and constants.
struct Program {
    shader: &'static shaders::Shader,
    vertex: &'static str,
    /// None where depth alone is written and nothing is left out.
    fragment: Option<&'static str>,
    constants: Vec<(&'static str, f64)>,
}

impl PipelineKey {
    /// The key, with what makes no difference set to one value.
    pub fn new(layer: Layer, kind: Kind, is_flipped: bool) -> Self {
        let kind = if layer == Layer::Depth { kind.without_shading() } else { kind };
        Self { layer, kind, is_flipped: is_flipped && !kind.is_double_sided() }
    }

    /// Compiles it.
    ///
    /// # Errors
    /// What the driver's compiler reports, and what the device does not allow of the format.
    pub fn pipeline(
        &self,
        gpu: &Gpu,
        format: &TargetFormat,
        layouts: &SceneLayouts,
    ) -> Result<wgpu::RenderPipeline, GpuError> {
        let program = self.program(format);
        let groups = match self.kind {
            Kind::Mesh { .. } => layouts.of_mesh(),
            Kind::Relief { .. } => layouts.of_relief(),
            Kind::Terrain => layouts.of_terrain(),
        };
        gpu.scoped(|| self.compile(gpu, format, &program, &groups.map(Some)))
    }

    fn compile(
        &self,
        gpu: &Gpu,
        format: &TargetFormat,
        program: &Program,
        groups: &[Option<&wgpu::BindGroupLayout>],
    ) -> wgpu::RenderPipeline {
        let (device, label) = (gpu.device(), Some(program.shader.name));
        let module = module(gpu, program.shader);
        let options =
            || wgpu::PipelineCompilationOptions { constants: &program.constants, ..Default::default() };
        let targets = format.targets(self.layer == Layer::Color);
        let layout = wgpu::PipelineLayoutDescriptor { label, bind_group_layouts: groups, immediate_size: 0 };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&device.create_pipeline_layout(&layout)),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(program.vertex),
                compilation_options: options(),
                buffers: &[Some(INSTANCES)],
            },
            primitive: wgpu::PrimitiveState { cull_mode: self.cull(), ..Default::default() },
            depth_stencil: format.depth_state(),
            multisample: wgpu::MultisampleState { count: format.samples, ..Default::default() },
            fragment: program.fragment.map(|entry| wgpu::FragmentState {
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

    fn program(&self, format: &TargetFormat) -> Program {
        // A pipeline without a fragment stage fits no pass with colours.
        let depth_opaque = (!format.color.is_empty()).then_some("depth_opaque");
        match (self.kind, self.layer) {
            (Kind::Mesh { surface, only_textured: Some(textured), .. }, Layer::Color) => Program {
                shader: &shaders::RENDER_SCENE_MESH,
                vertex: "vertex_plain",
                fragment: Some("opaque_plain"),
                constants: scene_mesh::Constants { double_sided: surface.double_sided, textured }.list(),
            },
            (Kind::Mesh { surface, normal_mapped, .. }, layer) => Program {
                shader: &shaders::RENDER_SCENE_MESH,
                vertex: if normal_mapped { "vertex_bumpy" } else { "vertex" },
                fragment: match (layer, surface.cut_out, normal_mapped) {
                    (Layer::Color, false, false) => Some("opaque"),
                    (Layer::Color, false, true) => Some("opaque_bumpy"),
                    (Layer::Color, true, false) => Some("cut_out"),
                    (Layer::Color, true, true) => Some("cut_out_bumpy"),
                    (Layer::Depth, false, _) => depth_opaque,
                    (Layer::Depth, true, _) => Some("depth_cut_out"),
                },
                constants: scene_mesh::Constants { double_sided: surface.double_sided, textured: false }
                    .list(),
            },
            (Kind::Relief { options, .. }, layer) => Program {
                shader: &shaders::RENDER_SCENE_RELIEF,
                vertex: "vertex",
                fragment: Some(match layer {
                    Layer::Depth => "depth_relief",
                    // Without a depth attachment no shader may write depth.
                    Layer::Color if options.depth && format.depth.is_some() => "fragment_deep",
                    Layer::Color => "fragment",
                }),
                constants: relief_constants(&options, format.is_reversed()).list(),
            },
            (Kind::Terrain, layer) => Program {
                shader: &shaders::RENDER_SCENE_TERRAIN,
                vertex: "vertex",
                fragment: if layer == Layer::Color { Some("fragment") } else { depth_opaque },
                constants: Vec::new(),
            },
        }
    }
}

fn relief_constants(options: &ReliefOptions, reversed: bool) -> scene_relief::Constants {
    scene_relief::Constants {
        method: options.method.code(),
        shadow: options.shadow as u32,
        normal_map: options.normal_map.is_some(),
        green_up: options.normal_map == Some(Green::Up),
        silhouette: options.silhouette,
        choose_mip: options.chooses_mip(),
        own_depth: options.depth,
        reversed,
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
