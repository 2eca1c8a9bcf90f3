//! Jobs: dispatches that are prepared once and recorded every frame.

use super::kernel::{Group, Kernel};
use super::{Gpu, GpuError};

/// One dispatch with its pipeline and bind groups.
#[derive(Debug, Clone)]
pub struct Step {
    /// The pipeline.
    pub(crate) kernel: Kernel,
    /// Its bind groups, in order.
    pub(crate) groups: Vec<Group>,
    /// Workgroups along x, y and z.
    pub workgroups: [u32; 3],
}

impl Step {
    fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.kernel.pipeline);
        for (index, group) in self.groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        let [x, y, z] = self.workgroups;
        pass.dispatch_workgroups(x, y, z);
    }

    /// Invocations of the dispatch.
    fn invocations(&self) -> u64 {
        let size = self.kernel.workgroup_size();
        self.workgroups.into_iter().chain(size).map(u64::from).fold(1, u64::saturating_mul)
    }
}

/// The number of invocations after which [`Job::run`] submits: some tenths of a second of work on a slow GPU.
/// Operating systems abort work that takes seconds.
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
    pub(crate) fn new(gpu: &Gpu, label: &'static str, steps: Vec<Step>) -> Result<Self, GpuError> {
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
        self.dispatch(&mut compute_pass(encoder, self.label));
    }

    /// Adds all steps, in order, to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.steps.iter().for_each(|step| step.dispatch(pass));
    }

    /// Runs all steps and waits. Long jobs are split into several submissions, each with at most `most`
    /// invocations (see [`INVOCATIONS_A_SUBMISSION`]) or one step.
    ///
    /// # Errors
    /// Errors of the device.
    pub fn run(&self, gpu: &Gpu, most: u64) -> Result<(), GpuError> {
        self.submissions(most).into_iter().try_for_each(|steps| {
            gpu.run(self.label, |encoder| {
                let mut pass = compute_pass(encoder, self.label);
                steps.iter().for_each(|step| step.dispatch(&mut pass));
            })
        })
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
}

/// Indirect dispatches, whose numbers of workgroups are written by kernels: prepared once, and recorded as
/// often as wanted without allocation.
#[derive(Debug, Clone)]
pub struct IndirectJob {
    label: &'static str,
    kernel: Kernel,
    arguments: wgpu::Buffer,
    groups: Vec<(Group, u64)>,
}

impl IndirectJob {
    /// Prepares one dispatch for each bind group, each with the byte offset in `arguments` at which its
    /// workgroups along x, y and z begin.
    pub(crate) fn new(
        label: &'static str,
        kernel: &Kernel,
        arguments: &wgpu::Buffer,
        groups: Vec<(Group, u64)>,
    ) -> Self {
        Self { label, kernel: kernel.clone(), arguments: arguments.clone(), groups }
    }

    /// Records one compute pass with all dispatches, in order.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, self.label));
    }

    /// Adds all dispatches, in order, to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.kernel.pipeline);
        for (group, offset) in &self.groups {
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups_indirect(&self.arguments, *offset);
        }
    }
}

/// Begins a compute pass. One pass for many jobs is cheaper than one for each.
pub fn compute_pass<'a>(encoder: &'a mut wgpu::CommandEncoder, label: &'static str) -> wgpu::ComputePass<'a> {
    encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None })
}
