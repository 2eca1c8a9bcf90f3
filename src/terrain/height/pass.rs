//! The GPU pass of `kernels/terrain/height.wgsl`: one or two levels per dispatch, for a batch of windows.

use super::job::{HeightJob, HeightScratch, LevelInputs};
use crate::gpu::bindings::terrain::height as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Tuning, Uniform};
use crate::shared::terrain::level::Level;
use crate::terrain::blocks::Blocks as TerrainBlocks;
use crate::terrain::config::{Border, Config, Interpolation, Offset};
use crate::terrain::features::FeatureIndex;
use crate::terrain::fixed::FeatureMode;
use crate::{Error, InputError};

/// Rows of coarse cells per thread. Software adapters run few long threads best, hardware many short ones.
const CELL_ROWS_SOFTWARE: u32 = 43;
const CELL_ROWS_HARDWARE: u32 = 2;

/// Rows of coarse cells per thread where a dispatch makes two levels: the 65 rows of a patch of 257² then take
/// two threads, the 33 rows of a patch of 129² one.
const CELL_ROWS_TWO_LEVELS: u32 = 33;

/// How a dispatch is cut into threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Blocks {
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
    pub fn with_blocks(
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
        if config.interpolation != Interpolation::Linear {
            let bound = "must be \"linear\" in this pass: SmoothPass makes the others";
            return Err(InputError::new("interpolation", "smooth", bound).into());
        }
        let plan = self.plan(config.levels());
        let capacity = if self.with_features { feature_capacity.max(1) } else { 0 };
        let inputs = LevelInputs::new(gpu, config, [count, apron], capacity)?;
        let LevelInputs { widths, origins, features } = &inputs;
        output.check_holds("output", HeightJob::output_points(config, count, apron))?;
        scratch.check(&plan, widths, count)?;
        let mut steps = Vec::new();
        for (index, &[level, levels]) in plan.iter().enumerate() {
            let [coarse, fine] = scratch.of_dispatch(plan.len() - 1 - index, output);
            let stage = &self.stages[levels - 1];
            let kernel = if level == 0 { &stage.first } else { &stage.next };
            let params = self.level(config, widths, [level, levels], features, count);
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
            let workgroups = params.blocks.workgroups(gpu, kernel);
            steps.push(Step { kernel: kernel.clone(), groups, workgroups });
        }
        let job = Job::new(gpu, "terrain/height", steps)?;
        Ok(HeightJob { config: config.clone(), count, apron, inputs, job })
    }

    /// The coarse level and the number of levels of every dispatch.
    pub(super) fn plan(&self, levels: u32) -> Vec<[usize; 2]> {
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
        Level {
            key: config.key().into(),
            fine_width,
            fine_points: fine_width * fine_width,
            coarse_width,
            coarse_points: coarse_width * coarse_width,
            fine_spacing: (config.sample_spacing() << (config.levels() as usize - fine)) as u32,
            fine_range: config.level_range(fine as u32 - 1),
            middle_range: config.level_range(level as u32),
            edge_range: 0,
            base_range: config.level_range(0),
            blocks: TerrainBlocks::of_squares(cells, 4, self.cell_rows, count),
            fine_features: features.grid(fine),
            base_features: features.grid(0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
