//! The GPU pass of `kernels/terrain/normals.wgsl`.

use crate::Error;
use crate::gpu::bindings::terrain::normals as bindings;
use crate::gpu::{Buffer, Gpu, Job, Step, Uniform, pass};
use crate::shared::terrain::normals::NormalsParams;
use crate::terrain::config::{HEIGHT_ONE, check_terrain_scale};
use crate::terrain::fields::Fields;

pass! {
    /// Computes slopes and unit normals of height fields.
    pub struct NormalsPass;
}

impl NormalsPass {
    /// Prepares a job that computes the slopes and normals of `windows`. Samples are `terrain_scale` world units apart. Both
    /// outputs have one entry per sample of the windows, without each window's outermost ring. `gradients` receives the central
    /// differences in 1/65536 height units. `normals` receives three components per sample: x, up, z.
    ///
    /// # Errors
    /// [`crate::InputError`] for a spacing out of bounds, for windows with nothing inside the outermost ring, and for outputs
    /// that are too short; [`crate::gpu::GpuError`].
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
