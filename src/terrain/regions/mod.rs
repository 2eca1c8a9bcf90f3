//! Heights of windows and regions by the generator of a configuration.

mod batch;

use crate::gpu::{Buffer, Gpu, Job, Upload};
use crate::shared::terrain::noise::{NOISE_FBM, NOISE_RIDGED, NOISE_SIMPLEX};
use crate::terrain::config::{Border, HeightGenerator, HeightInterpolation, Offset, TerrainConfig};
use crate::terrain::features::Features;
use crate::terrain::fixed::FeatureMode;
use crate::terrain::levels::{LevelJob, LevelPass};
use crate::terrain::noise::NoisePass;
use crate::terrain::window::{Region, Regions, Window, Windows};
use crate::terrain::{height, smooth, wrap};
use crate::{Error, InputError};

pub use crate::terrain::levels::{GivenHeights, HeightBuffers, HeightScratch};
pub use batch::HeightBatch;

/// Generates heights. Each pass is compiled for one generator, border mode, interpolation and distribution of random offsets, and for
/// one mode of feature injection.
#[derive(Debug, Clone)]
pub struct RegionPass {
    pass: Pass,
    compiled: Compiled,
}

#[derive(Debug, Clone)]
enum Pass {
    /// Levels of subdivision.
    Levels(LevelPass),
    /// Octaves of noise.
    Noise(NoisePass),
}

/// The parts of a configuration for which a pass is compiled.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Compiled {
    generator: HeightGenerator,
    is_seamless: bool,
    interpolation: HeightInterpolation,
    offset: Offset,
}

impl Compiled {
    fn of(config: &TerrainConfig) -> Self {
        let TerrainConfig { generator, border, interpolation, offset, .. } = *config;
        Self { generator, is_seamless: border == Border::Seamless, interpolation, offset }
    }
}

impl RegionPass {
    /// Compiles the pipeline of a configuration. `features` is the mode in which features are injected; `None` compiles it
    /// without features.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, config: &TerrainConfig, features: Option<FeatureMode>) -> Result<Self, Error> {
        let compiled = Compiled::of(config);
        let pass = match compiled.generator {
            HeightGenerator::DiamondSquare => {
                let pass = match (compiled.is_seamless, compiled.interpolation) {
                    (true, HeightInterpolation::Linear) => height::pass,
                    (true, HeightInterpolation::Smooth) => smooth::pass,
                    (false, _) => wrap::pass,
                };
                Pass::Levels(pass(gpu, compiled.offset, features)?)
            }
            HeightGenerator::Fbm => Pass::Noise(NoisePass::new(gpu, NOISE_FBM)?),
            HeightGenerator::Ridged => Pass::Noise(NoisePass::new(gpu, NOISE_RIDGED)?),
            HeightGenerator::Simplex => Pass::Noise(NoisePass::new(gpu, NOISE_SIMPLEX)?),
        };
        Ok(Self { pass, compiled })
    }

    /// Prepares the generation of `windows`. `feature_capacity` is the largest number of injected points. A point counts once for
    /// every window that depends on it.
    ///
    /// # Errors
    /// [`InputError`] for a configuration out of bounds or one for which the pass was not compiled, for an apron out of bounds, and for
    /// buffers that are too short; [`crate::gpu::GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        windows: Windows,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
    ) -> Result<RegionJob, Error> {
        config.validate()?;
        let Windows { apron, .. } = windows;
        Window { patch: [0, 0], apron }.validate(config)?;
        let regions = windows.regions(config);
        let job = self.prepare_regions(gpu, config, regions, feature_capacity, buffers, None)?;
        Ok(RegionJob { apron, ..job })
    }

    /// Prepares the generation of `regions`, with given heights on one lattice or none. Noise ignores them: no height depends on
    /// another. The configuration must be valid.
    ///
    /// # Errors
    /// [`InputError`] for a configuration for which the pass was not compiled, for regions coarser than the generator can make, and for
    /// buffers that are too short; [`crate::gpu::GpuError`].
    pub fn prepare_regions(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        regions: Regions,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
        given: Option<GivenHeights<'_>>,
    ) -> Result<RegionJob, Error> {
        let (asked, compiled) = (Compiled::of(config), self.compiled);
        let bound = || format!("must be {compiled:?}, for which the pass was compiled");
        InputError::check(asked == compiled, "config", format!("{asked:?}"), bound)?;
        let prepared = match &self.pass {
            Pass::Levels(pass) => {
                let job = pass.prepare(gpu, config, regions, feature_capacity, buffers, given)?;
                Prepared::Levels(Box::new(job))
            }
            Pass::Noise(pass) => {
                let origins = Buffer::new(gpu, "region origins", regions.count as usize)?;
                let job = pass.prepare(gpu, config, regions, &origins, buffers.output)?;
                Prepared::Noise(origins, job)
            }
        };
        Ok(RegionJob { config: config.clone(), regions, apron: 0, prepared })
    }
}

