//! The GPU pass of `kernels/lod/budget.wgsl`.

use super::BudgetParams;
use crate::Error;
use crate::gpu::bindings::lod::budget as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::lod::BLOCK;
use crate::shared::lod::budget::{BINS, FADES, FIND_BIN, FIND_PART, FINISH, PARTS};

/// The buffers of a budget and of a view that shares it.
#[doc(inline)]
pub use bindings::Buffers as BudgetBuffers;

/// A stage of the kernel. All views that share a budget run each of the first, third and fifth before the one that follows,
/// which one of them runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BudgetStage {
    /// Each view adds its savings to the bins.
    Bins,
    /// One view finds the bin.
    FindBin,
    /// Each view adds its savings to the parts of the bin.
    Parts,
    /// One view finds the part, and writes the factors.
    FindPart,
    /// Each view adds the triangles of its fades.
    Fades,
    /// One view ends the fades that do not fit.
    Finish,
}

impl BudgetStage {
    /// All stages, in order.
    pub const EACH: [Self; 6] =
        [Self::Bins, Self::FindBin, Self::Parts, Self::FindPart, Self::Fades, Self::Finish];

    /// Whether each view that shares the budget runs the stage, not one alone.
    pub fn is_of_each_view(self) -> bool {
        matches!(self, Self::Bins | Self::Parts | Self::Fades)
    }
}

/// Coarsens the levels of detail of views so that they fit a budget.
#[derive(Debug, Clone)]
pub struct BudgetPass {
    kernels: [Kernel; 6],
}

/// The prepared stages of a view.
#[derive(Debug)]
pub struct BudgetStages([Job; 6]);

impl BudgetStages {
    /// Adds a stage to a compute pass.
    pub fn dispatch(&self, stage: BudgetStage, pass: &mut wgpu::ComputePass<'_>) {
        self.0[stage as usize].dispatch(pass);
    }
}

impl BudgetPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |stage| bindings::kernel(gpu, &bindings::Constants { stage });
        let [bins, find_bin, parts, find_part, fades, finish] =
            [BINS, FIND_BIN, PARTS, FIND_PART, FADES, FINISH];
        Ok(Self {
            kernels: [
                kernel(bins)?,
                kernel(find_bin)?,
                kernel(parts)?,
                kernel(find_part)?,
                kernel(fades)?,
                kernel(finish)?,
            ],
        })
    }

    /// Prepares the stages for all instances of a view, [`BLOCK`] for each element of `block_objects`. Record them between
    /// [`select`](crate::lod::select) and [`decide`](crate::lod::decide).
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers that are too small for these blocks; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        params: &Uniform<BudgetParams>,
        buffers: BudgetBuffers<'_>,
    ) -> Result<BudgetStages, Error> {
        let blocks = buffers.block_objects.len();
        let job = |stage: BudgetStage| {
            let kernel = &self.kernels[stage as usize];
            let group = buffers.bind(gpu, kernel, params, &bindings::Lengths { blocks })?;
            let threads = if stage.is_of_each_view() { BLOCK * blocks as u32 } else { 256 };
            Ok::<_, Error>(Job::new(
                gpu,
                "lod/budget",
                vec![Step::spread(gpu, kernel, vec![group], threads)],
            )?)
        };
        let [a, b, c, d, e, f] = BudgetStage::EACH;
        Ok(BudgetStages([job(a)?, job(b)?, job(c)?, job(d)?, job(e)?, job(f)?]))
    }
}
