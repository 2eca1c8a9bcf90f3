//! The GPU pass of `kernels/animation/compact.wgsl`.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::crowd::Crowd;
use crate::animation::updated_bones::UpdatedBones;
use crate::gpu::bindings::animation::compact as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, compute_pass};
use crate::shared::animation::compact::{ALL, CompactParams, SCAN, SCATTER, SPREAD};

/// How threads divide the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stages {
    /// Three dispatches: one spreads, one sums, one lists.
    Three,
    /// One workgroup does everything. On lavapipe, where a dispatch takes 20 µs and more, this is faster for up
    /// to some hundred instances.
    One,
}

impl Stages {
    /// The number of words of bits up to which one workgroup suffices on adapters with few processors.
    const FEW: usize = 2048;

    /// The faster choice for a crowd on this kind of adapter.
    pub fn of(gpu: &Gpu, crowd: &Crowd) -> Self {
        let words = crowd.len() * crowd.bones.div_ceil(32);
        if gpu.tuning().wants_long_threads() && words <= Self::FEW { Self::One } else { Self::Three }
    }
}

/// Turns bits into lists.
#[derive(Debug, Clone)]
pub struct CompactPass {
    stages: [Kernel; 3],
    all: Kernel,
}

/// The prepared lists.
#[derive(Debug, Clone)]
pub struct CompactJob {
    pub(crate) job: Job,
    updated: UpdatedBones,
}

impl CompactJob {
    /// Records the lists.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, "animation/compact"));
    }

    /// Adds the lists to a compute pass that is being recorded, and tells the readers of [`Active::updated_bones`].
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.updated.update();
        self.job.dispatch(pass);
    }
}

impl CompactPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let stage = |stage| bindings::kernel(gpu, &bindings::Constants { stage });
        Ok(Self { stages: [stage(SPREAD)?, stage(SCAN)?, stage(SCATTER)?], all: stage(ALL)? })
    }

    /// Prepares the lists of a crowd's active bits.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, crowd: &Crowd, active: &Active) -> Result<CompactJob, Error> {
        self.prepare_stages(gpu, crowd, active, Stages::of(gpu, crowd))
    }

    /// The same in so many stages.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn prepare_stages(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        active: &Active,
        stages: Stages,
    ) -> Result<CompactJob, Error> {
        let params = CompactParams::new(gpu, crowd, active);
        let uniform = Uniform::new(gpu, "compact", &params)?;
        let group = group(&uniform, active);
        let step = |kernel: &Kernel, threads: u32| {
            Ok::<_, GpuError>(Step {
                groups: vec![group.bind(gpu, kernel)?],
                workgroups: kernel.spread(gpu, threads),
                kernel: kernel.clone(),
            })
        };
        let [spread, scan, scatter] = &self.stages;
        let steps = match stages {
            Stages::One => vec![step(&self.all, 1)?],
            Stages::Three => vec![
                step(spread, params.instances)?,
                step(scan, 1)?,
                step(scatter, params.instances * params.words)?,
            ],
        };
        let job = Job::new(gpu, "animation/compact", steps)?;
        Ok(CompactJob { job, updated: active.updated_bones.clone() })
    }
}

/// The bits that lists are made of, and the lists.
pub(crate) fn group<'a>(uniform: &'a Uniform<CompactParams>, active: &'a Active) -> bindings::Group<'a> {
    bindings::Group {
        bits: active.bits.slice(),
        compact_params: uniform,
        slots: active.slots.slice(),
        updated_bones: active.updated_bones.bits().slice(),
        counts: active.counts.slice(),
        pairs: active.pairs.pairs.slice(),
        pair_dispatch: active.pairs.dispatched.slice().cast(),
        updated_instances: active.instances.slice(),
        instance_dispatches: active.dispatches.slice(),
    }
}

impl CompactParams {
    /// The parameters for a crowd and its lists.
    pub fn new(gpu: &Gpu, crowd: &Crowd, active: &Active) -> Self {
        Self {
            instances: crowd.len() as u32,
            bones: crowd.bones as u32,
            words: active.words,
            served: active.dispatches.len() as u32 - 1,
            most_groups: gpu.device().limits().max_compute_workgroups_per_dimension,
        }
    }
}
