//! A copy of bytes (`kernels/baseline/copy.wgsl`).

#[cfg(feature = "gpu")]
pub mod bench;
pub mod reference;
#[cfg(feature = "gpu")]
pub mod verify;

use encase::ShaderType;

use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `CopyParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct CopyParams {
    pub vectors: u32,
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
        Ok(Self { kernel: Kernel::new(gpu, &shaders::BASELINE_COPY, &[])? })
    }

    /// Prepares a copy of the first `words` words; a multiple of four.
    ///
    /// # Errors
    /// [`InputError`] for a length that is no multiple of four; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        words: usize,
        source: &Buffer<u32>,
        destination: &Buffer<u32>,
    ) -> Result<Job, Error> {
        if !words.is_multiple_of(4) || words > source.len() || words > destination.len() {
            let bound = "must be a multiple of 4 that fits both buffers";
            return Err(InputError::new("words", words, bound).into());
        }
        let vectors = (words / 4) as u32;
        let uniform = Uniform::new(gpu, "copy", &CopyParams { vectors })?;
        let resources = [
            uniform.raw().as_entire_binding(),
            source.raw().as_entire_binding(),
            destination.raw().as_entire_binding(),
        ];
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: self.kernel.spread(gpu, vectors),
        };
        Ok(Job::new(gpu, "baseline/copy", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(copy_params_layout: CopyParams = BASELINE_COPY "CopyParams");
}
