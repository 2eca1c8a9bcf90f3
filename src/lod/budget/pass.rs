//! The GPU pass of `kernels/lod/budget.wgsl`.

use super::BudgetParams;
use crate::Error;
use crate::gpu::bindings::lod::budget as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::lod::BLOCK;
use crate::shared::lod::budget::{BINS, FADES, FIND_BIN, FIND_PART, FINISH, PARTS};

/// Buffers of the budget kernel: the buffers of the budget, and the buffers of one view that shares it.
#[doc(inline)]
pub use bindings::Buffers as BudgetBuffers;

/// A stage of the kernel. Every view that shares the budget runs the first, third and fifth stage. After each of these, only one
/// of the views runs the stage that follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BudgetStage {
    /// Each view adds its savings of triangles to the bins of the first histogram.
    Bins,
    /// One view finds the bin at which the triangles fit.
    FindBin,
    /// Each view adds its savings in that bin to the parts of the bin (second histogram).
    Parts,
    /// One view finds the part at which the triangles fit, and writes the factors.
    FindPart,
    /// Each view adds the triangles of its instances that fade, which draw two levels.
    Fades,
    /// One view ends all fades if their triangles do not fit.
    Finish,
}

impl BudgetStage {
    /// All stages, in order.
    pub const EACH: [Self; 6] =
        [Self::Bins, Self::FindBin, Self::Parts, Self::FindPart, Self::Fades, Self::Finish];

    /// Whether every view that shares the budget runs the stage. Otherwise, only one of them does.
    pub fn is_of_each_view(self) -> bool {
        matches!(self, Self::Bins | Self::Parts | Self::Fades)
    }
}

/// GPU pass that coarsens levels of detail, so that the triangles of all views that share a budget fit it.
#[derive(Debug, Clone)]
pub struct BudgetPass {
    kernels: [Kernel; 6],
}

/// Prepared stages of a budget for one view.
#[derive(Debug)]
pub struct BudgetStages([Job; 6]);

impl BudgetStages {
    /// Dispatches a stage in a compute pass.
    pub fn dispatch(&self, stage: BudgetStage, pass: &mut wgpu::ComputePass<'_>) {
        self.0[stage as usize].dispatch(pass);
    }
}

impl BudgetPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// Errors of the driver's shader compiler.
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

    /// Prepares the stages for all instances of a view: [`BLOCK`] instances for each element of `block_objects`. Record the
    /// stages between [`select`](crate::lod::select) and [`decide`](crate::lod::decide).
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers that are too small for these blocks; [`GpuError`] for failures of the
    /// device.
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
