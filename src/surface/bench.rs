//! Benchmarks of `kernels/surface/`.

use crate::Error;
use crate::baseline::loads::LoadsPass;
use crate::gpu::{Buffer, Gpu, Job};
use crate::surface::SurfaceTextures;

/// Bare loads of a height map as a baseline: `loads` in each of `edge`² threads.
pub(crate) fn loads_of(gpu: &Gpu, textures: &SurfaceTextures, edge: u32, loads: u32) -> Result<Job, Error> {
    let sums = Buffer::new(gpu, "sums", (edge * edge) as usize)?;
    LoadsPass::new(gpu)?.prepare(gpu, &textures.heights, [edge; 2], loads, &sums)
}
