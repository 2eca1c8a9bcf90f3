//! The GPU pass of `kernels/lod/single.wgsl`.

use super::Single;
use crate::Error;
use crate::gpu::bindings::lod::single as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use crate::lod::SceneDraw;
use crate::shared::lod::single::SingleParams;

/// What the draws of single instances are made from, and where they go.
#[derive(Debug, Clone, Copy)]
pub struct SingleBuffers<'a> {
    /// The parts of instances. Their instances and draws must lie inside `decisions` and `arguments`.
    pub singles: &'a Buffer<Single>,
    /// One for each instance: 0 if it is not seen, else 1 + its list, and above how far its level has moved.
    pub decisions: &'a Buffer<u32>,
    /// The draws of all lists ([`LodObject::draw`](crate::lod::LodObject::draw)).
    pub arguments: &'a Buffer<SceneDraw>,
    /// Written: one for each of `singles`.
    pub draws: &'a Buffer<SceneDraw>,
    /// Written: the entry of the list of each of `draws`.
    pub entries: &'a Buffer<u32>,
}

/// Writes the draws of single instances.
#[derive(Debug, Clone)]
pub struct SinglePass {
    kernel: Kernel,
}

impl SinglePass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the draws of the first `count` of the singles. Record it after [`select`](crate::lod::select).
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers with fewer; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, buffers: SingleBuffers<'_>, count: u32) -> Result<Job, Error> {
        buffers.singles.check_holds("singles", count as usize)?;
        buffers.draws.check_holds("draws", count as usize)?;
        buffers.entries.check_holds("entries", count as usize)?;
        let uniform = Uniform::new(gpu, "single", &SingleParams { count })?;
        let group = bindings::Group {
            params: &uniform,
            singles: buffers.singles.slice(),
            decisions: buffers.decisions.slice(),
            arguments: buffers.arguments.slice(),
            draws: buffers.draws.slice(),
            entries: buffers.entries.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "lod/single", (&self.kernel, group), count)?)
    }
}
