//! The GPU pass of `kernels/terrain/smooth.wgsl`: two dispatches per level, for a batch of windows.

use crate::gpu::bindings::terrain::smooth as bindings;
use crate::gpu::{Gpu, GpuError, Group, Kernel};
use crate::shared::terrain::level::Level;
use crate::shared::terrain::smooth::{CENTERS, EDGES, ROWS};
use crate::terrain::config::Offset;
use crate::terrain::fixed::FeatureMode;
use crate::terrain::levels::{LevelBuffers, LevelPass, LevelStage, center_threads, point_threads};

/// The pass that generates smooth heights of `seamless` windows.
///
/// # Errors
/// Shader compilation errors of the driver.
pub(crate) fn pass(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<LevelPass, GpuError> {
    let stage = |stage, threads: fn(&Level) -> u32| {
        let constants = bindings::Constants {
            stage,
            distribution: offset.code(),
            features: FeatureMode::code_of(features),
        };
        Ok::<_, GpuError>(LevelStage { kernel: bindings::kernel(gpu, &constants)?, threads, rows: ROWS })
    };
    let stages = vec![stage(CENTERS, center_threads)?, stage(EDGES, point_threads)?];
    Ok(LevelPass { label: "terrain/smooth", stages, bind, with_features: features.is_some() })
}

fn bind(gpu: &Gpu, kernel: &Kernel, buffers: LevelBuffers<'_>) -> Result<Vec<Group>, GpuError> {
    let LevelBuffers { level, origins, coarse, fine, centers, features } = buffers;
    let (origins, coarse, fine) = (origins.slice(), coarse.slice(), fine.slice());
    let group = bindings::Group { level, origins, coarse, fine, centers: centers.slice() };
    let injected = bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
    Ok(vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?])
}
