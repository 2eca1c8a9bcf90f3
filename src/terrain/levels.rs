//! Levels of subdivision on the device, one or two dispatches per level. This is the common part of the passes that run
//! `kernels/terrain/height.wgsl`, `smooth.wgsl` and `wrap.wgsl`.

use crate::gpu::{Buffer, Gpu, GpuError, Group, Job, Kernel, Step, Uniform, Upload};
use crate::shared::terrain::level::Level;
use crate::terrain::config::{Border, HeightGenerator, HeightInterpolation, TerrainConfig};
use crate::terrain::features::{FeatureIndex, Features};
use crate::terrain::fields::REMEDY;
use crate::terrain::lattice::{base_lattice, corners};
use crate::terrain::replace::{ReplaceBuffers, ReplacePass};
use crate::terrain::window::{Lattice, Region, Regions, SMOOTH_RIM, Span, Windows};
use crate::{Error, InputError};

/// The kernel that computes one level of subdivision from the next coarser level.
#[derive(Debug, Clone)]
pub(crate) struct LevelPass {
    pub label: &'static str,
    /// The dispatches of a level, in order.
    pub stages: Vec<LevelStage>,
    /// Creates the bind groups of a stage.
    pub bind: fn(&Gpu, &Kernel, LevelBuffers<'_>) -> Result<Vec<Group>, GpuError>,
    pub with_features: bool,
}

/// The pass of a kernel that computes a level in one dispatch, for a distribution of random offsets and a mode of injection.
macro_rules! level_pass {
    ($name:ident, $label:literal) => {
        /// # Errors
        /// Shader compilation errors of the driver.
        pub(crate) fn pass(
            gpu: &$crate::gpu::Gpu,
            offset: $crate::terrain::config::Offset,
            features: Option<$crate::terrain::fixed::FeatureMode>,
        ) -> Result<$crate::terrain::levels::LevelPass, $crate::gpu::GpuError> {
            use $crate::gpu::bindings::terrain::$name as bindings;
            use $crate::terrain::levels::{LevelBuffers, LevelPass, LevelStage, point_threads};
            let constants = bindings::Constants {
                distribution: offset.code(),
                features: $crate::terrain::fixed::FeatureMode::code_of(features),
            };
            let kernel = bindings::kernel(gpu, &constants)?;
            let stages = vec![LevelStage { kernel, threads: point_threads, rows: 1 }];
            let bind = |gpu: &_, kernel: &_, buffers: LevelBuffers<'_>| {
                let LevelBuffers { level, origins, coarse, fine, features, .. } = buffers;
                let (origins, coarse, fine) = (origins.slice(), coarse.slice(), fine.slice());
                let (feature_words, feature_heights) = (features.words(), features.heights());
                let injected = bindings::Group1 { feature_words, feature_heights };
                let group = bindings::Group { level, origins, coarse, fine };
                Ok(vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?])
            };
            Ok(LevelPass { label: $label, stages, bind, with_features: features.is_some() })
        }
    };
}

pub(crate) use level_pass;

/// A dispatch of the kernel.
#[derive(Debug, Clone)]
pub(crate) struct LevelStage {
    pub kernel: Kernel,
    /// Number of threads along an edge of a window, if each had one row.
    pub threads: fn(&Level) -> u32,
    /// Number of rows of a thread.
    pub rows: u32,
}

/// Number of threads for the coarse points along an edge of a window: one more than half its fine points, because a window may start
/// anywhere in a cell.
pub(crate) fn point_threads(level: &Level) -> u32 {
    level.fine_width / 2 + 1
}

/// Number of threads for the centers along an edge of a window.
pub(crate) fn center_threads(level: &Level) -> u32 {
    centers(level.coarse_width)
}

/// Number of centers along an edge of a window.
fn centers(coarse_width: u32) -> u32 {
    coarse_width - 3
}

/// Buffers of the dispatches that compute the lattice `fine` from the lattice `coarse`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LevelBuffers<'a> {
    pub level: &'a Uniform<Level>,
    pub origins: &'a Buffer<[i32; 2]>,
    pub coarse: &'a Buffer<i32>,
    pub fine: &'a Buffer<i32>,
    /// Centers of coarse cells, which smooth interpolation needs; empty without.
    pub centers: &'a Buffer<i32>,
    pub features: &'a FeatureIndex,
}

