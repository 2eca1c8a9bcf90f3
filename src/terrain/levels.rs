//! Levels of subdivision on the device, one dispatch per level: the common part of the passes of `kernels/terrain/height.wgsl`,
//! `smooth.wgsl` and `wrap.wgsl`.

use crate::gpu::{Buffer, Gpu, GpuError, Group, Job, Kernel, Step, Uniform};
use crate::shared::terrain::level::Level;
use crate::terrain::config::{Border, HeightInterpolation, TerrainConfig};
use crate::terrain::features::{FeatureIndex, Features};
use crate::terrain::fields::REMEDY;
use crate::terrain::lattice::base_lattice;
use crate::terrain::window::{Lattice, SMOOTH_RIM, Span, Window, Windows};
use crate::{Error, InputError};

/// A kernel that computes a level from the next coarser one.
#[derive(Debug, Clone)]
pub(in crate::terrain) struct LevelPass {
    pub label: &'static str,
    pub kernel: Kernel,
    /// Creates the kernel's bind groups.
    pub bind: fn(&Gpu, &Kernel, LevelBuffers<'_>) -> Result<Vec<Group>, GpuError>,
    pub with_features: bool,
}

/// Buffers of one dispatch.
#[derive(Debug, Clone, Copy)]
pub(in crate::terrain) struct LevelBuffers<'a> {
    pub level: &'a Uniform<Level>,
    pub origins: &'a Buffer<[i32; 2]>,
    pub coarse: &'a Buffer<i32>,
    pub fine: &'a Buffer<i32>,
    pub features: &'a FeatureIndex,
}

impl LevelPass {
    /// Prepares the generation of `windows`. The configuration must be valid, with the borders that the kernel was compiled
    /// for.
    ///
    /// # Errors
    /// [`InputError`] for an apron out of bounds, and for buffers that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        windows: Windows,
        feature_capacity: usize,
        buffers: HeightBuffers<'_>,
    ) -> Result<HeightJob, Error> {
        let (Windows { count, apron }, HeightBuffers { output, scratch }) = (windows, buffers);
        Window { patch: [0, 0], apron }.validate(config)?;
        let widths = level_widths(config, apron);
        output.check_holds("output", HeightJob::output_points(config, windows))?;
        scratch.check(&widths, count)?;
        let grids: Vec<u32> = widths[1..].iter().map(|width| width + 2 * (rim(config) - 1)).collect();
        let capacity = if self.with_features { feature_capacity.max(1) } else { 0 };
        let features = FeatureIndex::new(gpu, &grids, count, capacity)?;
        let base = Buffer::new(gpu, "base lattice", points(widths[0], count))?;
        let (mut origins, mut steps) = (Vec::new(), Vec::new());
        for level in 0..grids.len() {
            let left = grids.len() - 1 - level;
            let params = Level {
                key: config.key().into(),
                fine_width: widths[level + 1],
                coarse_width: widths[level],
                spacing: (config.sample_spacing() << left) as u32,
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
                features: &features,
            };
            let groups = (self.bind)(gpu, &self.kernel, buffers)?;
            // One thread per coarse point: a window may start anywhere in its first cell.
            let edge = params.fine_width / 2 + 1;
            steps.push(Step::covering(&self.kernel, groups, [edge, edge, count]));
            origins.push(starts);
        }
        let job = Job::new(gpu, self.label, steps)?;
        Ok(HeightJob { config: config.clone(), count, apron, widths, base, origins, features, job })
    }
}

/// Points along an edge at every level, the base lattice first; enough for windows of any alignment.
fn level_widths(config: &TerrainConfig, apron: u32) -> Vec<u32> {
    let halo = match (config.border, config.interpolation) {
        (Border::Seamless, HeightInterpolation::Linear) => 3,
        (Border::Seamless, HeightInterpolation::Smooth) => 8,
        _ => 1,
    };
    let mut widths = vec![config.patch_size + 2 * apron];
    for _ in 0..config.levels() {
        widths.push((widths[widths.len() - 1] - 1) / 2 + halo);
    }
    widths.reverse();
    widths
}

/// Number of points around a window whose features a level sees. The grids of an index already have room for one.
fn rim(config: &TerrainConfig) -> u32 {
    match config.interpolation {
        HeightInterpolation::Linear => 1,
        HeightInterpolation::Smooth => SMOOTH_RIM,
    }
}

fn points(width: u32, count: u32) -> usize {
    count as usize * (width as usize).pow(2)
}

/// Buffers of a generation of windows.
#[derive(Debug, Clone, Copy)]
pub struct HeightBuffers<'a> {
    /// Written: the heights, window by window; at least [`HeightJob::output_points`].
    pub output: &'a Buffer<i32>,
    /// Scratch of the same configuration and windows.
    pub scratch: &'a HeightScratch,
}

/// Scratch memory for the levels between the base lattice and the output: about a third of the output's size. Jobs with the
/// same configuration, count and apron may share it.
#[derive(Debug, Clone)]
pub struct HeightScratch {
    // The two buffers alternate: the last dispatch reads the first, the dispatch before it the second, and so on.
    buffers: [Buffer<i32>; 2],
}

