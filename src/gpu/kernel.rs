//! Compute pipelines and bind groups, laid out by the manifest that `build.rs` wrote.

use super::shaders::{Binding, BindingKind, Shader, Stage};
use super::{Gpu, GpuError};

/// A compute pipeline of one shader with its override constants set.
#[derive(Debug, Clone)]
pub struct Kernel {
    shader: &'static Shader,
    pub(super) pipeline: wgpu::ComputePipeline,
    layouts: Vec<wgpu::BindGroupLayout>,
}

/// Something to bind.
pub type Resource<'a> = wgpu::BindingResource<'a>;

/// Bind groups of one kernel, in order.
pub type Group = wgpu::BindGroup;

impl Kernel {
    /// Compiles the pipeline, or shares the same one that was compiled on this device before. `overrides` sets
    /// override constants by name.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, shader: &'static Shader, overrides: &[(&str, f64)]) -> Result<Self, GpuError> {
        let key = format!("{} {overrides:?}", shader.name);
        gpu.kernels.get(key, || Self::compile(gpu, shader, overrides))
    }

    fn compile(gpu: &Gpu, shader: &'static Shader, overrides: &[(&str, f64)]) -> Result<Self, GpuError> {
        let layouts = layouts(gpu, shader)?;
        let pipeline = gpu.scoped(|| {
            gpu.device().create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(shader.name),
                layout: Some(&pipeline_layout(gpu, shader, &layouts)),
                module: &module(gpu, shader),
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: overrides,
                    // Every kernel writes all of what it reads from workgroup memory.
                    zero_initialize_workgroup_memory: false,
                },
                cache: None,
            })
        })?;
        Ok(Self { shader, pipeline, layouts })
    }

    /// Binds the resources of one group, in the order of their bindings.
    ///
    /// # Errors
    /// [`GpuError::Validation`] when they do not fit the shader.
    pub fn bind(&self, gpu: &Gpu, group: u32, resources: &[Resource<'_>]) -> Result<Group, GpuError> {
        bind(gpu, self.shader, &self.layouts, group, resources)
    }

    /// Workgroups for `invocations` in one row, spread over x and y where they exceed the limit of a dimension.
    pub fn spread(&self, gpu: &Gpu, invocations: u32) -> [u32; 3] {
        rows_of_workgroups(gpu, self.groups_for(invocations).max(1))
    }

    /// Records a compute pass of one dispatch, whose workgroups along x, y and z are the three words of a buffer
    /// from a byte on.
    pub fn dispatch_indirect(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        label: &'static str,
        group: &Group,
        (arguments, offset): (&wgpu::Buffer, u64),
    ) {
        let descriptor = wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups_indirect(arguments, offset);
    }

    /// Workgroups for `invocations` along x.
    pub fn groups_for(&self, invocations: u32) -> u32 {
        let width = self.shader.entry_points.first().map_or(1, |entry| entry.workgroup_size[0].max(1));
        invocations.div_ceil(width)
    }
}

/// Workgroups along x, y and z: rows as long as the device allows. For none, none along y.
pub fn rows_of_workgroups(gpu: &Gpu, groups: u32) -> [u32; 3] {
    let x = groups.clamp(1, gpu.device().limits().max_compute_workgroups_per_dimension);
    [x, groups.div_ceil(x), 1]
}

/// One dispatch with everything bound.
#[derive(Debug, Clone)]
pub struct Step {
    /// The pipeline.
    pub kernel: Kernel,
    /// Its bind groups, in order.
    pub groups: Vec<Group>,
    /// Workgroups along x, y and z.
    pub workgroups: [u32; 3],
}

impl Step {
    /// Invocations of the dispatch.
    fn invocations(&self) -> u64 {
        let size = self.kernel.shader.entry_points.first().map_or([1; 3], |entry| entry.workgroup_size);
        self.workgroups.into_iter().chain(size).map(u64::from).fold(1, u64::saturating_mul)
    }
}

/// Invocations after which [`Job::run`] submits what it has: some tenths of a second on a slow GPU. Watchdogs of
/// operating systems end what takes seconds.
pub const INVOCATIONS_A_SUBMISSION: u64 = 1 << 27;

/// Dispatches that belong together: prepared once, recorded as often as wanted without allocation.
#[derive(Debug, Clone)]
pub struct Job {
    label: &'static str,
    steps: Vec<Step>,
}

