//! The GPU pass of `kernels/terrain/smooth.wgsl`: a level per dispatch, for a batch of windows.

use crate::gpu::bindings::terrain::smooth as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::terrain::level::Level;
use crate::terrain::blocks::{Blocks, Order};
use crate::terrain::config::{Config, Interpolation, Offset};
use crate::terrain::features::FeatureIndex;
use crate::terrain::fixed::FeatureMode;
use crate::terrain::height::{HeightJob, HeightScratch, LevelInputs, level_widths};
use crate::{Error, InputError};

/// Rows of coarse cells per thread, which computes six rows of centers more. Software adapters run few long threads best,
/// hardware many short ones.
const CELL_ROWS_SOFTWARE: u32 = 22;
const CELL_ROWS_HARDWARE: u32 = 8;

/// Heights of smooth `seamless` windows. A pass is compiled for one distribution and one mode of injection.
#[derive(Debug, Clone)]
pub struct SmoothPass {
    /// The kernel that starts from the base lattice, and the one for all later levels.
    first: Kernel,
    next: Kernel,
    order: Order,
    with_features: bool,
}

impl SmoothPass {
    /// Compiles the pipelines. `features` is the mode of injection; `None` means that there are no features.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<Self, Error> {
        let order = Order::of(gpu.tuning());
        let rows = if order.downwards { CELL_ROWS_SOFTWARE } else { CELL_ROWS_HARDWARE };
        Self::with_order(gpu, offset, features, Order { rows, ..order })
    }

    /// As [`SmoothPass::new`], with the given order of threads and rows of coarse cells.
    ///
    /// # Errors
    /// [`InputError`] for no rows; what the driver's compiler reports.
    pub fn with_order(
        gpu: &Gpu,
        offset: Offset,
        features: Option<FeatureMode>,
        order: Order,
    ) -> Result<Self, Error> {
        if order.rows == 0 {
            return Err(InputError::new("order.rows", 0, "must be at least 1").into());
        }
        let kernel = |first: bool| {
            let constants = bindings::Constants {
                downwards: order.downwards,
                cell_rows: order.rows,
                first,
                distribution: offset.code(),
                features: features.map_or(0, FeatureMode::code),
            };
            bindings::kernel(gpu, &constants)
        };
        Ok(Self { first: kernel(true)?, next: kernel(false)?, order, with_features: features.is_some() })
    }

    /// Allocates scratch for `count` windows with `apron`.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn scratch(
        &self,
        gpu: &Gpu,
        config: &Config,
        [count, apron]: [u32; 2],
    ) -> Result<HeightScratch, GpuError> {
        HeightScratch::of_plan(gpu, &plan(config), &level_widths(config, apron), count)
    }

    /// Prepares the generation of `count` windows with `apron` into `output`, which holds
    /// [`HeightJob::output_points`] heights. `feature_capacity` is the largest number of injected points, where
    /// a point counts once for every window that sees it.
    ///
    /// # Errors
    /// [`InputError`] for a configuration that is not smooth or out of bounds, an apron out of bounds, or
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
        if config.interpolation != Interpolation::Smooth {
            let bound = "must be \"smooth\" in this pass: HeightPass makes the others";
            return Err(InputError::new("interpolation", "linear", bound).into());
        }
        let plan = plan(config);
        let capacity = if self.with_features { feature_capacity.max(1) } else { 0 };
        let inputs = LevelInputs::new(gpu, config, [count, apron], capacity)?;
        let LevelInputs { widths, origins, features } = &inputs;
        output.check_holds("output", HeightJob::output_points(config, count, apron))?;
        scratch.check(&plan, widths, count)?;
        let mut steps = Vec::new();
        for level in 0..plan.len() {
            let [coarse, fine] = scratch.of_dispatch(plan.len() - 1 - level, output);
            let kernel = if level == 0 { &self.first } else { &self.next };
            let params = self.level(config, widths, level, features, count);
            let uniform = Uniform::new(gpu, "terrain level", &params)?;
            let group = bindings::Group {
                level: &uniform,
                origins: origins[level + 1].slice(),
                coarse: coarse.slice(),
                fine: fine.slice(),
            };
            let injected =
                bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
            let groups = vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?];
            let workgroups = params.blocks.workgroups(gpu, kernel);
            steps.push(Step { kernel: kernel.clone(), groups, workgroups });
        }
        let job = Job::new(gpu, "terrain/smooth", steps)?;
        Ok(HeightJob { config: config.clone(), count, apron, inputs, job })
    }

    fn level(
        &self,
        config: &Config,
        widths: &[u32],
        level: usize,
        features: &FeatureIndex,
        count: u32,
    ) -> Level {
        let (coarse_width, fine_width) = (widths[level], widths[level + 1]);
        // A window may start anywhere in its first cell.
        let cells = fine_width / 2 + 1;
        Level {
            key: config.key().into(),
            fine_width,
            fine_points: fine_width * fine_width,
            coarse_width,
            coarse_points: coarse_width * coarse_width,
            fine_spacing: (config.sample_spacing() << (config.levels() as usize - level - 1)) as u32,
            fine_range: config.level_range(level as u32),
            middle_range: 0,
            edge_range: config.edge_range(level as u32),
            base_range: config.level_range(0),
            blocks: Blocks::of_squares(cells, 4, self.order.rows, count),
            fine_features: features.grid(level + 1),
            base_features: features.grid(0),
        }
    }
}

/// The coarse level and the number of levels of every dispatch.
fn plan(config: &Config) -> Vec<[usize; 2]> {
    (0..config.levels() as usize).map(|level| [level, 1]).collect()
}
