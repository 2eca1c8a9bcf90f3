//! The GPU pass of `kernels/terrain/height.wgsl`: one dispatch per level, for a batch of windows.

use crate::gpu::bindings::terrain::height as bindings;
use crate::gpu::{Gpu, GpuError, Group, Kernel};
use crate::terrain::config::{Border, HeightInterpolation, Offset, TerrainConfig};
use crate::terrain::fixed::FeatureMode;
use crate::terrain::levels::{HeightBuffers, HeightJob, LevelBuffers, LevelPass, LevelStage, LevelThreads};
use crate::terrain::window::Windows;
use crate::{Error, InputError};

/// Generates diamond-square heights of `seamless` windows. Each pass is compiled for one distribution of random offsets and one
/// mode of feature injection.
#[derive(Debug, Clone)]
pub struct HeightPass(pub(in crate::terrain) LevelPass);

impl HeightPass {
    /// Compiles the pipeline. `features` is the mode in which features are injected; `None` compiles it without features.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<Self, GpuError> {
        let distribution = offset.code();
        let constants = bindings::Constants { distribution, features: features.map_or(0, FeatureMode::code) };
        let kernel = bindings::kernel(gpu, &constants)?;
        let stages = vec![LevelStage { kernel, threads: LevelThreads::Points }];
        Ok(Self(LevelPass { label: "terrain/height", stages, bind, with_features: features.is_some() }))
    }

    /// Prepares the generation of `windows`. `feature_capacity` is the largest number of injected points. A point counts once for
    /// every window that depends on it.
    ///
    /// # Errors
    /// [`InputError`] for a configuration that is not `seamless` or is out of bounds, for an apron out of bounds, and for buffers
    /// that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        windows: Windows,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
    ) -> Result<HeightJob, Error> {
        config.validate()?;
        if config.border != Border::Seamless {
            let value = format!("{:?}", config.border).to_lowercase();
            return Err(
                InputError::new("border", value, "must be \"seamless\" for windows of the plane").into()
            );
        }
        if config.interpolation != HeightInterpolation::Linear {
            let bound = "must be \"linear\" in this pass: SmoothPass makes the others";
            return Err(InputError::new("interpolation", "smooth", bound).into());
        }
        self.0.prepare(gpu, config, windows, feature_capacity, buffers)
    }
}

fn bind(gpu: &Gpu, kernel: &Kernel, buffers: LevelBuffers<'_>) -> Result<Vec<Group>, GpuError> {
    let LevelBuffers { level, origins, coarse, fine, features, .. } = buffers;
    let (origins, coarse, fine) = (origins.slice(), coarse.slice(), fine.slice());
    let group = bindings::Group { level, origins, coarse, fine };
    let injected = bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
    Ok(vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?])
}
