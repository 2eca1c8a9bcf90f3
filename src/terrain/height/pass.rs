//! The GPU pass of `kernels/terrain/height.wgsl`: one dispatch per level, for a batch of windows.

use crate::gpu::bindings::terrain::height as bindings;
use crate::gpu::{Gpu, GpuError, Group, Kernel};
use crate::terrain::config::Offset;
use crate::terrain::fixed::FeatureMode;
use crate::terrain::levels::{LevelBuffers, LevelPass, LevelStage, LevelThreads};

/// The pass that generates diamond-square heights of `seamless` windows.
///
/// # Errors
/// Shader compilation errors of the driver.
pub(crate) fn pass(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<LevelPass, GpuError> {
    let constants =
        bindings::Constants { distribution: offset.code(), features: FeatureMode::code_of(features) };
    let kernel = bindings::kernel(gpu, &constants)?;
    let stages = vec![LevelStage { kernel, threads: LevelThreads::Points }];
    Ok(LevelPass { label: "terrain/height", stages, bind, with_features: features.is_some() })
}

fn bind(gpu: &Gpu, kernel: &Kernel, buffers: LevelBuffers<'_>) -> Result<Vec<Group>, GpuError> {
    let LevelBuffers { level, origins, coarse, fine, features, .. } = buffers;
    let (origins, coarse, fine) = (origins.slice(), coarse.slice(), fine.slice());
    let group = bindings::Group { level, origins, coarse, fine };
    let injected = bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
    Ok(vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?])
}
