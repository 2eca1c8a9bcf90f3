//! The GPU pass of `kernels/terrain/thermal.wgsl`, with one dispatch per iteration.

use super::Thermal;
use crate::Error;
use crate::gpu::bindings::terrain::thermal as bindings;
use crate::gpu::{Gpu, Job, Step, Uniform, pass};
use crate::shared::terrain::thermal::ThermalParams;
use crate::terrain::config::check_terrain_scale;
use crate::terrain::fields::Fields;

/// Buffers of thermal erosion.
#[derive(Debug, Clone, Copy)]
pub struct ThermalBuffers<'a> {
    /// Read and written: the windows to erode.
    pub windows: &'a Fields,
    /// Written: a second buffer. The iterations alternate between `windows` and this buffer. It must hold the same number of
    /// windows, each one sample smaller on every side.
    pub other: &'a Fields,
}

pass! {
    /// Applies thermal erosion to windows of heights; see [`Thermal`].
    pub struct ThermalPass;
}

impl ThermalPass {
    /// Prepares all iterations. They alternate between `windows` and `other`, and each drops the outermost ring of samples. After
    /// an even number of iterations the result is in `windows`, otherwise in `other`.
    ///
    /// # Errors
    /// [`crate::InputError`] for parameters out of bounds, for windows with fewer rings of samples than iterations, and for a
    /// buffer that is too short; [`crate::gpu::GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        thermal: Thermal,
        terrain_scale: f64,
        buffers: ThermalBuffers<'_>,
    ) -> Result<Job, Error> {
        let ThermalBuffers { windows, other } = buffers;
        thermal.validate()?;
        check_terrain_scale(terrain_scale)?;
        windows.check("windows", thermal.iterations)?;
        other.heights.check_holds("other.heights", windows.points(thermal.iterations.min(1)))?;
        let threshold = thermal.fixed_threshold(terrain_scale);
        let mut steps = Vec::new();
        for iteration in 0..thermal.iterations {
            let (from, to) = if iteration % 2 == 0 { (windows, other) } else { (other, windows) };
            let at = windows.cropped(iteration);
            let params = ThermalParams { width: at.width, threshold };
            let group = bindings::Group {
                params: &Uniform::new(gpu, "thermal", &params)?,
                windows: from.heights.slice(),
                outputs: to.heights.slice(),
            };
            let groups = vec![group.bind(gpu, &self.kernel)?];
            steps.push(Step::covering(&self.kernel, groups, at.threads(1)));
        }
        Ok(Job::new(gpu, "terrain/thermal", steps)?)
    }
}
