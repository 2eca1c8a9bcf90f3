//! The GPU pass of `kernels/terrain/normals.wgsl`.

use crate::Error;
use crate::gpu::bindings::terrain::normals as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::terrain::normals::NormalsParams;
use crate::terrain::config::{HEIGHT_ONE, check_terrain_scale};
use crate::terrain::fields::Fields;

/// Computes the slopes and unit normals of height fields.
#[derive(Debug, Clone)]
pub struct NormalsPass {
    kernel: Kernel,
}

impl NormalsPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the slopes of `windows`, whose samples are `terrain_scale` world units apart. Outputs have one entry per
    /// sample, except for the outermost ring. `gradients` receives the central differences in 1/65536 units, and `normals`
    /// three components (x, up, z).
    /// # Errors
    /// [`crate::InputError`] for a spacing out of bounds, for windows with nothing inside the outermost ring, and for outputs
    /// that are too short; [`GpuError`].
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
        let run = (2.0 * terrain_scale * HEIGHT_ONE) as f32;
        let params = NormalsParams { width: windows.width, run };
        let group = bindings::Group {
            params: &Uniform::new(gpu, "normals", &params)?,
            windows: windows.heights.slice(),
            gradients: gradients.slice(),
            normals: normals.slice(),
        };
        let groups = vec![group.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, windows.threads(1));
        Ok(Job::new(gpu, "terrain/normals", vec![step])?)
    }
}
