//! Calls single functions of shaders on the adapter, as they are shipped.

use relievo::gpu::shaders::Shader;
use relievo::gpu::{Buffer, Gpu};

/// Runs `body`, statements of WGSL, for each element of `given`. It reads `given[at]` and writes `found[at]`,
/// both `vec4<u32>`, and may call every function of the shader.
pub fn called(gpu: &Gpu, shader: &Shader, body: &str, given: &[[u32; 4]]) -> Vec<[u32; 4]> {
    let source = format!(
        "{}
@group(0) @binding(0) var<storage, read> given: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read_write> found: array<vec4<u32>>;
@compute @workgroup_size(64)
fn called(@builtin(global_invocation_id) id: vec3<u32>) {{
    let at = id.x;
    if at < arrayLength(&given) {{
        {body}
    }}
}}",
        shader.source
    );
    let source = wgpu::ShaderSource::Wgsl(source.into());
    let [given_buffer, found] =
        ["given", "found"].map(|label| Buffer::from_slice(gpu, label, given).expect("fits"));
    let work = || {
        let device = gpu.device();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("called"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let entries = [(0, &given_buffer), (1, &found)].map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.raw().as_entire_binding(),
        });
        let layout = pipeline.get_bind_group_layout(0);
        let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries };
        (device.create_bind_group(&descriptor), pipeline)
    };
    let (group, pipeline) = gpu.scoped(work).expect("compiled");
    gpu.run("called", |encoder| {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(given.len().div_ceil(64) as u32, 1, 1);
    })
    .expect("run");
    found.read_blocking(gpu).expect("read")
}