impl LevelPass {
    /// Prepares the generation of `regions`, with given heights on one lattice or none. The configuration must be valid, and that of
    /// this kernel.
    ///
    /// # Errors
    /// [`InputError`] for regions coarser than the base lattice, and for buffers that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        regions: Regions,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
        given: Option<GivenHeights<'_>>,
    ) -> Result<LevelJob, Error> {
        let Regions { count, width, coarser } = regions;
        let HeightBuffers { output, scratch } = buffers;
        // One level is subdivided at least: the output is no base lattice.
        InputError::check_within("coarser", coarser, 0..=config.levels().saturating_sub(1))?;
        let widths = level_widths(config, width, coarser);
        output.check_holds("output", regions.points())?;
        scratch.check(config, &widths, count)?;
        let grids: Vec<u32> = widths[1..].iter().map(|width| width + 2 * (rim(config) - 1)).collect();
        let capacity = if self.with_features { feature_capacity.max(1) } else { 0 };
        let features = FeatureIndex::new(gpu, &grids, count, capacity)?;
        let base = Buffer::new(gpu, "base lattice", points(widths[0], count))?;
        let (mut origins, mut steps) = (Vec::new(), Vec::new());
        let mut given_heights = None;
        for level in 0..grids.len() {
            let left = grids.len() - 1 - level;
            let params = Level {
                key: config.key().into(),
                fine_width: widths[level + 1],
                coarse_width: widths[level],
                spacing: (config.sample_spacing() << (left + coarser as usize)) as u32,
                range: config.level_range(level as u32),
                edge_range: config.edge_range(level as u32),
                features: features.grid(level),
            };
            let starts = Buffer::new(gpu, "window origins", count as usize)?;
            let buffers = LevelBuffers {
                level: &Uniform::new(gpu, "terrain level", &params)?,
                origins: &starts,
                coarse: if level == 0 { &base } else { &scratch.buffers[left % 2] },
                fine: if left == 0 { output } else { &scratch.buffers[(left + 1) % 2] },
                centers: &scratch.centers,
                features: &features,
            };
            for LevelStage { kernel, threads, rows } in &self.stages {
                let edge = threads(&params);
                let threads = [edge, edge.div_ceil(*rows), count];
                steps.push(Step::covering(kernel, (self.bind)(gpu, kernel, buffers)?, threads));
            }
            if let Some(given) = given.filter(|given| given.coarser == left as u32 + coarser) {
                let width = params.fine_width;
                let heights = Buffer::new(gpu, "given heights", points(width, count))?;
                let buffers = ReplaceBuffers { given: &heights, heights: buffers.fine };
                steps.push(given.pass.step(gpu, width, count, buffers)?);
                given_heights = Some(GivenLattice { level: level + 1, heights });
            }
            origins.push(starts);
        }
        let job = Job::new(gpu, self.label, steps)?;
        Ok(LevelJob {
            config: config.clone(),
            coarser,
            widths,
            base,
            origins,
            features,
            given: given_heights,
            job,
        })
    }
}

/// The part of a coarser lattice from which a region follows. Its width is the same for all regions of equal width.
pub(crate) fn lattice_region(config: &TerrainConfig, region: Region, coarser: u32) -> Region {
    let level = (config.levels() - coarser) as usize;
    let first = region.levels(config)[level].map(|span| span.first);
    Region { first, width: level_widths(config, region.width, region.coarser)[level], coarser }
}

/// Width of a region in points at each level, starting with the base lattice. These widths suffice for regions at any position
/// relative to the coarse lattices.
fn level_widths(config: &TerrainConfig, width: u32, coarser: u32) -> Vec<u32> {
    let halo = match (config.border, config.interpolation) {
        (Border::Seamless, HeightInterpolation::Linear) => 3,
        (Border::Seamless, HeightInterpolation::Smooth) => 8,
        _ => 1,
    };
    let mut widths = vec![width];
    for _ in coarser..config.levels() {
        widths.push((widths[widths.len() - 1] - 1) / 2 + halo);
    }
    widths.reverse();
    widths
}

/// Width in points of the rim around a window. Features in the rim also influence the window. A grid of a feature index already
/// includes one point of this rim.
fn rim(config: &TerrainConfig) -> u32 {
    match config.interpolation {
        HeightInterpolation::Linear => 1,
        HeightInterpolation::Smooth => SMOOTH_RIM,
    }
}

fn points(width: u32, count: u32) -> usize {
    count as usize * (width as usize).pow(2)
}

/// Buffers for the generation of a batch of windows.
#[derive(Debug, Clone, Copy)]
pub struct HeightBuffers<'a> {
    /// Written: the heights, one window after the other. The buffer must hold [`Windows::points`] heights or more.
    pub output: &'a Buffer<i32>,
    /// Scratch memory that was made for the same configuration and windows.
    pub scratch: &'a HeightScratch,
}

