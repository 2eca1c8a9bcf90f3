//! The GPU pass of `kernels/surface/relief.wgsl`.

use super::{March, ReliefHit, ReliefMethod, ReliefRay};
use crate::gpu::bindings::surface::relief as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use crate::shared::surface::ray::SurfaceMarch;
use crate::surface::relief::textures::SurfaceTextures;
use crate::{Error, InputError};

impl From<March> for SurfaceMarch {
    fn from(march: March) -> Self {
        let [min_steps, max_steps] = march.steps;
        let address = march.address.code();
        Self { address, min_steps, max_steps, binary_steps: march.binary_steps, mip: 0 }
    }
}

/// Traces lists of rays with one method on the GPU.
#[derive(Debug, Clone)]
pub struct ReliefPass {
    kernel: Kernel,
    method: ReliefMethod,
}

impl ReliefPass {
    /// Compiles the compute pipeline of this pass.
    ///
    /// # Errors
    /// [`GpuError`] for shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, method: ReliefMethod) -> Result<Self, GpuError> {
        let constants = bindings::Constants { method: method.code() };
        Ok(Self { kernel: bindings::kernel(gpu, &constants)?, method })
    }

    /// Prepares a job that traces all `rays` and writes one hit per ray into `hits`.
    ///
    /// # Errors
    /// [`InputError`] if `march` is out of bounds, if `textures` belong to another method or address mode, and if `hits` is
    /// shorter than `rays`; [`GpuError`] for errors of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        textures: &SurfaceTextures,
        march: &March,
        rays: &Buffer<ReliefRay>,
        hits: &Buffer<ReliefHit>,
    ) -> Result<Job, Error> {
        march.validate()?;
        textures.check(self.method, march)?;
        let bound = || format!("must be at least {}, one a ray", rays.len());
        InputError::check(hits.len() >= rays.len(), "hits.len", hits.len(), bound)?;
        let uniform = Uniform::new(gpu, "march", &SurfaceMarch::from(*march))?;
        let [heights, acceleration] = textures.views();
        let group = bindings::Group {
            march: &uniform,
            heights: &heights,
            acceleration: &acceleration,
            rays: rays.slice(),
            hits: hits.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "surface/relief", &self.kernel, group, rays.len() as u32)?)
    }
}
