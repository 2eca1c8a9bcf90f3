//! Prepared generation of windows, and the scratch memory that its dispatches share.

use super::HeightPass;
use crate::gpu::{Buffer, Gpu, GpuError, Job};
use crate::terrain::config::{Config, Interpolation};
use crate::terrain::features::{FeatureIndex, Features};
use crate::terrain::fields::REMEDY;
use crate::terrain::window::{Lattice, SMOOTH_RIM, Window};
use crate::{Error, InputError};

/// Points along an edge at every level, the base lattice first: enough for windows of any alignment.
pub(in crate::terrain) fn level_widths(config: &Config, apron: u32) -> Vec<u32> {
    let halo = match config.interpolation {
        Interpolation::Linear => 3,
        Interpolation::Smooth => 8,
    };
    let mut widths = vec![config.patch_size + 2 * apron];
    for _ in 0..config.levels() {
        widths.push((widths[widths.len() - 1] - 1) / 2 + halo);
    }
    widths.reverse();
    widths
}

/// The points around a window whose features a level sees.
fn rim(config: &Config, level: usize) -> u32 {
    match config.interpolation {
        Interpolation::Smooth if level > 0 => SMOOTH_RIM,
        Interpolation::Linear | Interpolation::Smooth => 1,
    }
}

/// The widths of the grids of an index that lists the features of windows with [`rim`], which has room for one point around.
fn grid_widths(config: &Config, widths: &[u32]) -> Vec<u32> {
    widths.iter().enumerate().map(|(level, width)| width + 2 * (rim(config, level) - 1)).collect()
}

/// What the dispatches of a job read of its windows, level by level.
#[derive(Debug, Clone)]
pub(in crate::terrain) struct LevelInputs {
    /// Points along an edge.
    pub widths: Vec<u32>,
    /// The first sample of each window, in units of the level's spacing.
    pub origins: Vec<Buffer<[i32; 2]>>,
    /// Injected points.
    pub features: FeatureIndex,
}

impl LevelInputs {
    /// Allocates them for `count` windows with `apron`, and for so many features.
    ///
    /// # Errors
    /// [`InputError`] for an apron out of bounds; [`GpuError`].
    pub fn new(gpu: &Gpu, config: &Config, [count, apron]: [u32; 2], capacity: usize) -> Result<Self, Error> {
        Window { patch: [0, 0], apron }.validate(config)?;
        let widths = level_widths(config, apron);
        let origin = |_| Buffer::new(gpu, "window origins", count as usize);
        let origins = (0..widths.len()).map(origin).collect::<Result<_, _>>()?;
        let features = FeatureIndex::new(gpu, &grid_widths(config, &widths), count, capacity)?;
        Ok(Self { widths, origins, features })
    }
}

/// Scratch memory for the levels that one dispatch leaves to the next: about a third of the output with one
/// level per dispatch, a fifteenth with two. Jobs of one pass and shape may share it.
#[derive(Debug, Clone)]
pub struct HeightScratch {
    // The two buffers alternate: the last dispatch reads the first, the one before it the second, and so on.
    buffers: [Buffer<i32>; 2],
}

impl HeightScratch {
    /// Allocates scratch for `count` windows with `apron`.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn new(
        gpu: &Gpu,
        pass: &HeightPass,
        config: &Config,
        count: u32,
        apron: u32,
    ) -> Result<Self, GpuError> {
        Self::of_plan(gpu, &pass.plan(config.levels()), &level_widths(config, apron), count)
    }

    /// Allocates scratch for dispatches from these levels on over these many levels.
    pub(in crate::terrain) fn of_plan(
        gpu: &Gpu,
        plan: &[[usize; 2]],
        widths: &[u32],
        count: u32,
    ) -> Result<Self, GpuError> {
        let [first, second] = Self::points(plan, widths, count);
        let buffer =
            |points| Buffer::new(gpu, "terrain scratch", points).map_err(|error| error.with_remedy(REMEDY));
        Ok(Self { buffers: [buffer(first)?, buffer(second)?] })
    }

    fn points(plan: &[[usize; 2]], widths: &[u32], count: u32) -> [usize; 2] {
        let mut points = [0; 2];
        for (left, &[level, _]) in plan.iter().rev().enumerate() {
            // The base lattice is computed in the first dispatch and not loaded.
            if level > 0 {
                let needed = count as usize * (widths[level] as usize).pow(2);
                points[left % 2] = needed.max(points[left % 2]);
            }
        }
        points
    }

    /// What a dispatch reads and writes that is followed by `left` others: the last one writes to the output, those before
    /// it alternate between the buffers.
    pub(in crate::terrain) fn of_dispatch<'a>(
        &'a self,
        left: usize,
        output: &'a Buffer<i32>,
    ) -> [&'a Buffer<i32>; 2] {
        let fine = if left == 0 { output } else { &self.buffers[(left + 1) % 2] };
        [&self.buffers[left % 2], fine]
    }

    /// Bytes that the scratch takes on the device.
    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(Buffer::bytes).sum()
    }

    pub(in crate::terrain) fn check(
        &self,
        plan: &[[usize; 2]],
        widths: &[u32],
        count: u32,
    ) -> Result<(), InputError> {
        let needed = Self::points(plan, widths, count);
        self.buffers.iter().zip(needed).try_for_each(|(buffer, needed)| buffer.check_holds("scratch", needed))
    }
}

