//! The GPU pass of `kernels/terrain/noise.wgsl`: one dispatch for a batch of regions.

use std::array;

use crate::gpu::bindings::terrain::noise as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, Upload};
use crate::shared::terrain::noise as shared;
use crate::shared::terrain::noise::NoiseParams;
use crate::terrain::config::{HeightGenerator, TerrainConfig};
use crate::terrain::window::{Region, Regions, Window, Windows};
use crate::{Error, InputError};

/// Generates heights from octaves of noise. Each pass is compiled for one generator.
#[derive(Debug, Clone)]
pub struct NoisePass {
    kernel: Kernel,
    generator: HeightGenerator,
}

impl NoisePass {
    /// Compiles the pipeline of a generator of noise.
    ///
    /// # Errors
    /// [`InputError`] for diamond-square; shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, generator: HeightGenerator) -> Result<Self, Error> {
        let code = match generator {
            HeightGenerator::Fbm => shared::NOISE_FBM,
            HeightGenerator::Ridged => shared::NOISE_RIDGED,
            HeightGenerator::Simplex => shared::NOISE_SIMPLEX,
            HeightGenerator::DiamondSquare => {
                let bound = "must be a generator of noise in this pass: HeightPass makes diamond-square";
                return Err(InputError::new("generator", "diamondSquare", bound).into());
            }
        };
        Ok(Self { kernel: bindings::kernel(gpu, &bindings::Constants { generator: code })?, generator })
    }

    /// Prepares the generation of `windows`. `output` must hold all heights of the windows.
    ///
    /// # Errors
    /// [`InputError`] for a configuration of another generator or out of bounds, for an apron out of bounds, and for an output
    /// that is too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        windows: Windows,
        output: &Buffer<i32>,
    ) -> Result<NoiseJob, Error> {
        config.validate()?;
        Window { patch: [0, 0], apron: windows.apron }.validate(config)?;
        let job = self.prepare_regions(gpu, config, windows.regions(config), output)?;
        Ok(NoiseJob { apron: windows.apron, ..job })
    }

    /// Prepares the generation of `regions`. `output` must hold all heights of the regions.
    ///
    /// # Errors
    /// [`InputError`] for a configuration of another generator or out of bounds, for regions coarser than the base lattice, and
    /// for an output that is too short; [`GpuError`].
    pub fn prepare_regions(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        regions: Regions,
        output: &Buffer<i32>,
    ) -> Result<NoiseJob, Error> {
        config.validate()?;
        let bound = || format!("must be {:?}, for which the pass was compiled", self.generator);
        let same = config.generator == self.generator;
        InputError::check(same, "generator", format!("{:?}", config.generator), bound)?;
        let Regions { count, width, coarser } = regions;
        InputError::check_within("coarser", coarser, 0..=config.levels())?;
        output.check_holds("output", count as usize * (width as usize).pow(2))?;
        let octaves = config.octaves(coarser);
        let range = |octave: usize| config.level_range(octave as u32);
        let params = NoiseParams {
            key: config.key().into(),
            width,
            spacing: (config.sample_spacing() << coarser) as u32,
            base_log2: config.base_log2(),
            octaves,
            ranges: array::from_fn(|four| array::from_fn(|lane| range(4 * four + lane)).into()),
        };
        let origins = Buffer::new(gpu, "region origins", count as usize)?;
        let group = bindings::Group {
            params: &Uniform::new(gpu, "noise", &params)?,
            origins: origins.slice(),
            heights: output.slice(),
        };
        let groups = vec![group.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, [width, width, count]);
        let job = Job::new(gpu, "terrain/noise", vec![step])?;
        Ok(NoiseJob { config: config.clone(), regions, apron: 0, origins, job })
    }
}

/// A prepared generation of a batch of windows or regions. Set the patches or regions, then record any number of times.
#[derive(Debug, Clone)]
pub struct NoiseJob {
    config: TerrainConfig,
    regions: Regions,
    apron: u32,
    /// First sample of each region, in distances between samples.
    origins: Buffer<[i32; 2]>,
    job: Job,
}

impl NoiseJob {
    /// Sets the patches for the next recordings. The number of patches must not exceed the prepared count.
    ///
    /// # Errors
    /// [`InputError`] for too many patches or patches out of bounds; [`GpuError`].
    pub fn set(&self, gpu: &Gpu, patches: &[[i32; 2]]) -> Result<(), Error> {
        let windows = patches.iter().map(|patch| Window { patch: *patch, apron: self.apron });
        self.check_count("patches.len", patches.len())?;
        windows.clone().try_for_each(|window| window.validate(&self.config))?;
        let firsts: Vec<_> = windows.map(|window| window.region(&self.config).first).collect();
        Ok(self.write(&mut &*gpu, &firsts)?)
    }

    /// Sets the regions, by their first samples, for the next recordings ([`Region::first`]). The number of regions must not
    /// exceed the prepared count.
    ///
    /// # Errors
    /// [`InputError`] for too many regions or regions out of bounds; [`GpuError`].
    pub(crate) fn set_regions(&self, to: &mut impl Upload, firsts: &[[i64; 2]]) -> Result<(), Error> {
        self.check_count("firsts.len", firsts.len())?;
        let Regions { width, coarser, .. } = self.regions;
        let region = |first: &[i64; 2]| Region { first: *first, width, coarser };
        firsts.iter().map(region).try_for_each(|region| region.validate(&self.config))?;
        Ok(self.write(to, firsts)?)
    }

    fn check_count(&self, path: &str, count: usize) -> Result<(), InputError> {
        let most = self.regions.count;
        let bound = || format!("must be at most {most}, the batch's count");
        InputError::check(count <= most as usize, path, count, bound)
    }

    fn write(&self, to: &mut impl Upload, firsts: &[[i64; 2]]) -> Result<(), GpuError> {
        let origins: Vec<_> = firsts.iter().map(|first| first.map(|index| index as i32)).collect();
        to.elements(&self.origins, 0, &origins)
    }

    /// Records the generation of all windows or regions of the batch.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }
}
