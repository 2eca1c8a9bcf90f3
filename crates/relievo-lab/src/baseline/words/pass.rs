//! The GPU pass of `kernels/baseline/words.wgsl`: draws random words and stores them.

use glam::UVec2;
use relievo::gpu::bindings::baseline::words as bindings;
use relievo::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use relievo::shared::baseline::words::WordsParams;
use relievo::{Error, InputError};

/// Draws the random words of counters (x, y), row by row.
#[derive(Debug, Clone)]
pub struct WordsPass {
    kernel: Kernel,
}

impl WordsPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares `rows` rows of `width` words, a multiple of four.
    ///
    /// # Errors
    /// [`InputError`] for sizes that do not fit; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        key: [u32; 2],
        [width, rows]: [u32; 2],
        words: &Buffer<u32>,
    ) -> Result<Job, Error> {
        if width % 4 != 0 || width as usize * rows as usize > words.len() {
            let bound = format!("must be a multiple of 4 and fit {} words", words.len());
            return Err(InputError::new("words", format!("{width} × {rows}"), bound).into());
        }
        let params =
            WordsParams { key: UVec2::from(key), vectors: width / 4 * rows, vectors_per_row: width / 4 };
        let uniform = Uniform::new(gpu, "words", &params)?;
        let group = bindings::Group { params: &uniform, words: words.slice().cast() };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "baseline/words", &self.kernel, group, params.vectors)?)
    }
}
