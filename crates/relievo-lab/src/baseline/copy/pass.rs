//! The GPU pass of `kernels/baseline/copy.wgsl`: copies words.

use relievo::gpu::bindings::baseline::copy as bindings;
use relievo::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use relievo::shared::baseline::copy::CopyParams;
use relievo::{Error, InputError};

/// What a copy reads and writes.
#[derive(Debug, Clone, Copy)]
pub struct CopyBuffers<'a> {
    /// Read.
    pub source: &'a Buffer<u32>,
    /// Written.
    pub destination: &'a Buffer<u32>,
}

/// Copies one buffer to another.
#[derive(Debug, Clone)]
pub struct CopyPass {
    kernel: Kernel,
}

impl CopyPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares a copy of the first `words` words, a multiple of four.
    ///
    /// # Errors
    /// [`InputError`] for a length that is not a multiple of four; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, words: usize, buffers: CopyBuffers<'_>) -> Result<Job, Error> {
        let CopyBuffers { source, destination } = buffers;
        if !words.is_multiple_of(4) || words > source.len() || words > destination.len() {
            let bound = "must be a multiple of 4 that fits both buffers";
            return Err(InputError::new("words", words, bound).into());
        }
        let vectors = (words / 4) as u32;
        let uniform = Uniform::new(gpu, "copy", &CopyParams { vectors })?;
        let group = bindings::Group {
            params: &uniform,
            source: source.slice().cast(),
            destination: destination.slice().cast(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "baseline/copy", &self.kernel, group, vectors)?)
    }
}
