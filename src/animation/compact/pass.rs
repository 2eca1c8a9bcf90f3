//! The GPU pass of `kernels/animation/compact.wgsl`.

use crate::animation::active::Active;
use crate::animation::crowd::Crowd;
use crate::animation::updated_bones::UpdatedBones;
use crate::gpu::bindings::animation::compact as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, compute_pass};
use crate::shared::animation::compact::{CompactParams, SCAN, SCATTER, SPREAD};

/// Turns the bit masks of active bones into lists on the GPU.
#[derive(Debug, Clone)]
pub struct CompactPass {
    stages: [Kernel; 3],
}

/// A prepared compaction of a crowd's bits into lists.
#[derive(Debug, Clone)]
pub struct CompactJob {
    job: Job,
    updated: UpdatedBones,
}

impl CompactJob {
    /// Records the compaction in a compute pass of its own.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, "animation/compact"));
    }

    /// Records the compaction in an open compute pass, and notifies the readers of [`Active::updated_bones`].
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.updated.update();
        self.job.dispatch(pass);
    }
}

impl CompactPass {
    /// Compiles the compute pipelines of this pass.
    ///
    /// # Errors
    /// [`GpuError`] for shader compilation errors of the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let stage = |stage| bindings::kernel(gpu, &bindings::Constants { stage });
        Ok(Self { stages: [stage(SPREAD)?, stage(SCAN)?, stage(SCATTER)?] })
    }

    /// Prepares a job that turns a crowd's active bits into lists.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn prepare(&self, gpu: &Gpu, crowd: &Crowd, active: &Active) -> Result<CompactJob, GpuError> {
        let params = CompactParams {
            instances: crowd.len() as u32,
            bones: crowd.bones as u32,
            words: active.words,
            served: active.dispatches.len() as u32 - 1,
            most_groups: gpu.device().limits().max_compute_workgroups_per_dimension,
        };
        let group = bindings::Group {
            params: &Uniform::new(gpu, "compact", &params)?,
            bits: active.bits.slice(),
            slots: active.slots.slice(),
            updated_bones: active.updated_bones.bits().slice(),
            counts: active.counts.slice(),
            pairs: active.pairs.pairs.slice(),
            pair_dispatch: active.pairs.dispatched.slice().cast(),
            updated_instances: active.instances.slice(),
            instance_dispatches: active.dispatches.slice(),
        };
        let threads = [params.instances, 1, params.instances * params.words];
        let step = |(kernel, threads): (&Kernel, u32)| {
            Ok(Step::spread(gpu, kernel, vec![group.bind(gpu, kernel)?], threads))
        };
        let steps = self.stages.iter().zip(threads).map(step).collect::<Result<_, GpuError>>()?;
        let job = Job::new(gpu, "animation/compact", steps)?;
        Ok(CompactJob { job, updated: active.updated_bones.clone() })
    }
}
