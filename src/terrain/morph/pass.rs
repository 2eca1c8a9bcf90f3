//! `kernels/terrain/morph.wgsl`.

use encase::ShaderType;

use super::Morph;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `MorphParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct MorphParams {
    pub points: u32,
    pub time: u32,
}

/// Blends two height fields.
#[derive(Debug, Clone)]
pub struct MorphPass {
    kernel: Kernel,
}

impl MorphPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::TERRAIN_MORPH, &[])? })
    }

    /// Prepares the blend of `from` and `to` into `heights`, all of one length.
    ///
    /// # Errors
    /// [`InputError`] for buffers of different lengths; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        from: &Buffer<i32>,
        to: &Buffer<i32>,
        heights: &Buffer<i32>,
    ) -> Result<MorphJob, Error> {
        if from.len() != to.len() || from.len() != heights.len() {
            let value = format!("[{}, {}, {}]", from.len(), to.len(), heights.len());
            return Err(InputError::new("morph lengths", value, "must be equal").into());
        }
        let points = from.len() as u32;
        let params = Uniform::new(gpu, "morph", &MorphParams { points, time: 0 })?;
        let resources = [
            params.raw().as_entire_binding(),
            from.raw().as_entire_binding(),
            to.raw().as_entire_binding(),
            heights.raw().as_entire_binding(),
        ];
        let groups = vec![self.kernel.bind(gpu, 0, &resources)?];
        let workgroups = self.kernel.spread(gpu, points);
        let step = Step { kernel: self.kernel.clone(), groups, workgroups };
        Ok(MorphJob { params, points, job: Job::new(gpu, "terrain/morph", vec![step])? })
    }
}

/// A prepared blend: set the time, then record.
#[derive(Debug, Clone)]
pub struct MorphJob {
    params: Uniform<MorphParams>,
    points: u32,
    job: Job,
}

impl MorphJob {
    /// Chooses the time of the next submission.
    ///
    /// # Errors
    /// [`InputError`] for a time outside 0..=1; [`GpuError`].
    pub fn set(&self, gpu: &Gpu, morph: Morph) -> Result<(), Error> {
        morph.validate()?;
        Ok(self.params.write(gpu, &MorphParams { points: self.points, time: morph.fixed_time() })?)
    }

    /// Records the blend.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(morph_params_layout: MorphParams = TERRAIN_MORPH "MorphParams");
}
