//! Compute pipelines and bind groups. Their layouts come from the manifest that `relievo-shaders` generates.

use super::shaders::{Binding, BindingKind, Shader, Stage};
use super::{Gpu, GpuError, Program};

/// A compute pipeline of one shader, with its override constants set.
#[derive(Debug, Clone)]
pub struct Kernel {
    shader: &'static Shader,
    pub(super) pipeline: wgpu::ComputePipeline,
    pub(crate) layouts: Layouts,
}

/// Declares a pass with a single pipeline. `bindings` must name the generated module of its kernel.
macro_rules! pass {
    ($(#[$documentation:meta])* pub struct $name:ident;) => {
        $(#[$documentation])*
        #[derive(Debug, Clone)]
        pub struct $name {
            kernel: $crate::gpu::Kernel,
        }

        impl $name {
            /// Compiles the pipeline.
            ///
            /// # Errors
            /// [`GpuError`](crate::gpu::GpuError) if the driver cannot compile the kernel.
            pub fn new(gpu: &$crate::gpu::Gpu) -> Result<Self, $crate::gpu::GpuError> {
                Ok(Self { kernel: bindings::kernel(gpu)? })
            }
        }
    };
}

pub(crate) use pass;

/// A bind group of a kernel.
pub type Group = wgpu::BindGroup;

impl Kernel {
    /// Compiles the pipeline, or returns the pipeline that this device compiled before with the same constants. `constants`
    /// sets all override constants, as `gpu::bindings` lists them.
    ///
    /// # Errors
    /// Errors of the driver's compiler, and [`GpuError::Limit`] if the shader exceeds a limit of the device.
    pub fn new(
        gpu: &Gpu,
        shader: &'static Shader,
        constants: &[(&'static str, f64)],
    ) -> Result<Self, GpuError> {
        gpu.kernels.get(Program::new(shader, constants), || Self::compile(gpu, shader, constants))
    }

    fn compile(
        gpu: &Gpu,
        shader: &'static Shader,
        constants: &[(&'static str, f64)],
    ) -> Result<Self, GpuError> {
        let layouts = Layouts::new(gpu, shader)?;
        let pipeline = gpu.scoped(|| {
            gpu.device().create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(shader.name),
                layout: Some(&pipeline_layout(gpu, shader, &layouts.groups)),
                module: &module(gpu, shader),
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants,
                    // Zeroing is not needed: every kernel writes workgroup memory before it reads it.
                    zero_initialize_workgroup_memory: false,
                },
                cache: None,
            })
        })?;
        Ok(Self { shader, pipeline, layouts })
    }

    /// Workgroup counts for `invocations` threads along x. If x alone cannot hold all workgroups, they are spread over x and y.
    pub fn spread(&self, gpu: &Gpu, invocations: u32) -> [u32; 3] {
        rows_of_workgroups(gpu, self.groups_for(invocations).max(1))
    }

    /// Number of threads per workgroup along x, y and z.
    pub fn workgroup_size(&self) -> [u32; 3] {
        self.shader.entry_points.first().map_or([1; 3], |entry| entry.workgroup_size)
    }

    /// Number of workgroups that `invocations` threads along x need.
    pub(crate) fn groups_for(&self, invocations: u32) -> u32 {
        invocations.div_ceil(self.workgroup_size()[0].max(1))
    }
}

/// The bind group layouts of a shader: one per group, from 0 to the last group that the shader uses.
#[derive(Debug, Clone)]
pub struct Layouts {
    shader: &'static Shader,
    pub(crate) groups: Vec<wgpu::BindGroupLayout>,
}

impl Layouts {
    /// Creates the bind group layouts of `shader`.
    ///
    /// # Errors
    /// [`GpuError::Limit`] if the shader binds more than the device allows.
    pub(crate) fn new(gpu: &Gpu, shader: &'static Shader) -> Result<Self, GpuError> {
        gpu.check_limits(shader)?;
        Ok(Self { shader, groups: layouts(gpu, shader)? })
    }

    /// Creates a bind group from resources and their binding numbers, as `gpu::bindings` lists them.
    ///
    /// # Errors
    /// [`GpuError::Internal`] if the layouts belong to another shader. [`GpuError::Validation`] if the resources do not match
    /// the shader.
    pub(crate) fn bind_group(
        &self,
        gpu: &Gpu,
        shader: &'static Shader,
        group: u32,
        resources: &[(u32, wgpu::BindingResource<'_>)],
    ) -> Result<Group, GpuError> {
        if self.shader.name != shader.name {
            let reason = format!("resources of {} for {}", shader.name, self.shader.name);
            return Err(GpuError::Internal { reason });
        }
        let resources = resources.iter().cloned();
        let entries: Vec<_> =
            resources.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        gpu.scoped(|| {
            gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(shader.name),
                layout: &self.groups[group as usize],
                entries: &entries,
            })
        })
    }
}

/// Workgroup counts along x, y and z for a total of at least `groups` workgroups, in rows as long as the device permits. For 0
/// groups, the count along y is 0.
pub(crate) fn rows_of_workgroups(gpu: &Gpu, groups: u32) -> [u32; 3] {
    let x = groups.clamp(1, gpu.device().limits().max_compute_workgroups_per_dimension);
    [x, groups.div_ceil(x), 1]
}

/// Creates the shader module from the WGSL text.
fn module(gpu: &Gpu, shader: &'static Shader) -> wgpu::ShaderModule {
    gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(shader.name),
        source: wgpu::ShaderSource::Wgsl(shader.source.into()),
    })
}

/// Creates a pipeline layout from the layouts of all bind groups.
fn pipeline_layout(gpu: &Gpu, shader: &Shader, layouts: &[wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
    gpu.device().create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(shader.name),
        bind_group_layouts: &layouts.iter().map(Some).collect::<Vec<_>>(),
        immediate_size: 0,
    })
}

