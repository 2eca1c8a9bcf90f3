//! The GPU pass of `kernels/animation/budget.wgsl`.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::crowd::Crowd;
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::{ExpectationTable, TableBuffers};
use crate::gpu::bindings::animation::budget as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, ParamsJob, Step, Uniform};
use crate::shared::animation::budget::{BudgetParams, CHOOSE, DECIDE, RANK, SETTLE, SUM, TIES};

/// Selects the bones to sample on the GPU, within a budget of bones per frame.
#[derive(Debug, Clone)]
pub struct BudgetPass {
    stages: [Kernel; 5],
    table: TableBuffers,
    bones: u32,
}

impl BudgetPass {
    /// Uploads a table and compiles the pipelines. `bones` is the initial budget in bones per frame; [`BudgetJob::set`] changes
    /// it.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, table: &ExpectationTable, bones: u32) -> Result<Self, GpuError> {
        let stage = |stage| bindings::kernel(gpu, &bindings::Constants { stage });
        let stages = [stage(RANK)?, stage(CHOOSE)?, stage(DECIDE)?, stage(SUM)?, stage(SETTLE)?];
        Ok(Self { stages, table: TableBuffers::of_expectations(gpu, table)?, bones })
    }

    /// Prepares a job that selects which bones of a crowd are sampled. The crowd's clip clocks are the input.
    ///
    /// # Errors
    /// [`crate::InputError`] if the crowd's bones, clips or rotation path differ from the table's, and if `active` belongs to
    /// another crowd; [`GpuError`] for errors of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        state: &GateState,
        active: &Active,
    ) -> Result<BudgetJob, Error> {
        self.table.check(crowd)?;
        active.pairs.check_crowd(crowd)?;
        let params = BudgetParams {
            instances: state.lods.len() as u32,
            bones: crowd.bones as u32,
            words: self.table.words,
            stride: self.table.stride,
            budget: self.bones,
            clips: self.table.clips,
            tiers: self.table.tiers,
        };
        let words = params.instances * params.words;
        let uniform = Uniform::new(gpu, "budget", &params)?;
        let ranks: Buffer<u32> = Buffer::new(gpu, "ranks", 17 * words as usize)?;
        let tally: Buffer<u32> = Buffer::new(gpu, "tally", TIES as usize + state.lods.len())?;
        let group = bindings::Group {
            params: &uniform,
            lods: state.lods.slice(),
            clip_clocks: state.clip_clocks.slice(),
            animated_bones: self.table.animated_bones.slice(),
            table: self.table.rows.slice(),
            sampled: state.sampled.slice(),
            bits: active.bits.slice(),
            ranks: ranks.slice(),
            tally: tally.slice(),
        };
        let step = |(kernel, threads): (&Kernel, u32)| {
            Ok(Step::spread(gpu, kernel, vec![group.bind(gpu, kernel)?], threads))
        };
        let threads = [words, 1, words, 1, words];
        let steps = self.stages.iter().zip(threads).map(step).collect::<Result<_, GpuError>>()?;
        Ok(ParamsJob { params, uniform, job: Job::new(gpu, "animation/budget", steps)? })
    }
}

/// A prepared selection of bones. In each frame, set the budget, then record.
pub type BudgetJob = ParamsJob<BudgetParams>;

impl BudgetJob {
    /// Sets the budget for the next submission: the largest number of bones to sample.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn set(&self, gpu: &Gpu, budget: u32) -> Result<(), GpuError> {
        self.uniform.write(gpu, &BudgetParams { budget, ..self.params })
    }
}
