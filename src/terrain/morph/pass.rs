//! The GPU pass of `kernels/terrain/morph.wgsl`.

use super::Morph;
use crate::gpu::bindings::terrain::morph as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, ParamsJob, Uniform, Upload, pass};
use crate::shared::terrain::morph::MorphParams;
use crate::{Error, InputError};

/// Buffers of a blend: heights in 1/65536 units, the same number in each buffer.
#[derive(Debug, Clone, Copy)]
pub struct MorphBuffers<'a> {
    /// Read: heights at time 0.
    pub from: &'a Buffer<i32>,
    /// Read: heights at time 1.
    pub to: &'a Buffer<i32>,
    /// Written: heights at the set time.
    pub heights: &'a Buffer<i32>,
}

pass! {
    /// Blends two height fields at a given time.
    pub struct HeightMorphPass;
}

impl HeightMorphPass {
    /// Prepares a blend of all heights of the buffers.
    ///
    /// # Errors
    /// [`InputError`] for buffers of different lengths; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, buffers: MorphBuffers<'_>) -> Result<MorphJob, Error> {
        let MorphBuffers { from, to, heights } = buffers;
        for (field, len) in [("to.len", to.len()), ("heights.len", heights.len())] {
            InputError::check_same(field, len, from.len(), "as from.len")?;
        }
        Ok(self.prepare_first(gpu, buffers, from.len() as u32)?)
    }

    /// Prepares a blend of the first `points` heights, which every buffer must hold. The kernel writes whole vectors of four
    /// heights.
    pub(crate) fn prepare_first(
        &self,
        gpu: &Gpu,
        buffers: MorphBuffers<'_>,
        points: u32,
    ) -> Result<MorphJob, GpuError> {
        let MorphBuffers { from, to, heights } = buffers;
        let vectors = points.div_ceil(4);
        let params = MorphParams { vectors, time: 0 };
        let uniform = Uniform::new(gpu, "morph", &params)?;
        let group = bindings::Group {
            params: &uniform,
            start_heights: from.slice().cast(),
            target_heights: to.slice().cast(),
            heights: heights.slice().cast(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        let job = Job::spread(gpu, "terrain/morph", &self.kernel, group, vectors)?;
        Ok(ParamsJob { params, uniform, job })
    }
}

/// A prepared blend of two height fields: set the time, then record.
pub type MorphJob = ParamsJob<MorphParams>;

impl MorphJob {
    /// Sets the time of the blend for the next submission.
    ///
    /// # Errors
    /// [`InputError`] for a time outside 0..=1; [`GpuError`].
    pub fn set(&self, gpu: &Gpu, morph: Morph) -> Result<(), Error> {
        self.set_through(&mut &*gpu, morph)
    }

    /// As [`MorphJob::set`], but writes through `upload`.
    ///
    /// # Errors
    /// The same errors as [`MorphJob::set`].
    pub fn set_through(&self, upload: &mut impl Upload, morph: Morph) -> Result<(), Error> {
        morph.validate()?;
        Ok(upload.uniform(&self.uniform, &MorphParams { time: morph.fixed_time(), ..self.params })?)
    }
}
