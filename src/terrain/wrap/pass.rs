//! The GPU pass of `kernels/terrain/wrap.wgsl`, one level per dispatch, for a batch of patches.

use crate::Error;
use crate::InputError;
use crate::gpu::bindings::terrain::wrap as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Tuning, Uniform};
use crate::shared::terrain::wrap::WrapLevel;
use crate::terrain::blocks::{Blocks, Order};
use crate::terrain::config::{Border, Config, Offset, PATCH_EDGE};
use crate::terrain::features::{FeatureIndex, Features};
use crate::terrain::fixed::FeatureMode;
use crate::terrain::window::Lattice;
use crate::terrain::window::Window;

/// Rows of coarse points of a block on software adapters. Four blocks make the 129 rows of a patch of 257².
const ROWS_SOFTWARE: u32 = 33;

/// The order of blocks that suits a device.
fn order_of(tuning: Tuning) -> Order {
    let order = Order::of(tuning);
    if order.downwards { Order { rows: ROWS_SOFTWARE, ..order } } else { order }
}

/// What generation writes.
#[derive(Debug, Clone, Copy)]
pub struct WrapBuffers<'a> {
    /// The result: patchSize² heights per patch, in 1/65536 units, patch by patch.
    pub output: &'a Buffer<i32>,
    /// Room for [`WrapJob::scratch_points`] heights of other levels.
    pub scratch: &'a Buffer<i32>,
}

/// Diamond-square heights of patches that are generated alone. A pass is compiled for one distribution and one
/// mode of injection.
#[derive(Debug, Clone)]
pub struct WrapPass {
    first: Kernel,
    next: Kernel,
    order: Order,
    with_features: bool,
}

impl WrapPass {
    /// Compiles the pipelines. `features` is the mode of injection; `None` means that there are no features.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<Self, GpuError> {
        Self::with_order(gpu, offset, features, order_of(gpu.tuning()))
    }

    /// As [`WrapPass::new`], with blocks in the given order.
    pub fn with_order(
        gpu: &Gpu,
        offset: Offset,
        features: Option<FeatureMode>,
        order: Order,
    ) -> Result<Self, GpuError> {
        let kernel = |first: bool| {
            let constants = bindings::Constants {
                first,
                downwards: order.downwards,
                distribution: offset.code(),
                features: features.map_or(0, FeatureMode::code),
            };
            bindings::kernel(gpu, &constants)
        };
        Ok(Self { first: kernel(true)?, next: kernel(false)?, order, with_features: features.is_some() })
    }

    /// Prepares the generation of `count` patches. `feature_capacity` is the largest number of injected points.
    ///
    /// # Errors
    /// [`InputError`] for a `seamless` configuration or one out of bounds, or buffers that are too short;
    /// [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        config: &Config,
        count: u32,
        feature_capacity: usize,
        buffers: WrapBuffers<'_>,
    ) -> Result<WrapJob, Error> {
        let WrapBuffers { output, scratch } = buffers;
        config.validate()?;
        if config.border == Border::Seamless {
            let bound = "must be \"wrap\" or {\"blend\": samples} for patches by themselves";
            return Err(InputError::new("border", "\"seamless\"", bound).into());
        }
        output.check_holds("output", count as usize * (config.patch_size as usize).pow(2))?;
        scratch.check_holds("scratch", WrapJob::scratch_points(config, count))?;
        let levels = config.levels() as usize;
        let widths: Vec<u32> = (0..=levels).map(|level| (1 << level) + 1).collect();
        let capacity = if self.with_features { feature_capacity.max(1) } else { 0 };
        let features = FeatureIndex::new(gpu, &widths, count, capacity)?;
        let origins = Buffer::new(gpu, "patch origins", count as usize)?;
        let mut steps = Vec::new();
        for level in 0..levels {
            let (fine, coarse) =
                if (levels - level) % 2 == 1 { (output, scratch) } else { (scratch, output) };
            let kernel = if level == 0 { &self.first } else { &self.next };
            let blocks = Blocks::of_squares(widths[level], 4, self.order.rows, count);
            let params = WrapLevel {
                blocks,
                corners: config.fixed_corners().into(),
                fine_features: features.grid(level + 1),
                base_features: features.grid(0),
                key: config.key().into(),
                fine_width: widths[level + 1],
                coarse_width: widths[level],
                fine_spacing: (PATCH_EDGE >> (level + 1)) as u32,
                range: config.level_range(level as u32),
                fine_points: widths[level + 1].pow(2),
                coarse_points: widths[level].pow(2),
            };
            let uniform = Uniform::new(gpu, "terrain level", &params)?;
            let group = bindings::Group {
                level: &uniform,
                origins: origins.slice(),
                coarse: coarse.slice(),
                fine: fine.slice(),
            };
            let injected =
                bindings::Group1 { feature_words: features.words(), feature_heights: features.heights() };
            let groups = vec![group.bind(gpu, kernel)?, injected.bind(gpu, kernel)?];
            let workgroups = blocks.workgroups(gpu, kernel);
            steps.push(Step { kernel: kernel.clone(), groups, workgroups });
        }
        let job = Job::new(gpu, "terrain/wrap", steps)?;
        Ok(WrapJob { config: config.clone(), count, widths, origins, features, job })
    }
}

/// The prepared generation of a batch of patches: set the patches, then record as often as wanted.
#[derive(Debug, Clone)]
pub struct WrapJob {
    config: Config,
    count: u32,
    widths: Vec<u32>,
    origins: Buffer<[i32; 2]>,
    features: FeatureIndex,
    job: Job,
}

impl WrapJob {
    /// The number of heights that the scratch must hold: about a quarter of the output.
    pub fn scratch_points(config: &Config, count: u32) -> usize {
        let width = (config.patch_size as usize - 1) / 2 + 1;
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
        for &patch in patches {
            Window { patch, apron: 0 }.validate(&self.config)?;
        }
        let origins: Vec<_> =
            patches.iter().map(|patch| patch.map(|index| (i64::from(index) * PATCH_EDGE) as i32)).collect();
        self.origins.write(gpu, &origins)?;
        self.features.write(gpu, patches.len() as u32, |level, window| {
            let spacing = PATCH_EDGE >> level;
            let lattice = Lattice { origin: [0, 0], width: self.widths[level], spacing };
            let world = Features::world_of(&self.config, patches[window as usize]);
            features.on_lattice(world, lattice.grown(1), level > 0)
        })?;
        Ok(())
    }

    /// Records the generation of all patches.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }
}
