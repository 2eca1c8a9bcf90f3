//! The GPU pass of `kernels/terrain/height.wgsl`: one or two levels per dispatch, for a batch of windows.

use crate::Error;
use crate::InputError;
use crate::gpu::bindings::terrain::height as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Tuning, Uniform};
use crate::shared::terrain::height::Level;
use crate::terrain::config::{Border, Config, Offset};
use crate::terrain::features::{FeatureIndex, Features};
use crate::terrain::fields::{Fields, REMEDY};
use crate::terrain::fixed::FeatureMode;
use crate::terrain::window::Lattice;
use crate::terrain::window::Window;

/// Rows of coarse cells per thread. Software adapters run few long threads best, hardware many short ones.
const CELL_ROWS_SOFTWARE: u32 = 43;
const CELL_ROWS_HARDWARE: u32 = 2;

/// Rows of coarse cells per thread where a dispatch makes two levels: the 65 rows of a patch of 257² then take
/// two threads, the 33 rows of a patch of 129² one.
const CELL_ROWS_TWO_LEVELS: u32 = 33;

/// How a dispatch is cut into threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Blocks {
    /// Rows of coarse cells per thread, at least one.
    pub cell_rows: u32,
    /// Levels per dispatch: one, or two where no features are injected. If the number of levels is odd, the
    /// first dispatch makes one.
    pub levels: u32,
}

impl Blocks {
    // Two levels per dispatch need a long shader.
    fn of(tuning: Tuning, features: bool) -> Self {
        let cell_rows = if tuning.wants_long_threads() { CELL_ROWS_SOFTWARE } else { CELL_ROWS_HARDWARE };
        let two = tuning.wants_long_shaders() && !features;
        if two { Self { cell_rows: CELL_ROWS_TWO_LEVELS, levels: 2 } } else { Self { cell_rows, levels: 1 } }
    }
}

/// Diamond-square heights of `seamless` windows. A pass is compiled for one distribution and one mode of
/// injection.
#[derive(Debug, Clone)]
pub struct HeightPass {
    // The kernels for one level per dispatch and, where that is chosen, for two.
    stages: Vec<Stage>,
    cell_rows: u32,
    with_features: bool,
}

/// The kernel that starts from the base lattice, and the one for all later levels.
#[derive(Debug, Clone)]
struct Stage {
    first: Kernel,
    next: Kernel,
}

