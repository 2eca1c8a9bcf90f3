//! The GPU pass of `kernels/terrain/smooth.wgsl`: two dispatches per level, for a batch of windows.

use crate::gpu::bindings::terrain::smooth as bindings;
use crate::gpu::{Gpu, GpuError, Group, Kernel};
use crate::shared::terrain::smooth::{CENTERS, EDGES};
use crate::terrain::config::{HeightInterpolation, Offset, TerrainConfig};
use crate::terrain::fixed::FeatureMode;
use crate::terrain::levels::{HeightBuffers, HeightJob, LevelBuffers, LevelPass, LevelStage, LevelThreads};
use crate::terrain::window::Windows;
use crate::{Error, InputError};

/// Generates heights of smooth `seamless` windows. Each pass is compiled for one distribution of random offsets and one mode of
/// feature injection.
#[derive(Debug, Clone)]
pub struct SmoothPass(pub(in crate::terrain) LevelPass);

impl SmoothPass {
    /// Compiles the pipeline. `features` is the mode in which features are injected; `None` compiles it without features.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<Self, GpuError> {
        let distribution = offset.code();
        let code = features.map_or(0, FeatureMode::code);
        let stage = |stage, threads| {
            let constants = bindings::Constants { stage, distribution, features: code };
            Ok::<_, GpuError>(LevelStage { kernel: bindings::kernel(gpu, &constants)?, threads })
        };
        let stages = vec![stage(CENTERS, LevelThreads::Centers)?, stage(EDGES, LevelThreads::Points)?];
        Ok(Self(LevelPass { label: "terrain/smooth", stages, bind, with_features: features.is_some() }))
    }

    /// Prepares the generation of `windows`. `feature_capacity` is the largest number of injected points. A point counts once for
    /// every window that depends on it.
    ///
    /// # Errors
    /// [`InputError`] for a configuration that is not smooth or is out of bounds, for an apron out of bounds, and for buffers
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
        if config.interpolation != HeightInterpolation::Smooth {
            let bound = "must be \"smooth\" in this pass: HeightPass makes the others";
            return Err(InputError::new("interpolation", "linear", bound).into());
        }
        self.0.prepare(gpu, config, windows, feature_capacity, buffers)
    }
}

fn bind(gpu: &Gpu, kernel: &Kernel, buffers: LevelBuffers<'_>) -> Result<Vec<Group>, GpuError> {
    let LevelBuffers { level, origins, coarse, fine, centers, features } = buffers;
    let (origins, coarse, fine) = (origins.slice(), coarse.slice(), fine.slice());
    let group = bindings::Group { level, origins, coarse, fine, centers: centers.slice() };
    let injected = bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
    Ok(vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?])
}
