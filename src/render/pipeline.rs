//! Render pipelines of this crate's shaders (vertex entry point `vertex`, opaque colour, and the depth test `Less`)
//! and their bind groups.

use crate::gpu::{
    Drawing, Gpu, GpuError, Group, Program, RenderPipeline, layouts, module, pipeline_layout, shaders::Shader,
};
use crate::render::target::DEPTH_FORMAT;

/// The properties in which pipelines differ.
pub(super) struct Draws<'a> {
    pub shader: &'static Shader,
    pub fragment: &'static str,
    pub constants: &'a [(&'static str, f64)],
    pub topology: wgpu::PrimitiveTopology,
    /// The faces that are culled.
    pub cull: Option<wgpu::Face>,
    pub vertices: &'a [Option<wgpu::VertexBufferLayout<'a>>],
}

impl Draws<'_> {
    /// The pipeline for targets of `color` format with a [`DEPTH_FORMAT`] depth buffer: compiled, unless this device has
    /// it already.
    pub fn pipeline(&self, gpu: &Gpu, color: wgpu::TextureFormat) -> Result<RenderPipeline, GpuError> {
        let drawing = Drawing {
            program: Program::new(self.shader, self.constants),
            fragment: self.fragment,
            color,
            topology: self.topology,
            cull: self.cull,
        };
        gpu.render_pipelines.get(drawing, || self.compile(gpu, color))
    }

    fn compile(&self, gpu: &Gpu, color: wgpu::TextureFormat) -> Result<RenderPipeline, GpuError> {
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

/// Binds the resources of one group, in the order of their bindings.
///
/// # Errors
/// [`GpuError::Validation`] when they do not fit the shader.
pub(super) fn bind(
    gpu: &Gpu,
    shader: &Shader,
    layouts: &[wgpu::BindGroupLayout],
    group: u32,
    resources: &[wgpu::BindingResource<'_>],
) -> Result<Group, GpuError> {
    let entries: Vec<_> = (shader.bindings.iter().filter(|binding| binding.group == group))
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding: binding.binding,
            resource: resource.clone(),
        })
        .collect();
    gpu.scoped(|| {
        gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(shader.name),
            layout: &layouts[group as usize],
            entries: &entries,
        })
    })
}