/// The lattice of given heights, and the pass that replaces generated ones.
#[derive(Debug, Clone, Copy)]
pub struct GivenHeights<'a> {
    /// The pass.
    pub pass: &'a ReplacePass,
    /// Number of levels by which the lattice is coarser than the terrain.
    pub coarser: u32,
}

/// Scratch memory for the levels between the base lattice and the output. Its size is about a third of the output's size, and a
/// quarter more for smooth interpolation. Jobs with the same configuration, count and apron may share one `HeightScratch`.
#[derive(Debug, Clone)]
pub struct HeightScratch {
    // Levels alternate between the two buffers. The last level reads the first buffer; the level before it reads the second.
    buffers: [Buffer<i32>; 2],
    // Centers of the cells from which a level is made.
    centers: Buffer<i32>,
}

/// Number of points in each buffer of a [`HeightScratch`].
#[derive(Debug, Clone, Copy, PartialEq)]
struct ScratchPoints {
    levels: [usize; 2],
    centers: usize,
}

impl HeightScratch {
    /// Allocates scratch memory for the generation of `windows`.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, config: &TerrainConfig, windows: Windows) -> Result<Self, GpuError> {
        Self::for_regions(gpu, config, windows.regions(config))
    }

    /// Allocates scratch memory for the generation of `regions`. Noise needs none.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn for_regions(gpu: &Gpu, config: &TerrainConfig, regions: Regions) -> Result<Self, GpuError> {
        let widths = match config.generator {
            HeightGenerator::DiamondSquare => level_widths(config, regions.width, regions.coarser),
            _ => vec![regions.width],
        };
        let ScratchPoints { levels: [first, second], centers } = Self::points(config, &widths, regions.count);
        let buffer =
            |points| Buffer::new(gpu, "terrain scratch", points).map_err(|error| error.with_remedy(REMEDY));
        Ok(Self { buffers: [buffer(first)?, buffer(second)?], centers: buffer(centers)? })
    }

    /// Number of points in the largest level that each buffer stores. The largest level is not always the finest: with small
    /// patches, coarse levels can be wider. The base lattice and the output have their own buffers.
    fn points(config: &TerrainConfig, widths: &[u32], count: u32) -> ScratchPoints {
        let mut levels = [0; 2];
        for (left, width) in widths[1..].iter().rev().skip(1).enumerate() {
            levels[left % 2] = levels[left % 2].max(points(*width, count));
        }
        let coarse = &widths[..widths.len() - 1];
        let centers = match config.interpolation {
            HeightInterpolation::Linear => 0,
            HeightInterpolation::Smooth => {
                coarse.iter().map(|width| points(centers(*width), count)).max().unwrap_or(0)
            }
        };
        ScratchPoints { levels, centers }
    }

    fn check(&self, config: &TerrainConfig, widths: &[u32], count: u32) -> Result<(), InputError> {
        let needed = Self::points(config, widths, count);
        let all = self.buffers.iter().zip(needed.levels).chain([(&self.centers, needed.centers)]);
        all.into_iter().try_for_each(|(buffer, needed)| buffer.check_holds("scratch", needed))
    }
}

/// A prepared generation of a batch of regions by levels of subdivision.
#[derive(Debug, Clone)]
pub(crate) struct LevelJob {
    config: TerrainConfig,
    coarser: u32,
    widths: Vec<u32>,
    base: Buffer<i32>,
    /// First point of each window, for every level but the base lattice, in units of the level's spacing.
    origins: Vec<Buffer<[i32; 2]>>,
    features: FeatureIndex,
    given: Option<GivenLattice>,
    job: Job,
}

/// The given heights of one lattice.
#[derive(Debug, Clone)]
struct GivenLattice {
    /// Index of the lattice; 0 is the base lattice.
    level: usize,
    heights: Buffer<i32>,
}

impl LevelJob {
    /// Stages the given heights of a region of the batch, in the order of [`lattice_region`].
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn stage_given(&self, to: &mut impl Upload, number: usize, heights: &[i32]) -> Result<(), GpuError> {
        let Some(given) = &self.given else { return Ok(()) };
        to.elements(&given.heights, number * points(self.widths[given.level], 1), heights)
    }