/// Creates the bind group layouts of a shader: one per group, from 0 to the last group that the shader uses.
fn layouts(gpu: &Gpu, shader: &Shader) -> Result<Vec<wgpu::BindGroupLayout>, GpuError> {
    let groups = shader.bindings.iter().map(|binding| binding.group + 1).max().unwrap_or(0);
    gpu.scoped(|| {
        (0..groups)
            .map(|group| {
                let bindings = shader.bindings.iter().filter(|binding| binding.group == group);
                let entries: Vec<_> = bindings.map(layout_entry).collect();
                gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                    label: Some(shader.name),
                    entries: &entries,
                })
            })
            .collect()
    })
}

fn layout_entry(binding: &Binding) -> wgpu::BindGroupLayoutEntry {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let texture = |filterable, view_dimension| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension,
        multisampled: false,
    };
    let depth_texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let visibility = (binding.stages.iter())
        .map(|stage| match stage {
            Stage::Vertex => wgpu::ShaderStages::VERTEX,
            Stage::Fragment => wgpu::ShaderStages::FRAGMENT,
            Stage::Compute => wgpu::ShaderStages::COMPUTE,
        })
        .collect();
    let ty = match binding.kind {
        BindingKind::Uniform => buffer(wgpu::BufferBindingType::Uniform),
        BindingKind::StorageRead => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
        BindingKind::StorageReadWrite => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
        BindingKind::TextureArray => texture(true, wgpu::TextureViewDimension::D2Array),
        BindingKind::Texture => texture(true, wgpu::TextureViewDimension::D2),
        BindingKind::LoadedTexture => texture(false, wgpu::TextureViewDimension::D2),
        BindingKind::DepthTexture => depth_texture,
        BindingKind::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        BindingKind::ComparisonSampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
    };
    wgpu::BindGroupLayoutEntry { binding: binding.binding, visibility, ty, count: None }
}
