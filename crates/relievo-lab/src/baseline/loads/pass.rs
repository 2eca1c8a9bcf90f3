//! The GPU pass of `kernels/baseline/loads.wgsl`: loads texels and adds them up.

use glam::UVec2;
use relievo::gpu::bindings::baseline::loads as bindings;
use relievo::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use relievo::shared::baseline::loads::LoadsParams;
use relievo::{Error, InputError};

/// Loads texels along rows and adds them up.
#[derive(Debug, Clone)]
pub struct LoadsPass {
    kernel: Kernel,
}

impl LoadsPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares `threads` (columns, rows) that each load `loads` texels of a float texture and write one sum.
    ///
    /// # Errors
    /// [`InputError`] for a buffer with too few sums; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        texture: &wgpu::Texture,
        threads: [u32; 2],
        loads: u32,
        sums: &Buffer<f32>,
    ) -> Result<Job, Error> {
        if threads[0] as usize * threads[1] as usize > sums.len() {
            let bound = format!("must fit {} sums", sums.len());
            return Err(InputError::new("threads", format!("{threads:?}"), bound).into());
        }
        let params = LoadsParams { threads: UVec2::from(threads), loads };
        let uniform = Uniform::new(gpu, "loads", &params)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let group = bindings::Group { params: &uniform, texels: &view, sums: sums.slice() };
        let groups = vec![group.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, [threads[0], threads[1], 1]);
        Ok(Job::new(gpu, "baseline/loads", vec![step])?)
    }
}