impl HeightScratch {
    /// Allocates scratch for `windows`.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, config: &TerrainConfig, windows: Windows) -> Result<Self, GpuError> {
        let [first, second] = Self::points(&level_widths(config, windows.apron), windows.count);
        let buffer =
            |points| Buffer::new(gpu, "terrain scratch", points).map_err(|error| error.with_remedy(REMEDY));
        Ok(Self { buffers: [buffer(first)?, buffer(second)?] })
    }

    /// Size of the largest level that each buffer ever holds; coarse levels of small patches are wider than fine ones. The base
    /// lattice and the output are elsewhere.
    fn points(widths: &[u32], count: u32) -> [usize; 2] {
        let mut most = [0; 2];
        for (left, width) in widths[1..].iter().rev().skip(1).enumerate() {
            most[left % 2] = most[left % 2].max(points(*width, count));
        }
        most
    }

    fn check(&self, widths: &[u32], count: u32) -> Result<(), InputError> {
        let needed = Self::points(widths, count);
        self.buffers.iter().zip(needed).try_for_each(|(buffer, needed)| buffer.check_holds("scratch", needed))
    }

    /// Size of the scratch on the device, in bytes.
    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(Buffer::bytes).sum()
    }
}

/// A prepared generation of a batch of windows: set the patches, then record any number of times.
#[derive(Debug, Clone)]
pub struct HeightJob {
    config: TerrainConfig,
    count: u32,
    apron: u32,
    widths: Vec<u32>,
    base: Buffer<i32>,
    /// First point of each window at every level after the base lattice, in units of the level's spacing.
    origins: Vec<Buffer<[i32; 2]>>,
    features: FeatureIndex,
    job: Job,
}

impl HeightJob {
    /// Number of heights of `windows`, which the output must hold.
    pub fn output_points(config: &TerrainConfig, windows: Windows) -> usize {
        points(config.patch_size + 2 * windows.apron, windows.count)
    }

    /// Sets the patches, at most `count`, and the features of the next recordings.
    ///
    /// # Errors
    /// [`InputError`] for patches out of bounds; [`GpuError::Limit`] for more features than there is room for.
    pub fn set(&self, gpu: &Gpu, patches: &[[i32; 2]], features: &Features) -> Result<(), Error> {
        if patches.len() > self.count as usize {
            let bound = format!("must be at most {}, the batch's count", self.count);
            return Err(InputError::new("patches.len", patches.len(), bound).into());
        }
        let mut base = Vec::new();
        let mut origins = vec![Vec::with_capacity(patches.len()); self.origins.len()];
        for &patch in patches {
            let window = Window { patch, apron: self.apron };
            window.validate(&self.config)?;
            let levels = window.levels(&self.config);
            let widened = |Span { first, .. }| Span { first, last: first + i64::from(self.widths[0]) - 1 };
            base.extend(base_lattice(&self.config, features, patch, levels[0].map(widened)));
            for (origins, spans) in origins.iter_mut().zip(&levels[1..]) {
                origins.push(spans.map(|span| span.first as i32));
            }
        }
        self.base.write(gpu, &base)?;
        for (buffer, origins) in self.origins.iter().zip(&origins) {
            buffer.write(gpu, origins)?;
        }
        self.features.write(gpu, patches.len() as u32, |level, window| {
            let spacing = self.config.sample_spacing() << (origins.len() - 1 - level);
            let first = origins[level][window as usize].map(|first| i64::from(first) * spacing);
            let origin = if self.config.border == Border::Seamless { first } else { [0, 0] };
            let lattice = Lattice { origin, width: self.widths[level + 1], spacing };
            let world = Features::world_of(&self.config, patches[window as usize]);
            features.on_lattice(world, lattice.grown(rim(&self.config)), true)
        })?;
        Ok(())
    }

    /// Records the generation of all windows.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The scratch buffers are exactly as large as the largest level that they ever hold.
    #[test]
    fn scratch_holds_what_dispatches_leave() {
        let points = |size, coarse_levels, apron| {
            let config = TerrainConfig { coarse_levels, ..TerrainConfig::new(size, 1.0, "").expect("valid") };
            HeightScratch::points(&level_widths(&config, apron), 3)
        };
        // The levels before the last are 131, 68, 36, 20, … points wide.
        assert_eq!(points(257, 0, 0), [3 * 131 * 131, 3 * 68 * 68]);
        assert_eq!(points(3, 0, 0), [0, 0], "one dispatch");
        assert_eq!(points(5, 0, 0), [3 * 5 * 5, 0], "two");
        // With smooth interpolation, the levels before the last of 3 points are 9, 12, 13, 14, 14, … points wide.
        let smooth = TerrainConfig {
            interpolation: HeightInterpolation::Smooth,
            coarse_levels: 8,
            ..TerrainConfig::new(3, 1.0, "").expect("valid")
        };
        assert_eq!(HeightScratch::points(&level_widths(&smooth, 0), 3), [3 * 14 * 14; 2]);
    }

    /// The widths of levels are the same for all windows and cover every window, whatever its alignment.
    #[test]
    fn level_widths_cover_every_alignment() {
        for (size, coarse_levels, apron) in [(3, 0, 0), (5, 3, 1), (33, 2, 7), (257, 8, 0), (17, 1, 40)] {
            let config = TerrainConfig { coarse_levels, ..TerrainConfig::new(size, 1.0, "").expect("valid") };
            let widths = level_widths(&config, apron);
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
