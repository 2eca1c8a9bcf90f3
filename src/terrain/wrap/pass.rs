//! The GPU pass of `kernels/terrain/wrap.wgsl`: one dispatch per level, for a batch of patches.

use crate::gpu::bindings::terrain::wrap as bindings;
use crate::gpu::{Gpu, GpuError, Group, Kernel};
use crate::terrain::config::{Border, Offset, TerrainConfig};
use crate::terrain::fixed::FeatureMode;
use crate::terrain::levels::{HeightBuffers, HeightJob, LevelBuffers, LevelPass, LevelStage, LevelThreads};
use crate::terrain::window::Windows;
use crate::{Error, InputError};

/// Generates diamond-square heights of single patches. Each pass is compiled for one distribution of random offsets and one mode
/// of feature injection.
#[derive(Debug, Clone)]
pub struct WrapPass(pub(in crate::terrain) LevelPass);

impl WrapPass {
    /// Compiles the pipeline. `features` is the mode in which features are injected; `None` compiles it without features.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<Self, GpuError> {
        let distribution = offset.code();
        let constants = bindings::Constants { distribution, features: features.map_or(0, FeatureMode::code) };
        let kernel = bindings::kernel(gpu, &constants)?;
        let stages = vec![LevelStage { kernel, threads: LevelThreads::Points }];
        Ok(Self(LevelPass { label: "terrain/wrap", stages, bind, with_features: features.is_some() }))
    }

    /// Prepares the generation of `count` patches. The output receives patchSize² heights per patch. `feature_capacity` is the
    /// largest number of injected points. `buffers.scratch` must have been made for windows without an apron.
    ///
    /// # Errors
    /// [`InputError`] for a `seamless` configuration, for a configuration out of bounds, and for buffers that are too short;
    /// [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        count: u32,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
    ) -> Result<HeightJob, Error> {
        config.validate()?;
        let bound = || "must be \"wrap\" or {\"blend\": samples} for patches by themselves";
        InputError::check(config.border != Border::Seamless, "border", "\"seamless\"", bound)?;
        self.0.prepare(gpu, config, Windows { count, apron: 0 }, feature_capacity, buffers)
    }
}

fn bind(gpu: &Gpu, kernel: &Kernel, buffers: LevelBuffers<'_>) -> Result<Vec<Group>, GpuError> {
    let LevelBuffers { level, origins, coarse, fine, features, .. } = buffers;
    let (origins, coarse, fine) = (origins.slice(), coarse.slice(), fine.slice());
    let group = bindings::Group { level, origins, coarse, fine };
    let injected = bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
    Ok(vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?])
}
