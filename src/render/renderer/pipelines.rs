//! Pipelines of a renderer: their keys, their sources, and their compilation.

use std::borrow::Cow;

use crate::gpu::{Gpu, GpuError, RenderProgram};
use crate::render::format::TargetFormat;
use crate::render::layer::Layer;
use crate::render::output::OutputProgram;
use crate::render::shading::Shading;
use crate::scene::caller_text::PREFIX;
use crate::scene::layouts::SceneLayouts;
use crate::scene::specialization::{Fade, OwnDepth, Program, Specialization};
use crate::scene::wgsl::entries::fragment_entry;

/// Key of a pipeline: a part of an object, a layer, and three options.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    layer: Layer,
    part: Specialization,
    /// Whether front-facing triangles run clockwise on the screen.
    is_flipped: bool,
    /// Whether shading looks up the sun's shadow map.
    is_shadowed: bool,
    /// How fading instances are drawn.
    fade: Fade,
}

impl PipelineKey {
    /// Key of a part in a layer, without the sun's shadow and without a fade.
    pub fn new(layer: Layer, part: &Specialization, is_flipped: bool) -> Self {
        let is_flipped = is_flipped && !part.state().double_sided;
        Self { layer, part: part.clone(), is_flipped, is_shadowed: false, fade: Fade::None }
    }

    /// This key with the sun's shadow if `is_shadowed` and the layer is shaded, otherwise without it.
    pub fn shadowed(self, is_shadowed: bool) -> Self {
        Self { is_shadowed: is_shadowed && self.layer.is_shaded(), ..self }
    }

    /// This key for instances that fade in this way.
    pub fn fading(self, fade: Fade) -> Self {
        Self { fade, ..self }
    }

    /// The pipeline's source for a target format. `casts`: the target is a shadow map, where both sides of triangles stop light.
    pub fn source(&self, format: &TargetFormat, casts: bool) -> PipelineSource {
        let (layer, state) = (self.layer, self.part.state());
        let own_depth = match state.own_depth {
            OwnDepth::Never => false,
            OwnDepth::Depth => layer == Layer::Depth,
            OwnDepth::Always => true,
        };
        // Without a depth attachment no shader may write depth.
        let deep = own_depth && format.depth.is_some();
        let discards = state.cut_out || self.fade == Fade::Dither;
        let is_plain_depth = layer == Layer::Depth && !discards && !deep;
        let own = format.output().filter(|_| layer == Layer::Own);
        // Opaque parts that fade are blended in the transparent layer, with the entry point of the colour layer.
        let written = if layer == Layer::Transparent && !state.blended { Layer::Color } else { layer };
        let entry = own.map_or(written.entry(), OutputProgram::entry);
        let moves = own.map_or(layer == Layer::Velocity, OutputProgram::moves);
        let entry = format!("{PREFIX}{}", fragment_entry(entry, discards, deep));
        let vertex = match (is_plain_depth, moves) {
            (true, _) => "vertex_depth",
            (false, true) => "vertex_moving",
            (false, false) => "vertex",
        };
        let constants = self.part.constants(layer.shown(), self.is_shadowed, format.is_reversed(), self.fade);
        let key = RenderProgram {
            shader: self.part.program().name().to_owned(),
            vertex: format!("{PREFIX}{vertex}"),
            // A pass with colour attachments needs a pipeline with a fragment stage.
            fragment: (!is_plain_depth || !format.color.is_empty()).then_some(entry),
            constants: constants.into_iter().map(|(name, value)| (name, value.to_bits())).collect(),
            // Front faces run counter-clockwise, unless flipped.
            cull: match (state.double_sided || casts, self.is_flipped) {
                (true, _) => None,
                (false, false) => Some(wgpu::Face::Back),
                (false, true) => Some(wgpu::Face::Front),
            },
            targets: format.targets(layer),
            depth: format.depth_state(layer),
            samples: format.samples,
        };
        PipelineSource { layer, program: self.part.program().clone(), key }
    }
}

/// The source of a pipeline: everything that differs between the pipelines of one renderer.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct PipelineSource {
    layer: Layer,
    program: Program,
    key: RenderProgram,
}

impl PipelineSource {
    /// Compiles the pipeline, with the caller's shading if there is one. If the text is the crate's alone, returns the pipeline
    /// that this device compiled before.
    ///
    /// # Errors
    /// Errors of the driver's shader compiler, and errors for a format that exceeds the device's limits.
    pub fn compiled(
        &self,
        gpu: &Gpu,
        format: &TargetFormat,
        layouts: &SceneLayouts,
        shading: Option<&Shading>,
    ) -> Result<wgpu::RenderPipeline, GpuError> {
        let shading = shading.filter(|_| self.layer.is_shaded());
        let output = format.output().filter(|_| self.layer == Layer::Own);
        let groups = layouts.of(gpu, &self.program)?;
        let own = shading.and_then(|shading| shading.layout.as_ref());
        let groups: Vec<_> = groups.iter().chain(own).map(Some).collect();
        let text =
            output.map_or(Cow::from(self.program.text()), |output| output.beside(&self.program).into());
        let text = shading.map(|shading| shading.text(&text).into()).unwrap_or(text);
        let is_ours = matches!(text, Cow::Borrowed(_)) && !matches!(self.program, Program::Own(_));
        let compile = || gpu.scoped(|| self.compile(gpu, text, &groups));
        if is_ours { gpu.pipelines.get(self.key.clone(), compile) } else { compile() }
    }

    fn compile(
        &self,
        gpu: &Gpu,
        text: Cow<'_, str>,
        groups: &[Option<&wgpu::BindGroupLayout>],
    ) -> wgpu::RenderPipeline {
        let (device, label, key) = (gpu.device(), Some(self.key.shader.as_str()), &self.key);
        let source = wgpu::ShaderSource::Wgsl(text);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let constants: Vec<_> =
            key.constants.iter().map(|(name, bits)| (*name, f64::from_bits(*bits))).collect();
        let options = || wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let layout = wgpu::PipelineLayoutDescriptor { label, bind_group_layouts: groups, immediate_size: 0 };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&device.create_pipeline_layout(&layout)),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(&key.vertex),
                compilation_options: options(),
                buffers: &[Some(INSTANCES)],
            },
            primitive: wgpu::PrimitiveState { cull_mode: key.cull, ..Default::default() },
            depth_stencil: key.depth.clone(),
            multisample: wgpu::MultisampleState { count: key.samples, ..Default::default() },
            fragment: key.fragment.as_deref().map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: options(),
                targets: &key.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The only vertex buffer. It has one word for each instance of a draw: the list entry of the instance.
const INSTANCES: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<u32>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &[wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Uint32,
        offset: 0,
        shader_location: 0,
    }],
};