/// The prepared generation of a batch of windows: set the patches, then record as often as wanted.
#[derive(Debug, Clone)]
pub struct HeightJob {
    pub(in crate::terrain) config: Config,
    pub(in crate::terrain) count: u32,
    pub(in crate::terrain) apron: u32,
    pub(in crate::terrain) inputs: LevelInputs,
    pub(in crate::terrain) job: Job,
}

impl HeightJob {
    /// The number of heights that the output must hold.
    pub fn output_points(config: &Config, count: u32, apron: u32) -> usize {
        let width = (config.patch_size + 2 * apron) as usize;
        count as usize * width * width
    }

    /// Sets the patches and features of the next recordings: at most `count` patches.
    ///
    /// # Errors
    /// [`InputError`] for patches out of bounds; [`GpuError::Limit`] for more features than there is room for.
    pub fn set(&self, gpu: &Gpu, patches: &[[i32; 2]], features: &Features) -> Result<(), Error> {
        if patches.len() > self.count as usize {
            let bound = format!("must be at most {}, the batch's count", self.count);
            return Err(InputError::new("patches.len", patches.len(), bound).into());
        }
        let mut origins = vec![Vec::with_capacity(patches.len()); self.inputs.widths.len()];
        for &patch in patches {
            let window = Window { patch, apron: self.apron };
            window.validate(&self.config)?;
            for (level, spans) in window.levels(&self.config).into_iter().enumerate() {
                origins[level].push(spans.map(|span| span.first as i32));
            }
        }
        for (buffer, origins) in self.inputs.origins.iter().zip(&origins) {
            buffer.write(gpu, origins)?;
        }
        self.inputs.features.write(gpu, patches.len() as u32, |level, window| {
            let spacing = self.config.sample_spacing() << (self.config.levels() as usize - level);
            let origin = origins[level][window as usize].map(|first| i64::from(first) * spacing);
            let lattice = Lattice { origin, width: self.inputs.widths[level], spacing };
            features.on_lattice([0, 0], lattice.grown(rim(&self.config, level)), level > 0)
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
    use crate::terrain::config::Offset;
    use crate::terrain::height::Blocks;
    use crate::terrain::window::Span;

    /// The scratch buffers are exactly as large as the largest level that they ever hold.
    #[test]
    fn scratch_holds_what_dispatches_leave() {
        let gpu = Gpu::headless(&crate::gpu::Options::default()).expect("the suite needs an adapter");
        let points = |size, coarse_levels, apron, levels| {
            let config = Config { coarse_levels, ..Config::new(size, 1.0, "").expect("valid") };
            let widths = level_widths(&config, apron);
            let blocks = Blocks { cell_rows: 1, levels };
            let pass = HeightPass::with_blocks(&gpu, Offset::Signed, None, blocks).expect("compiled");
            HeightScratch::points(&pass.plan(widths.len() as u32 - 1), &widths, 3)
        };
        // The levels before the last are 131, 68, 36, 20, … points wide.
        assert_eq!(points(257, 0, 0, 1), [3 * 131 * 131, 3 * 68 * 68]);
        assert_eq!(points(3, 0, 0, 1), [0, 0], "one dispatch");
        assert_eq!(points(5, 0, 0, 1), [3 * 5 * 5, 0], "two");
        if gpu.tuning().compiles_long_shaders() {
            assert_eq!(points(257, 0, 0, 2), [3 * 68 * 68, 3 * 20 * 20]);
            assert_eq!(points(5, 0, 0, 2), [0, 0], "one dispatch");
            assert_eq!(points(9, 0, 0, 2), [3 * 6 * 6, 0], "one level, then two");
        }
    }

    /// The widths of levels, which are the same for all windows, cover every window, whatever its alignment.
    #[test]
    fn level_widths_cover_every_alignment() {
        for (size, coarse_levels, apron) in [(3, 0, 0), (5, 3, 1), (33, 2, 7), (257, 8, 0), (17, 1, 40)] {
            let config = Config { coarse_levels, ..Config::new(size, 1.0, "").expect("valid") };
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