    /// Writes the base lattices, the origins and the features of regions. `worlds` are the worlds of their features.
    ///
    /// # Errors
    /// [`GpuError::Limit`] for more features than the capacity.
    pub fn write(
        &self,
        to: &mut impl Upload,
        regions: &[Region],
        worlds: &[[i32; 2]],
        features: &Features,
    ) -> Result<(), Error> {
        let mut base = Vec::new();
        for (region, world) in regions.iter().zip(worlds) {
            let levels = region.levels(&self.config);
            let widened = |Span { first, .. }| Span { first, last: first + i64::from(self.widths[0]) - 1 };
            base.extend(match self.config.border {
                Border::Seamless => base_lattice(&self.config, features, levels[0].map(widened)),
                Border::Wrap | Border::Blend(_) => corners(&self.config, features, *world),
            });
        }
        to.elements(&self.base, 0, &base)?;
        let origins = self.origins_of(regions);
        for (buffer, origins) in self.origins.iter().zip(&origins) {
            to.elements(buffer, 0, origins)?;
        }
        self.features.write(to, regions.len() as u32, |level, window| {
            self.features_of(features, level, origins[level][window as usize], worlds[window as usize])
        })?;
        Ok(())
    }

    /// First point of each region, for every level but the base lattice.
    fn origins_of(&self, regions: &[Region]) -> Vec<Vec<[i32; 2]>> {
        let mut origins = vec![Vec::with_capacity(regions.len()); self.origins.len()];
        for region in regions {
            for (origins, spans) in origins.iter_mut().zip(&region.levels(&self.config)[1..]) {
                origins.push(spans.map(|span| span.first as i32));
            }
        }
        origins
    }

    /// The features that a level of a region needs, from the region's first point of the level.
    fn features_of(
        &self,
        features: &Features,
        level: usize,
        origin: [i32; 2],
        world: [i32; 2],
    ) -> Vec<(u32, u32, i32)> {
        let finer = self.origins.len() - 1 - level + self.coarser as usize;
        let spacing = self.config.sample_spacing() << finer;
        let first = origin.map(|first| i64::from(first) * spacing);
        let origin = if self.config.border == Border::Seamless { first } else { [0, 0] };
        let lattice = Lattice { origin, width: self.widths[level + 1], spacing };
        features.on_lattice(world, lattice.grown(rim(&self.config)), true)
    }

    /// Number of features that regions need room for.
    pub fn feature_count(&self, regions: &[Region], features: &Features) -> usize {
        let levels = self.origins_of(regions).into_iter().enumerate();
        let all = levels.flat_map(|(level, origins)| origins.into_iter().map(move |origin| (level, origin)));
        all.map(|(level, origin)| self.features_of(features, level, origin, [0, 0]).len()).sum()
    }

    /// Records the generation of all regions of the batch.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::window::Window;

    /// Each scratch buffer is exactly as large as the largest level that it ever holds.
    #[test]
    fn scratch_holds_what_dispatches_leave() {
        let scratch = |config: TerrainConfig, apron: u32| {
            let widths = level_widths(&config, config.patch_size + 2 * apron, 0);
            HeightScratch::points(&config, &widths, 3)
        };
        let linear = |size| TerrainConfig::new(size, 1.0, "").expect("valid");
        let of = |levels, centers| ScratchPoints { levels, centers };
        // The levels below the output are 131, 68, 36, 20, … points wide, from fine to coarse.
        assert_eq!(scratch(linear(257), 0), of([3 * 131 * 131, 3 * 68 * 68], 0));
        assert_eq!(scratch(linear(3), 0), of([0, 0], 0), "one level");
        assert_eq!(scratch(linear(5), 0), of([3 * 5 * 5, 0], 0), "two");
        // For 3 samples with smooth interpolation, the levels below the output are 9, 12, 13, 14, 14, … points wide.
        let smooth =
            TerrainConfig { interpolation: HeightInterpolation::Smooth, coarse_levels: 8, ..linear(3) };
        assert_eq!(scratch(smooth, 0), of([3 * 14 * 14; 2], 3 * 11 * 11));
    }

    /// The computed level widths are enough for every window, whatever its position relative to the coarse lattices.
    #[test]
    fn level_widths_cover_every_alignment() {
        for (size, coarse_levels, apron) in [(3, 0, 0), (5, 3, 1), (33, 2, 7), (257, 8, 0), (17, 1, 40)] {
            let config = TerrainConfig { coarse_levels, ..TerrainConfig::new(size, 1.0, "").expect("valid") };
            let widths = level_widths(&config, config.patch_size + 2 * apron, 0);
            for patch in -300..300 {
                let levels = Window { patch: [patch, 1 - patch], apron }.levels(&config);
                for (spans, width) in levels.iter().zip(&widths) {
                    let fits = |span: &Span| span.width() <= *width as usize;
                    assert!(spans.iter().all(fits), "size {size} patch {patch}: {spans:?} exceeds {width}");
                }
            }
        }
    }
}
