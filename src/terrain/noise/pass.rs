//! The GPU pass of `kernels/terrain/noise.wgsl`: one dispatch for a batch of regions.

use std::array;

use crate::gpu::bindings::terrain::noise as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::terrain::noise::NoiseParams;
use crate::terrain::config::TerrainConfig;
use crate::terrain::window::Regions;
use crate::{Error, InputError};

/// Generates heights from octaves of noise. Each pass is compiled for one generator.
#[derive(Debug, Clone)]
pub struct NoisePass(Kernel);

impl NoisePass {
    /// Compiles the pipeline of a generator of noise, by its number in the shader.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, generator: u32) -> Result<Self, GpuError> {
        Ok(Self(bindings::kernel(gpu, &bindings::Constants { generator })?))
    }

    /// Prepares the generation of `regions`, which begin at the samples in `origins`. `output` must hold all heights of the regions. The configuration must be valid, and that
    /// of this generator.
    ///
    /// # Errors
    /// [`InputError`] for regions coarser than the base lattice, and for an output that is too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        regions: Regions,
        origins: &Buffer<[i32; 2]>,
        output: &Buffer<i32>,
    ) -> Result<Job, Error> {
        let Regions { count, width, coarser } = regions;
        InputError::check_within("coarser", coarser, 0..=config.levels())?;
        output.check_holds("output", regions.points())?;
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
        let group = bindings::Group {
            params: &Uniform::new(gpu, "noise", &params)?,
            origins: origins.slice(),
            heights: output.slice(),
        };
        let groups = vec![group.bind(gpu, &self.0)?];
        let step = Step::covering(&self.0, groups, [width, width, count]);
        Ok(Job::new(gpu, "terrain/noise", vec![step])?)
    }
}
