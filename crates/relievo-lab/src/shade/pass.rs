//! The GPU pass of `kernels/surface/shade.wgsl`.

use relievo::gpu::bindings::surface::shade as bindings;
use relievo::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use relievo::ops::surface::relief::textures::SurfaceTextures;
use relievo::ops::surface::relief::{March, ReliefMethod};
use relievo::shared::surface::ray::SurfaceMarch;
use relievo::{Error, InputError};

use crate::shade::{Shade, ShadePoint, ShadeView};

/// Shades lists of points. Hard shadows trace the light's rays with one method.
#[derive(Debug, Clone)]
pub struct ShadePass {
    kernel: Kernel,
    method: ReliefMethod,
}

impl ShadePass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, method: ReliefMethod) -> Result<Self, GpuError> {
        let constants = bindings::Constants { method: method.code() };
        Ok(Self { kernel: bindings::kernel(gpu, &constants)?, method })
    }

    /// Prepares the shading of all `points`, with one [`Shade`] each.
    ///
    /// # Errors
    /// [`InputError`] for a view or a march out of bounds, for textures of another method or address mode, and
    /// for a buffer with too few shades; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        textures: &SurfaceTextures,
        march: &March,
        view: &ShadeView,
        points: &Buffer<ShadePoint>,
        shades: &Buffer<Shade>,
    ) -> Result<Job, Error> {
        crate::shade::validate(view)?;
        march.validate()?;
        textures.check(self.method, march)?;
        if shades.len() < points.len() {
            let bound = format!("must be at least {}, one a point", points.len());
            return Err(InputError::new("shades.len", shades.len(), bound).into());
        }
        let view = Uniform::new(gpu, "shade view", view)?;
        let march = Uniform::new(gpu, "march", &SurfaceMarch::from(*march))?;
        let [heights, acceleration] = textures.views();
        let group = bindings::Group {
            view: &view,
            march: &march,
            heights: &heights,
            acceleration: &acceleration,
            points: points.slice(),
            shades: shades.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "surface/shade", &self.kernel, group, points.len() as u32)?)
    }
}
