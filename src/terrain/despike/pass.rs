//! The GPU pass of `kernels/terrain/despike.wgsl`.

use super::Despike;
use crate::gpu::bindings::terrain::despike as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::terrain::despike::DespikeParams;
use crate::terrain::features::FeatureIndex;
use crate::terrain::fields::Fields;
use crate::{Error, InputError};

/// Buffers of a despiking job.
#[derive(Debug, Clone, Copy)]
pub struct DespikeBuffers<'a> {
    /// Read: the windows.
    pub windows: &'a Fields,
    /// Read: index of the injected points, which despiking leaves unchanged. The first grid of the index must be as wide as the
    /// windows.
    pub features: &'a FeatureIndex,
    /// Written: the despiked windows, one sample smaller on every side.
    pub cropped: &'a Fields,
}

/// Replaces spikes in windows of heights; see [`Despike`].
#[derive(Debug, Clone)]
pub struct DespikePass {
    kernel: Kernel,
}

impl DespikePass {
    /// Compiles the pipeline for windows without injected points. The pass then ignores [`DespikeBuffers::features`].
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu, &bindings::Constants { features: 0 })? })
    }

    /// Compiles the pipeline for windows with injected points, which the kernel leaves unchanged.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn with_features(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu, &bindings::Constants { features: 1 })? })
    }

    /// Prepares a job that despikes all windows.
    ///
    /// # Errors
    /// [`InputError`] for a threshold out of bounds, for windows with nothing inside the outermost ring, for an index of features
    /// that is not as wide as the windows, and for an output that is too short; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, despike: Despike, buffers: DespikeBuffers<'_>) -> Result<Job, Error> {
        let DespikeBuffers { windows, features, cropped } = buffers;
        despike.validate()?;
        windows.check("windows", 1)?;
        cropped.heights.check_holds("cropped.heights", windows.points(1))?;
        let grid = features.grid(0);
        let bound = || format!("must be that of the windows, {}", windows.width);
        InputError::check(grid.width == windows.width, "features.width", grid.width, bound)?;
        let params =
            DespikeParams { features: grid, width: windows.width, threshold: despike.fixed_threshold() };
        let group = bindings::Group {
            params: &Uniform::new(gpu, "despike", &params)?,
            windows: windows.heights.slice(),
            outputs: cropped.heights.slice(),
        };
        let injected =
            bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
        let groups = vec![group.bind(gpu, &self.kernel)?, injected.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, windows.threads(1));
        Ok(Job::new(gpu, "terrain/despike", vec![step])?)
    }
}
