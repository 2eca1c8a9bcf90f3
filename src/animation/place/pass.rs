//! `kernels/animation/place.wgsl`.

use encase::ShaderType;

use super::Instance;
use crate::animation::clip_set::ClipSet;
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `PlaceParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct PlaceParams {
    pub instances: u32,
    pub timelines: u32,
    pub elapsed: f32,
}

/// Finds where instances stand in their clips.
#[derive(Debug, Clone)]
pub struct PlacePass {
    kernel: Kernel,
}

impl PlacePass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::ANIMATION_PLACE, &[])? })
    }

    /// Prepares the places of a crowd.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, clips: &ClipBuffers, crowd: &Crowd) -> Result<PlaceJob, Error> {
        let params = PlaceParams {
            instances: crowd.instances.len() as u32,
            timelines: clips.timelines_a_clip as u32,
            elapsed: 0.0,
        };
        let uniform = Uniform::new(gpu, "place", &params)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            crowd.instances.raw().as_entire_binding(),
            clips.clips.raw().as_entire_binding(),
            clips.timelines.raw().as_entire_binding(),
            clips.times.raw().as_entire_binding(),
            crowd.places.raw().as_entire_binding(),
        ];
        let step = Step {
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: self.kernel.spread(gpu, params.instances * params.timelines),
            kernel: self.kernel.clone(),
        };
        Ok(PlaceJob { params, uniform, job: Job::new(gpu, "animation/place", vec![step])? })
    }
}

/// Prepared places: set the time, then record.
#[derive(Debug, Clone)]
pub struct PlaceJob {
    params: PlaceParams,
    uniform: Uniform<PlaceParams>,
    job: Job,
}

impl PlaceJob {
    /// Chooses the time of the next submission: seconds since the instances' starts. Let starts follow the clock every
    /// few minutes: `f32` seconds grow coarse.
    ///
    /// # Errors
    /// [`InputError`] for seconds that are not finite; [`GpuError`].
    pub fn set(&self, gpu: &Gpu, elapsed: f32) -> Result<(), Error> {
        if !elapsed.is_finite() {
            return Err(InputError::new("elapsed", elapsed, "must be finite").into());
        }
        Ok(self.uniform.write(gpu, &PlaceParams { elapsed, ..self.params })?)
    }

    /// Records the search.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }
}

impl Crowd {
    /// Room for `instances` of a set's clips.
    ///
    /// # Errors
    /// [`InputError`] for no instances, or ones that play no clip of the set; [`GpuError`].
    pub fn new(gpu: &Gpu, set: &ClipSet, instances: &[Instance]) -> Result<Self, Error> {
        Self::layered(gpu, set, instances, &[])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(place_params_layout: PlaceParams = ANIMATION_PLACE "PlaceParams");
}
