//! Heights of windows and regions by any generator, through one type.

use crate::gpu::{Gpu, Upload};
use crate::terrain::config::{Border, HeightGenerator, HeightInterpolation, TerrainConfig};
use crate::terrain::features::Features;
use crate::terrain::fixed::FeatureMode;
use crate::terrain::height::HeightPass;
use crate::terrain::levels::{GivenHeights, HeightBuffers, HeightJob, LevelPass};
use crate::terrain::noise::{NoiseJob, NoisePass};
use crate::terrain::smooth::SmoothPass;
use crate::terrain::window::{Regions, Windows};
use crate::terrain::wrap::WrapPass;
use crate::{Error, InputError};

/// Generates heights by the generator of a configuration.
#[derive(Debug, Clone)]
pub struct RegionPass(Pass);

#[derive(Debug, Clone)]
enum Pass {
    /// Levels of subdivision.
    Levels(LevelPass),
    /// Octaves of noise.
    Noise(NoisePass),
}

impl RegionPass {
    /// Compiles the pipeline of a configuration. `features` is the mode in which features are injected; `None` compiles it
    /// without features.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, config: &TerrainConfig, features: Option<FeatureMode>) -> Result<Self, Error> {
        let offset = config.offset;
        Ok(Self(match (config.generator, config.border, config.interpolation) {
            (HeightGenerator::DiamondSquare, Border::Seamless, HeightInterpolation::Linear) => {
                Pass::Levels(HeightPass::new(gpu, offset, features)?.0)
            }
            (HeightGenerator::DiamondSquare, Border::Seamless, HeightInterpolation::Smooth) => {
                Pass::Levels(SmoothPass::new(gpu, offset, features)?.0)
            }
            (HeightGenerator::DiamondSquare, ..) => Pass::Levels(WrapPass::new(gpu, offset, features)?.0),
            (generator, ..) => Pass::Noise(NoisePass::new(gpu, generator)?),
        }))
    }

    /// Name of the kernel.
    pub fn label(&self) -> &'static str {
        match &self.0 {
            Pass::Levels(pass) => pass.label,
            Pass::Noise(_) => "terrain/noise",
        }
    }

    /// Prepares the generation of `windows`. The configuration must be valid.
    ///
    /// # Errors
    /// [`InputError`] for an apron out of bounds, and for buffers that are too short; [`crate::gpu::GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        windows: Windows,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
    ) -> Result<RegionJob, Error> {
        Ok(RegionJob(match &self.0 {
            Pass::Levels(pass) => {
                Prepared::Levels(Box::new(pass.prepare(gpu, config, windows, feature_capacity, buffers)?))
            }
            Pass::Noise(pass) => {
                Prepared::Noise(Box::new(pass.prepare(gpu, config, windows, buffers.output)?))
            }
        }))
    }

    /// Prepares the generation of `regions`. The configuration must be valid.
    ///
    /// # Errors
    /// [`InputError`] for regions coarser than the generator can make, and for buffers that are too short;
    /// [`crate::gpu::GpuError`].
    pub fn prepare_regions(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        regions: Regions,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
    ) -> Result<RegionJob, Error> {
        self.prepare_given(gpu, config, regions, feature_capacity, buffers, None)
    }

    /// The same as [`RegionPass::prepare_regions`], with given heights on one lattice. Noise ignores them: no height depends on
    /// another.
    pub(crate) fn prepare_given(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        regions: Regions,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
        given: Option<GivenHeights<'_>>,
    ) -> Result<RegionJob, Error> {
        Ok(RegionJob(match &self.0 {
            Pass::Levels(pass) => {
                let job = pass.prepare_regions(gpu, config, regions, feature_capacity, buffers, given)?;
                Prepared::Levels(Box::new(job))
            }
            Pass::Noise(pass) => {
                Prepared::Noise(Box::new(pass.prepare_regions(gpu, config, regions, buffers.output)?))
            }
        }))
    }
}

/// A prepared generation of a batch of windows or regions by any generator. Set the patches or regions, then record any number of
/// times.
#[derive(Debug, Clone)]
pub struct RegionJob(Prepared);

#[derive(Debug, Clone)]
enum Prepared {
    /// Levels of subdivision.
    Levels(Box<HeightJob>),
    /// Octaves of noise.
    Noise(Box<NoiseJob>),
}

impl RegionJob {
    /// Sets the patches and features for the next recordings; see [`HeightJob::set`].
    ///
    /// # Errors
    /// As [`HeightJob::set`]; [`InputError`] for features with noise.
    pub fn set(&self, gpu: &Gpu, patches: &[[i32; 2]], features: &Features) -> Result<(), Error> {
        match &self.0 {
            Prepared::Levels(job) => job.set(gpu, patches, features),
            Prepared::Noise(job) => {
                without(features)?;
                job.set(gpu, patches)
            }
        }
    }

    /// Sets the regions, by their first samples, and features for the next recordings
    /// ([`Region::first`](crate::ops::terrain::window::Region::first)). The number of regions must not exceed the prepared count.
    ///
    /// # Errors
    /// [`InputError`] for too many regions or regions out of bounds, and for features with noise; [`crate::gpu::GpuError::Limit`] for
    /// more features than the capacity.
    pub fn set_regions(&self, gpu: &Gpu, firsts: &[[i64; 2]], features: &Features) -> Result<(), Error> {
        self.stage_regions(&mut &*gpu, firsts, features)
    }

    /// The same as [`RegionJob::set_regions`] with writes of any kind, such as staged ones.
    ///
    /// # Errors
    /// Those of [`RegionJob::set_regions`].
    pub(crate) fn stage_regions(
        &self,
        to: &mut impl Upload,
        firsts: &[[i64; 2]],
        features: &Features,
    ) -> Result<(), Error> {
        match &self.0 {
            Prepared::Levels(job) => job.set_regions(to, firsts, features),
            Prepared::Noise(job) => {
                without(features)?;
                job.set_regions(to, firsts)
            }
        }
    }

    /// Number of features that regions, given by their first samples, need room for.
    pub(crate) fn feature_count(&self, firsts: &[[i64; 2]], features: &Features) -> usize {
        match &self.0 {
            Prepared::Levels(job) if !features.is_empty() => job.feature_count(firsts, features),
            _ => 0,
        }
    }

    /// Stages the given heights of a region of the batch.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub(crate) fn stage_given(
        &self,
        to: &mut impl Upload,
        number: usize,
        heights: &[i32],
    ) -> Result<(), Error> {
        match &self.0 {
            Prepared::Levels(job) => Ok(job.stage_given(to, number, heights)?),
            Prepared::Noise(_) => Ok(()),
        }
    }

    /// Records the generation of all windows or regions of the batch.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        match &self.0 {
            Prepared::Levels(job) => job.record(encoder),
            Prepared::Noise(job) => job.record(encoder),
        }
    }
}

fn without(features: &Features) -> Result<(), InputError> {
    let bound = || "must be empty: only the generator \"diamondSquare\" spreads injected heights";
    InputError::check(features.is_empty(), "features.len", features.len(), bound)
}
