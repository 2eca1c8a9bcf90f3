//! `kernels/terrain/normals.wgsl`.

use encase::ShaderType;

use crate::Error;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::terrain::config::{HEIGHT_ONE, check_terrain_scale};
use crate::terrain::fields::Fields;

/// `NormalsParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct NormalsParams {
    pub in_width: u32,
    pub run: f32,
}

/// Computes slopes and unit normals.
#[derive(Debug, Clone)]
pub struct NormalsPass {
    kernel: Kernel,
}

impl NormalsPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::TERRAIN_NORMALS, &[])? })
    }

    /// Prepares the slopes of `windows`, whose samples are `terrain_scale` apart: for every sample but the
    /// rim, a central difference in `gradients` and three components (x, up, z) in `normals`.
    ///
    /// # Errors
    /// [`crate::InputError`] for a spacing out of bounds, windows without a rim, or outputs that are too
    /// short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        terrain_scale: f64,
        windows: &Fields,
        gradients: &Buffer<[i32; 2]>,
        normals: &Buffer<f32>,
    ) -> Result<Job, Error> {
        check_terrain_scale(terrain_scale)?;
        windows.check("windows", 1)?;
        gradients.check_holds("gradients", windows.points(1))?;
        normals.check_holds("normals", 3 * windows.points(1))?;
        let params =
            NormalsParams { in_width: windows.width, run: (2.0 * terrain_scale * HEIGHT_ONE) as f32 };
        let uniform = Uniform::new(gpu, "normals", &params)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            windows.heights.raw().as_entire_binding(),
            gradients.raw().as_entire_binding(),
            normals.raw().as_entire_binding(),
        ];
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: windows.workgroups(&self.kernel, 1),
        };
        Ok(Job::new(gpu, "terrain/normals", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(normals_params_layout: NormalsParams = TERRAIN_NORMALS "NormalsParams");
}
