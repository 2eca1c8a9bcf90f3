//! Render pipelines of this crate's shaders: vertex entry point `vertex`, opaque colour, and the depth test
//! `Less`.

use crate::gpu::{Gpu, GpuError, RenderPipeline, layouts, module, pipeline_layout, shaders::Shader};
use crate::render::target::DEPTH_FORMAT;

/// The properties in which pipelines differ.
pub(super) struct Draws<'a> {
    pub shader: &'static Shader,
    pub fragment: &'a str,
    pub constants: &'a [(&'a str, f64)],
    pub topology: wgpu::PrimitiveTopology,
    /// The faces that are culled.
    pub cull: Option<wgpu::Face>,
    pub vertices: &'a [Option<wgpu::VertexBufferLayout<'a>>],
}

impl Draws<'_> {
    /// Compiles the pipeline for targets of `color` format with a [`DEPTH_FORMAT`] depth buffer.
    pub fn compile(&self, gpu: &Gpu, color: wgpu::TextureFormat) -> Result<RenderPipeline, GpuError> {
        let shader = self.shader;
        let layouts = layouts(gpu, shader)?;
        let options = || wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() };
        let pipeline = gpu.scoped(|| {
            let module = module(gpu, shader);
            gpu.device().create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(shader.name),
                layout: Some(&pipeline_layout(gpu, shader, &layouts)),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vertex"),
                    compilation_options: options(),
                    buffers: self.vertices,
                },
                primitive: wgpu::PrimitiveState {
                    topology: self.topology,
                    cull_mode: self.cull,
                    ..Default::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(self.fragment),
                    compilation_options: options(),
                    targets: &[Some(color.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        })?;
        Ok((pipeline, layouts))
    }
}