impl Job {
    /// Checks the steps against the device's limits.
    ///
    /// # Errors
    /// [`GpuError::Limit`] when a dispatch is too large.
    pub fn new(gpu: &Gpu, label: &'static str, steps: Vec<Step>) -> Result<Self, GpuError> {
        let available = gpu.device().limits().max_compute_workgroups_per_dimension;
        let needed = steps.iter().flat_map(|step| step.workgroups).max().unwrap_or(0);
        if needed > available {
            return Err(GpuError::Limit {
                pass: label,
                limit: "maxComputeWorkgroupsPerDimension",
                needed: needed.into(),
                available: available.into(),
                remedy: "split the batch",
            });
        }
        Ok(Self { label, steps })
    }

    /// Records one compute pass with all steps, in order.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.record_steps(encoder, &self.steps);
    }

    /// Runs all steps and waits. Long jobs go to the device in several submissions, each with at most `most`
    /// invocations (see [`INVOCATIONS_A_SUBMISSION`]) or one step.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, gpu: &Gpu, most: u64) -> Result<(), GpuError> {
        self.submissions(most)
            .into_iter()
            .try_for_each(|steps| gpu.run(self.label, |encoder| self.record_steps(encoder, steps)))
    }

    /// The steps of each submission of [`Job::run`].
    pub fn submissions(&self, most: u64) -> Vec<&[Step]> {
        let mut submissions = Vec::new();
        let (mut start, mut work) = (0, 0_u64);
        for (index, step) in self.steps.iter().enumerate() {
            let more = step.invocations();
            if index > start && work.saturating_add(more) > most {
                submissions.push(&self.steps[start..index]);
                (start, work) = (index, 0);
            }
            work = work.saturating_add(more);
        }
        submissions.push(&self.steps[start..]);
        submissions
    }

    /// Adds all steps, in order, to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        dispatch(pass, &self.steps);
    }

    fn record_steps(&self, encoder: &mut wgpu::CommandEncoder, steps: &[Step]) {
        let descriptor = wgpu::ComputePassDescriptor { label: Some(self.label), timestamp_writes: None };
        dispatch(&mut encoder.begin_compute_pass(&descriptor), steps);
    }
}

fn dispatch(pass: &mut wgpu::ComputePass<'_>, steps: &[Step]) {
    for step in steps {
        pass.set_pipeline(&step.kernel.pipeline);
        for (index, group) in step.groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        let [x, y, z] = step.workgroups;
        pass.dispatch_workgroups(x, y, z);
    }
}

/// Compiles a shader.
pub fn module(gpu: &Gpu, shader: &'static Shader) -> wgpu::ShaderModule {
    gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(shader.name),
        source: wgpu::ShaderSource::Wgsl(shader.source.into()),
    })
}

/// A pipeline layout of all groups.
pub fn pipeline_layout(
    gpu: &Gpu,
    shader: &Shader,
    layouts: &[wgpu::BindGroupLayout],
) -> wgpu::PipelineLayout {
    gpu.device().create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(shader.name),
        bind_group_layouts: &layouts.iter().map(Some).collect::<Vec<_>>(),
        immediate_size: 0,
    })
}

/// The bind group layouts of a shader, one for every group up to its last.
///
/// # Errors
/// [`GpuError::Validation`] when the device's limits do not allow them.
pub fn layouts(gpu: &Gpu, shader: &Shader) -> Result<Vec<wgpu::BindGroupLayout>, GpuError> {
    let groups = shader.bindings.iter().map(|binding| binding.group + 1).max().unwrap_or(0);
    gpu.scoped(|| {
        (0..groups)
            .map(|group| {
                let entries: Vec<_> = shader
                    .bindings
                    .iter()
                    .filter(|binding| binding.group == group)
                    .map(layout_entry)
                    .collect();
                gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                    label: Some(shader.name),
                    entries: &entries,
                })
            })
            .collect()
    })
}

/// Binds the resources of one group, in the order of their bindings.
///
/// # Errors
/// [`GpuError::Validation`] when they do not fit the shader.
pub fn bind(
    gpu: &Gpu,
    shader: &Shader,
    layouts: &[wgpu::BindGroupLayout],
    group: u32,
    resources: &[Resource<'_>],
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

fn layout_entry(binding: &Binding) -> wgpu::BindGroupLayoutEntry {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let texture = |filterable, view_dimension| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension,
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
        BindingKind::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
    };
    wgpu::BindGroupLayoutEntry { binding: binding.binding, visibility, ty, count: None }
}
