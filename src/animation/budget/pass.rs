//! The GPU pass of `kernels/animation/budget.wgsl`.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::crowd::Crowd;
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::Kind;
use crate::gpu::bindings::animation::budget as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::animation::budget::{BudgetParams, CHOOSE, DECIDE, RANK, SETTLE, SUM, TIES};

/// Decides which bones are sampled.
#[derive(Debug, Clone)]
pub struct BudgetPass {
    stages: [Kernel; 5],
}

impl BudgetPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let stage = |stage| bindings::kernel(gpu, &bindings::Constants { stage });
        Ok(Self { stages: [stage(RANK)?, stage(CHOOSE)?, stage(DECIDE)?, stage(SUM)?, stage(SETTLE)?] })
    }

    /// Prepares the decision from a crowd's clip clocks. The table must be one of expectations. Until it is
    /// set, the budget is the number of all bones.
    ///
    /// # Errors
    /// [`crate::InputError`] for a table of another kind, and for one of another rotation path than the
    /// crowd's; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        gate_state: &GateState,
        active: &Active,
    ) -> Result<BudgetJob, Error> {
        gate_state.check(Some(Kind::Expectations), crowd)?;
        active.pairs.check_crowd(crowd)?;
        let params = BudgetParams {
            instances: gate_state.lods.len() as u32,
            bones: crowd.bones as u32,
            words: gate_state.words,
            stride: gate_state.stride,
            budget: u32::MAX,
        };
        let words = params.instances * params.words;
        let uniform = Uniform::new(gpu, "budget", &params)?;
        let ranks: Buffer<u32> = Buffer::new(gpu, "ranks", 17 * words as usize)?;
        let tally: Buffer<u32> = Buffer::new(gpu, "tally", TIES as usize + gate_state.lods.len())?;
        let group = bindings::Group {
            params: &uniform,
            lods: gate_state.lods.slice(),
            clip_clocks: gate_state.clip_clocks.slice(),
            animated_bones: gate_state.animated_bones.slice(),
            table: gate_state.table.slice(),
            sampled: gate_state.sampled.slice(),
            bits: active.bits.slice(),
            ranks: ranks.slice(),
            tally: tally.slice(),
        };
        let step = |(kernel, threads): (&Kernel, u32)| {
            Ok(Step {
                groups: vec![group.bind(gpu, kernel)?],
                workgroups: kernel.spread(gpu, threads),
                kernel: kernel.clone(),
            })
        };
        let threads = [words, 1, words, 1, words];
        let steps = self.stages.iter().zip(threads).map(step).collect::<Result<_, GpuError>>()?;
        Ok(BudgetJob { params, uniform, job: Job::new(gpu, "animation/budget", steps)? })
    }
}

/// A prepared decision: set the budget, then record.
#[derive(Debug, Clone)]
pub struct BudgetJob {
    params: BudgetParams,
    uniform: Uniform<BudgetParams>,
    job: Job,
}

impl BudgetJob {
    /// Sets the number of bones that may be sampled in the next submission.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn set(&self, gpu: &Gpu, budget: u32) -> Result<(), GpuError> {
        self.uniform.write(gpu, &BudgetParams { budget, ..self.params })
    }

    /// Records the decision.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }

    /// Adds the decision to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.job.dispatch(pass);
    }
}