impl HeightPass {
    /// Compiles the pipelines. `features` is the mode of injection; `None` means that there are no features.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<Self, Error> {
        Self::with_blocks(gpu, offset, features, Blocks::of(gpu.tuning(), features.is_some()))
    }

    /// As [`HeightPass::new`], with the given blocks.
    ///
    /// # Errors
    /// [`InputError`] for blocks out of bounds; what the driver's compiler reports.
    pub(crate) fn with_blocks(
        gpu: &Gpu,
        offset: Offset,
        features: Option<FeatureMode>,
        blocks: Blocks,
    ) -> Result<Self, Error> {
        let most = if features.is_some() { 1 } else { 2 };
        if !(1..=most).contains(&blocks.levels) {
            let bound = format!("must be 1 to {most} a dispatch");
            return Err(InputError::new("blocks.levels", blocks.levels, bound).into());
        }
        if blocks.cell_rows == 0 {
            return Err(InputError::new("blocks.cell_rows", 0, "must be at least 1").into());
        }
        let kernel = |levels: u32, first: bool| {
            let constants = bindings::Constants {
                cell_rows: blocks.cell_rows,
                levels,
                first,
                distribution: offset.code(),
                features: features.map_or(0, FeatureMode::code),
            };
            bindings::kernel(gpu, &constants)
        };
        let stages = (1..=blocks.levels)
            .map(|levels| Ok(Stage { first: kernel(levels, true)?, next: kernel(levels, false)? }))
            .collect::<Result<_, GpuError>>()?;
        Ok(Self { stages, cell_rows: blocks.cell_rows, with_features: features.is_some() })
    }

    /// Prepares the generation of `count` windows with `apron` into `output`, which holds
    /// [`HeightJob::output_points`] heights. `feature_capacity` is the largest number of injected points, where
    /// a point counts once for every window that sees it.
    ///
    /// # Errors
    /// [`InputError`] for a configuration that is not `seamless` or out of bounds, an apron out of bounds, or
    /// buffers that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &Config,
        [count, apron]: [u32; 2],
        feature_capacity: usize,
        output: &Buffer<i32>,
        scratch: &HeightScratch,
    ) -> Result<HeightJob, Error> {
        config.validate()?;
        if config.border != Border::Seamless {
            let value = format!("{:?}", config.border).to_lowercase();
            return Err(
                InputError::new("border", value, "must be \"seamless\" for windows of the plane").into()
            );
        }
        Window { patch: [0, 0], apron }.validate(config)?;
        let widths = level_widths(config, apron);
        output.check_holds("output", HeightJob::output_points(config, count, apron))?;
        scratch.check(self, &widths, count)?;
        let capacity = if self.with_features { feature_capacity.max(1) } else { 0 };
        let features = FeatureIndex::new(gpu, &widths, count, capacity)?;
        let origins: Vec<_> = (0..widths.len())
            .map(|_| Buffer::new(gpu, "window origins", count as usize))
            .collect::<Result<_, _>>()?;
        let plan = self.plan(config.levels());
        let mut steps = Vec::new();
        for (index, &[level, levels]) in plan.iter().enumerate() {
            // The last dispatch writes to the output; those before it alternate between the scratch buffers.
            let left = plan.len() - 1 - index;
            let coarse = &scratch.buffers[left % 2];
            let fine = if left == 0 { output } else { &scratch.buffers[(left + 1) % 2] };
            let stage = &self.stages[levels - 1];
            let kernel = if level == 0 { &stage.first } else { &stage.next };
            let params = self.level(config, &widths, [level, levels], &features, count);
            let uniform = Uniform::new(gpu, "terrain level", &params)?;
            let group = bindings::Group {
                level: &uniform,
                origins: origins[level + levels].slice(),
                coarse: coarse.slice(),
                fine: fine.slice(),
            };
            let injected =
                bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
            let groups = vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?];
            let workgroups = kernel.spread(gpu, params.blocks * count);
            steps.push(Step { kernel: kernel.clone(), groups, workgroups });
        }
        let job = Job::new(gpu, "terrain/height", steps)?;
        Ok(HeightJob { config: config.clone(), count, apron, widths, origins, features, job })
    }

    /// The coarse level and the number of levels of every dispatch.
    fn plan(&self, levels: u32) -> Vec<[usize; 2]> {
        let (levels, most) = (levels as usize, self.stages.len());
        let alone = (levels % most != 0).then_some([0, levels % most]);
        alone.into_iter().chain((levels % most..levels).step_by(most).map(|level| [level, most])).collect()
    }

    fn level(
        &self,
        config: &Config,
        widths: &[u32],
        [level, levels]: [usize; 2],
        features: &FeatureIndex,
        count: u32,
    ) -> Level {
        let fine = level + levels;
        let (coarse_width, fine_width) = (widths[level], widths[fine]);
        // A window may start anywhere in its first cell.
        let cells = if levels == 1 { fine_width / 2 + 1 } else { (fine_width + 6) / 4 };
        let blocks_per_row = cells.div_ceil(4);
        Level {
            key: config.key().into(),
            fine_width,
            fine_points: fine_width * fine_width,
            coarse_width,
            coarse_points: coarse_width * coarse_width,
            fine_spacing: (config.sample_spacing() << (config.levels() as usize - fine)) as u32,
            fine_range: config.level_range(fine as u32 - 1),
            middle_range: config.level_range(level as u32),
            base_range: config.level_range(0),
            blocks_per_row,
            blocks: blocks_per_row * cells.div_ceil(self.cell_rows),
            windows: count,
            fine_features: features.grid(fine),
            base_features: features.grid(0),
        }
    }
}

/// Points along an edge at every level, the base lattice first: enough for windows of any alignment.
fn level_widths(config: &Config, apron: u32) -> Vec<u32> {
    let mut widths = vec![config.patch_size + 2 * apron];
    for _ in 0..config.levels() {
        widths.push((widths[widths.len() - 1] - 1) / 2 + 3);
    }
    widths.reverse();
    widths
}

/// A batch of any size. It is split where it exceeds a storage binding of 128 MiB, and recorded as one.
#[derive(Debug, Clone)]
pub struct HeightBatch {
    jobs: Vec<HeightJob>,
    fields: Vec<Fields>,
    scratch: HeightScratch,
}

impl HeightBatch {
    /// Allocates everything for `count` windows with `apron`, and for `feature_capacity` injected points in
    /// each part.
    ///
    /// # Errors
    /// [`InputError`] as [`HeightPass::prepare`]; [`GpuError`].
    pub fn new(
        gpu: &Gpu,
        pass: &HeightPass,
        config: &Config,
        [count, apron]: [u32; 2],
        feature_capacity: usize,
    ) -> Result<Self, Error> {
        config.validate()?;
        Window { patch: [0, 0], apron }.validate(config)?;
        let largest = Fields::most(gpu, config.patch_size + 2 * apron) as u32;
        let parts = count.div_ceil(largest).max(1);
        let scratch = HeightScratch::new(gpu, pass, config, count.div_ceil(parts), apron)?;
        let (mut jobs, mut fields) = (Vec::new(), Vec::new());
        for part in 0..parts {
            let size = count * (part + 1) / parts - count * part / parts;
            let output = Fields::new(gpu, "terrain heights", config.patch_size + 2 * apron, size)?;
            jobs.push(pass.prepare(
                gpu,
                config,
                [size, apron],
                feature_capacity,
                &output.heights,
                &scratch,
            )?);
            fields.push(output);
        }
        Ok(Self { jobs, fields, scratch })
    }