/// A prepared generation of a batch of windows or regions. Set the patches or regions, then record any number of times.
#[derive(Debug, Clone)]
pub struct RegionJob {
    config: TerrainConfig,
    regions: Regions,
    apron: u32,
    prepared: Prepared,
}

#[derive(Debug, Clone)]
enum Prepared {
    /// Levels of subdivision.
    Levels(Box<LevelJob>),
    /// Octaves of noise, of regions whose first samples are in the buffer.
    Noise(Buffer<[i32; 2]>, Job),
}

impl RegionJob {
    /// Sets the patches and features for the next recordings. The number of patches must not exceed the prepared count.
    ///
    /// # Errors
    /// [`InputError`] for too many patches or patches out of bounds, and for features with noise; [`crate::gpu::GpuError::Limit`] for more
    /// features than the capacity.
    pub fn set(&self, gpu: &Gpu, patches: &[[i32; 2]], features: &Features) -> Result<(), Error> {
        self.check_count("patches.len", patches.len())?;
        let windows = patches.iter().map(|patch| Window { patch: *patch, apron: self.apron });
        windows.clone().try_for_each(|window| window.validate(&self.config))?;
        let regions: Vec<Region> = windows.map(|window| window.region(&self.config)).collect();
        let worlds: Vec<_> = patches.iter().map(|patch| Features::world_of(&self.config, *patch)).collect();
        self.write(&mut &*gpu, &regions, &worlds, features)
    }

    /// Sets the regions, by their first samples, and features for the next recordings ([`Region::first`]). The number of regions
    /// must not exceed the prepared count.
    ///
    /// # Errors
    /// [`InputError`] for too many regions or regions out of bounds, and for features with noise; [`crate::gpu::GpuError::Limit`] for more
    /// features than the capacity.
    pub fn set_regions(
        &self,
        to: &mut impl Upload,
        firsts: &[[i64; 2]],
        features: &Features,
    ) -> Result<(), Error> {
        self.check_count("firsts.len", firsts.len())?;
        let regions = self.regions_at(firsts);
        regions.iter().try_for_each(|region| region.validate(&self.config))?;
        self.write(to, &regions, &vec![[0, 0]; firsts.len()], features)
    }

    /// Number of features that regions, given by their first samples, need room for.
    pub(crate) fn feature_count(&self, firsts: &[[i64; 2]], features: &Features) -> usize {
        match &self.prepared {
            Prepared::Levels(job) if !features.is_empty() => {
                job.feature_count(&self.regions_at(firsts), features)
            }
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
        match &self.prepared {
            Prepared::Levels(job) => Ok(job.stage_given(to, number, heights)?),
            Prepared::Noise(..) => Ok(()),
        }
    }

    /// Records the generation of all windows or regions of the batch.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        match &self.prepared {
            Prepared::Levels(job) => job.record(encoder),
            Prepared::Noise(_, job) => job.record(encoder),
        }
    }

    fn regions_at(&self, firsts: &[[i64; 2]]) -> Vec<Region> {
        let Regions { width, coarser, .. } = self.regions;
        firsts.iter().map(|first| Region { first: *first, width, coarser }).collect()
    }

    fn check_count(&self, path: &str, count: usize) -> Result<(), InputError> {
        let bound = || format!("must be at most {}, the batch's count", self.regions.count);
        InputError::check(count <= self.regions.count as usize, path, count, bound)
    }

    /// Writes what the next recordings need for regions. `worlds` are the worlds of their features.
    fn write(
        &self,
        to: &mut impl Upload,
        regions: &[Region],
        worlds: &[[i32; 2]],
        features: &Features,
    ) -> Result<(), Error> {
        match &self.prepared {
            Prepared::Levels(job) => job.write(to, regions, worlds, features),
            Prepared::Noise(origins, _) => {
                let bound = || "must be empty: only the generator \"diamondSquare\" spreads injected heights";
                InputError::check(features.is_empty(), "features.len", features.len(), bound)?;
                let first = |region: &Region| region.first.map(|index| index as i32);
                Ok(to.elements(origins, 0, &regions.iter().map(first).collect::<Vec<_>>())?)
            }
        }
    }
}
