//! The GPU pass of `kernels/terrain/replace.wgsl`.

use crate::Error;
use crate::gpu::bindings::terrain::replace as bindings;
use crate::gpu::{Buffer, Gpu, Job, Step, Uniform, pass};
use crate::shared::terrain::replace::ReplaceParams;

pass! {
    /// Replaces heights of regions by given ones.
    pub struct ReplacePass;
}

/// Buffers of a batch of regions.
#[derive(Debug, Clone, Copy)]
pub struct ReplaceBuffers<'a> {
    /// Read: the given heights of all regions, row by row; [`NOT_GIVEN`](super::NOT_GIVEN) where none is given.
    pub given: &'a Buffer<i32>,
    /// Read and written: the heights of all regions, row by row.
    pub heights: &'a Buffer<i32>,
}

impl ReplacePass {
    /// Prepares a job for `count` regions of `width` heights along an edge.
    ///
    /// # Errors
    /// [`crate::InputError`] for buffers that are too short; [`crate::gpu::GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        width: u32,
        count: u32,
        buffers: ReplaceBuffers<'_>,
    ) -> Result<Job, Error> {
        Ok(Job::new(gpu, "terrain/replace", vec![self.step(gpu, width, count, buffers)?])?)
    }

    /// The one step of the job.
    pub(crate) fn step(
        &self,
        gpu: &Gpu,
        width: u32,
        count: u32,
        buffers: ReplaceBuffers<'_>,
    ) -> Result<Step, Error> {
        let points = count as usize * (width as usize).pow(2);
        buffers.given.check_holds("given", points)?;
        buffers.heights.check_holds("heights", points)?;
        let group = bindings::Group {
            params: &Uniform::new(gpu, "given heights", &ReplaceParams { width })?,
            given: buffers.given.slice(),
            heights: buffers.heights.slice(),
        };
        let groups = vec![group.bind(gpu, &self.kernel)?];
        Ok(Step::covering(&self.kernel, groups, [width, width, count]))
    }
}