    /// Sets the patches, in order through the parts, and the features of the next recordings.
    ///
    /// # Errors
    /// As [`HeightJob::set`].
    pub fn set(&self, gpu: &Gpu, patches: &[[i32; 2]], features: &Features) -> Result<(), Error> {
        let mut rest = patches;
        for (job, fields) in self.jobs.iter().zip(&self.fields) {
            let (part, after) = rest.split_at(rest.len().min(fields.count as usize));
            job.set(gpu, part, features)?;
            rest = after;
        }
        if rest.is_empty() {
            return Ok(());
        }
        let bound = format!("must be at most {}, the batch's count", patches.len() - rest.len());
        Err(InputError::new("patches.len", patches.len(), bound).into())
    }

    /// Records the generation of all windows.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.jobs.iter().for_each(|job| job.record(encoder));
    }

    /// The heights, part by part.
    pub fn fields(&self) -> &[Fields] {
        &self.fields
    }

    /// Bytes of heights and scratch on the device, apart from features.
    pub fn bytes(&self) -> u64 {
        self.fields.iter().map(|fields| fields.heights.bytes()).sum::<u64>() + self.scratch.bytes()
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
        let [first, second] = Self::points(pass, &level_widths(config, apron), count);
        let buffer =
            |points| Buffer::new(gpu, "terrain scratch", points).map_err(|error| error.with_remedy(REMEDY));
        Ok(Self { buffers: [buffer(first)?, buffer(second)?] })
    }

    fn points(pass: &HeightPass, widths: &[u32], count: u32) -> [usize; 2] {
        let mut points = [0; 2];
        for (left, &[level, _]) in pass.plan(widths.len() as u32 - 1).iter().rev().enumerate() {
            // The base lattice is computed in the first dispatch and not loaded.
            if level > 0 {
                let needed = count as usize * (widths[level] as usize).pow(2);
                points[left % 2] = needed.max(points[left % 2]);
            }
        }
        points
    }

    /// Bytes that the scratch takes on the device.
    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(Buffer::bytes).sum()
    }

    fn check(&self, pass: &HeightPass, widths: &[u32], count: u32) -> Result<(), InputError> {
        let needed = Self::points(pass, widths, count);
        self.buffers.iter().zip(needed).try_for_each(|(buffer, needed)| buffer.check_holds("scratch", needed))
    }
}

/// The prepared generation of a batch of windows: set the patches, then record as often as wanted.
#[derive(Debug, Clone)]
pub struct HeightJob {
    config: Config,
    count: u32,
    apron: u32,
    widths: Vec<u32>,
    origins: Vec<Buffer<[i32; 2]>>,
    features: FeatureIndex,
    job: Job,
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
        let mut origins = vec![Vec::with_capacity(patches.len()); self.widths.len()];
        for &patch in patches {
            let window = Window { patch, apron: self.apron };
            window.validate(&self.config)?;
            for (level, spans) in window.levels(&self.config).into_iter().enumerate() {
                origins[level].push(spans.map(|span| span.first as i32));
            }
        }
        for (buffer, origins) in self.origins.iter().zip(&origins) {
            buffer.write(gpu, origins)?;
        }
        self.features.write(gpu, patches.len() as u32, |level, window| {
            let spacing = self.config.sample_spacing() << (self.config.levels() as usize - level);
            let origin = origins[level][window as usize].map(|first| i64::from(first) * spacing);
            let lattice = Lattice { origin, width: self.widths[level], spacing };
            features.on_lattice([0, 0], lattice.grown(), level > 0)
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

    use crate::terrain::window::Span;

    #[test]
    fn blocks_out_of_bounds_are_refused() {
        let gpu = Gpu::headless(&crate::gpu::Options::default()).expect("the suite needs an adapter");
        let refused = |features, cell_rows, levels| match HeightPass::with_blocks(
            &gpu,
            Offset::Signed,
            features,
            Blocks { cell_rows, levels },
        ) {
            Err(Error::Input(error)) => (error.path.to_string(), error.value.to_string()),
            other => panic!("{other:?}"),
        };
        let [levels, rows] = ["blocks.levels", "blocks.cell_rows"].map(str::to_owned);
        assert_eq!(refused(None, 4, 0), (levels.clone(), "0".to_owned()));
        assert_eq!(refused(None, 4, 3), (levels.clone(), "3".to_owned()));
        assert_eq!(
            refused(Some(FeatureMode::Keep), 4, 2),
            (levels, "2".to_owned()),
            "features need every level"
        );
        assert_eq!(refused(None, 0, 1), (rows, "0".to_owned()));
    }

    /// The scratch buffers are exactly as large as the largest level that they ever hold.
    #[test]
    fn scratch_holds_what_dispatches_leave() {
        let gpu = Gpu::headless(&crate::gpu::Options::default()).expect("the suite needs an adapter");
        let points = |size, coarse_levels, apron, levels| {
            let config = Config { coarse_levels, ..Config::new(size, 1.0, "").expect("valid") };
            let widths = level_widths(&config, apron);
            let blocks = Blocks { cell_rows: 1, levels };
            let pass = HeightPass::with_blocks(&gpu, Offset::Signed, None, blocks).expect("compiled");
            HeightScratch::points(&pass, &widths, 3)
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
