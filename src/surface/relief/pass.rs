//! The GPU pass of `kernels/surface/relief.wgsl`.

use encase::ShaderType;

use super::{Hit, March, Method, Ray};
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::surface::relief::textures::SurfaceTextures;
use crate::{Error, InputError};

/// The shaders' `SurfaceMarch`.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct SurfaceMarch {
    pub address: u32,
    pub min_steps: u32,
    pub max_steps: u32,
    pub binary_steps: u32,
    pub mip: u32,
}

impl From<March> for SurfaceMarch {
    fn from(march: March) -> Self {
        let [min_steps, max_steps] = march.steps;
        let address = march.address.code();
        Self { address, min_steps, max_steps, binary_steps: march.binary_steps, mip: 0 }
    }
}

/// Traces lists of rays with one method.
#[derive(Debug, Clone)]
pub struct ReliefPass {
    kernel: Kernel,
    method: Method,
}

impl ReliefPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, method: Method) -> Result<Self, GpuError> {
        let overrides = [("METHOD", method.code().into())];
        Ok(Self { kernel: Kernel::new(gpu, &shaders::SURFACE_RELIEF, &overrides)?, method })
    }

    /// Prepares the tracing of all `rays`, with one hit each.
    ///
    /// # Errors
    /// [`InputError`] for a march out of bounds, for textures of another method or address mode, and for a
    /// buffer with too few hits; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        textures: &SurfaceTextures,
        march: &March,
        rays: &Buffer<Ray>,
        hits: &Buffer<Hit>,
    ) -> Result<Job, Error> {
        march.validate()?;
        textures.check(self.method, march)?;
        if hits.len() < rays.len() {
            let bound = format!("must be at least {}, one a ray", rays.len());
            return Err(InputError::new("hits.len", hits.len(), bound).into());
        }
        let uniform = Uniform::new(gpu, "march", &SurfaceMarch::from(*march))?;
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (heights, acceleration) = (view(&textures.heights), view(&textures.acceleration));
        let resources = [
            uniform.raw().as_entire_binding(),
            wgpu::BindingResource::TextureView(&heights),
            wgpu::BindingResource::TextureView(&acceleration),
            rays.raw().as_entire_binding(),
            hits.raw().as_entire_binding(),
        ];
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: self.kernel.spread(gpu, rays.len() as u32),
        };
        Ok(Job::new(gpu, "surface/relief", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(march_layout: SurfaceMarch = SURFACE_RELIEF "SurfaceMarch");

    #[test]
    fn rays_and_hits_are_laid_out_as_the_shader_sees_them() {
        let size = |name: &str| {
            shaders::SURFACE_RELIEF
                .structs
                .iter()
                .find(|layout| layout.name == name)
                .map(|layout| layout.size)
        };
        assert_eq!(size("SurfaceRay"), Some(size_of::<Ray>() as u32));
        assert_eq!(size("SurfaceHit"), Some(size_of::<Hit>() as u32));
        let at = |name: &str| {
            let layout = shaders::SURFACE_RELIEF.structs.iter().find(|layout| layout.name == name);
            layout
                .map(|layout| layout.members.iter().map(|member| member.offset as usize).collect::<Vec<_>>())
        };
        let ray = [0, 8, std::mem::offset_of!(Ray, cosine), std::mem::offset_of!(Ray, polygon)];
        assert_eq!(at("SurfaceRay"), Some(ray.to_vec()));
        use std::mem::offset_of;
        let hit = [
            offset_of!(Hit, uv),
            offset_of!(Hit, height),
            offset_of!(Hit, parameter),
            offset_of!(Hit, samples),
            offset_of!(Hit, code),
        ];
        assert_eq!(at("SurfaceHit"), Some(hit.to_vec()));
    }
}
