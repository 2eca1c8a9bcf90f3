//! `kernels/animation/budget.wgsl`.

use encase::ShaderType;

use crate::Error;
use crate::animation::compact::Active;
use crate::animation::crowd::Crowd;
use crate::animation::gate::Gating;
use crate::animation::gate_table::Kind;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};

/// Words of the tally before those of the instances.
const TALLY: usize = 1027;

/// `BudgetParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct BudgetParams {
    pub instances: u32,
    pub bones: u32,
    pub words: u32,
    pub stride: u32,
    pub budget: u32,
}

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
        let stage = |stage| Kernel::new(gpu, &shaders::ANIMATION_BUDGET, &[("STAGE", stage)]);
        Ok(Self { stages: [stage(0.0)?, stage(1.0)?, stage(2.0)?, stage(3.0)?, stage(4.0)?] })
    }

    /// Prepares the decision, from a crowd's phases. The gating's table is one of expectations. The budget is that of
    /// all bones until it is set.
    ///
    /// # Errors
    /// [`crate::InputError`] for a table of another kind than expectations, or along another path than the crowd's;
    /// [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        gating: &Gating,
        active: &Active,
    ) -> Result<BudgetJob, Error> {
        gating.check(Some(Kind::Expectations), crowd)?;
        let params = BudgetParams {
            instances: gating.lods.len() as u32,
            bones: crowd.bones as u32,
            words: gating.words,
            stride: gating.stride,
            budget: u32::MAX,
        };
        let words = params.instances * params.words;
        let uniform = Uniform::new(gpu, "budget", &params)?;
        let ranks: Buffer<u32> = Buffer::new(gpu, "ranks", 17 * words as usize)?;
        let tally: Buffer<u32> = Buffer::new(gpu, "tally", TALLY + gating.lods.len())?;
        let resources = [
            uniform.raw().as_entire_binding(),
            gating.lods.raw().as_entire_binding(),
            gating.phases.raw().as_entire_binding(),
            gating.movers.raw().as_entire_binding(),
            gating.table.raw().as_entire_binding(),
            gating.sampled.raw().as_entire_binding(),
            active.bits.raw().as_entire_binding(),
            ranks.raw().as_entire_binding(),
            tally.raw().as_entire_binding(),
        ];
        let step = |(kernel, threads): (&Kernel, u32)| {
            Ok(Step {
                groups: vec![kernel.bind(gpu, 0, &resources)?],
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
    /// Chooses how many bones may be sampled in the next submission.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(budget_params_layout: BudgetParams = ANIMATION_BUDGET "BudgetParams");

    #[test]
    fn ties_begin_behind_the_tally() {
        let shader = &crate::gpu::shaders::ANIMATION_BUDGET;
        assert_eq!(crate::gpu::layout::constant(shader, "TIES"), Some(TALLY as u32));
    }
}
