//! `kernels/terrain/despike.wgsl`.

use encase::ShaderType;

use super::Despike;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::terrain::features::{FeatureGrid, FeatureIndex};
use crate::terrain::fields::Fields;
use crate::{Error, InputError};

/// `DespikeParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct DespikeParams {
    pub features: FeatureGrid,
    pub in_width: u32,
    pub threshold: i32,
}

/// Removes spikes.
#[derive(Debug, Clone)]
pub struct DespikePass {
    kernel: Kernel,
}

impl DespikePass {
    /// Compiles the pipeline. `with_features` says whether there are points to leave alone.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, with_features: bool) -> Result<Self, GpuError> {
        let constants = [("FEATURES", f64::from(u8::from(with_features)))];
        Ok(Self { kernel: Kernel::new(gpu, &shaders::TERRAIN_DESPIKE, &constants)? })
    }

    /// Prepares despiking of `windows` into `cropped`, one sample smaller on every side. Grid 0 of
    /// `features` covers the windows.
    ///
    /// # Errors
    /// [`InputError`] for a threshold out of bounds, windows without a rim, features of other windows, or an
    /// output that is too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        despike: Despike,
        windows: &Fields,
        features: &FeatureIndex,
        cropped: &Fields,
    ) -> Result<Job, Error> {
        despike.validate()?;
        windows.check("windows", 1)?;
        cropped.heights.check_holds("cropped.heights", windows.points(1))?;
        let grid = features.grid(0);
        if grid.width != windows.width {
            let bound = format!("must be that of the windows, {}", windows.width);
            return Err(InputError::new("features.width", grid.width, bound).into());
        }
        let params =
            DespikeParams { features: grid, in_width: windows.width, threshold: despike.fixed_threshold() };
        let uniform = Uniform::new(gpu, "despike", &params)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            windows.heights.raw().as_entire_binding(),
            cropped.heights.raw().as_entire_binding(),
        ];
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![
                self.kernel.bind(gpu, 0, &resources)?,
                self.kernel.bind(gpu, 1, &features.resources())?,
            ],
            workgroups: windows.workgroups(&self.kernel, 1),
        };
        Ok(Job::new(gpu, "terrain/despike", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(despike_params_layout: DespikeParams = TERRAIN_DESPIKE "DespikeParams");
}
