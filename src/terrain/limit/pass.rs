//! The GPU pass of `kernels/terrain/limit.wgsl`.

use super::ErosionLimit;
use crate::Error;
use crate::gpu::bindings::terrain::limit as bindings;
use crate::gpu::{Buffer, Gpu, Job, Step, Uniform, pass};
use crate::shared::terrain::limit::LimitParams;

pass! {
    /// Cuts regions from eroded heights, and keeps them within a distance of the heights before erosion.
    pub struct LimitPass;
}

/// Buffers of a batch of regions. Heights are in 1/65536 units, and below 2^30 in size.
#[derive(Debug, Clone, Copy)]
pub struct LimitBuffers<'a> {
    /// Read: the regions' heights before erosion, region by region, row by row.
    pub origins: &'a Buffer<i32>,
    /// Read: eroded heights.
    pub eroded: &'a Buffer<i32>,
    /// Read: for each region, the index of its first height in `eroded`.
    pub corners: &'a Buffer<u32>,
    /// Written: the regions' heights.
    pub heights: &'a Buffer<i32>,
}

/// The size of a batch of regions, and of what they are cut from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LimitShape {
    /// Number of regions.
    pub count: u32,
    /// Number of heights along an edge of a region.
    pub width: u32,
    /// Number of heights in a row of the eroded ones.
    pub eroded_width: u32,
}

impl LimitPass {
    /// Prepares a job for a batch of regions.
    ///
    /// # Errors
    /// [`crate::InputError`] for a limit out of bounds and for buffers that are too short; [`crate::gpu::GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        limit: ErosionLimit,
        shape: LimitShape,
        buffers: LimitBuffers<'_>,
    ) -> Result<Job, Error> {
        limit.validate()?;
        let LimitShape { count, width, eroded_width } = shape;
        let LimitBuffers { origins, eroded, corners, heights } = buffers;
        let points = count as usize * (width as usize).pow(2);
        origins.check_holds("origins", points)?;
        corners.check_holds("corners", count as usize)?;
        heights.check_holds("heights", points)?;
        let params = LimitParams { width, eroded_width, most: limit.fixed_depth() };
        let group = bindings::Group {
            params: &Uniform::new(gpu, "limit of erosion", &params)?,
            origins: origins.slice(),
            eroded: eroded.slice(),
            corners: corners.slice(),
            heights: heights.slice(),
        };
        let groups = vec![group.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, [width, width, count]);
        Ok(Job::new(gpu, "terrain/limit", vec![step])?)
    }
}
