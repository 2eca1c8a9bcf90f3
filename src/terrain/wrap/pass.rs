//! `kernels/terrain/wrap.wgsl` over the levels of a batch of patches.

use encase::ShaderType;
use glam::{IVec4, UVec2};

use crate::Error;
use crate::InputError;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::terrain::config::{Border, Config, Offset, PATCH_EDGE};
use crate::terrain::features::{FeatureGrid, FeatureIndex, FeatureMode, Features, Lattice};
use crate::terrain::height::Window;

/// `WrapLevel` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct WrapLevel {
    pub corners: IVec4,
    pub fine_features: FeatureGrid,
    pub base_features: FeatureGrid,
    pub key: UVec2,
    pub fine_width: u32,
    pub coarse_width: u32,
    pub fine_spacing: u32,
    pub range: u32,
    pub fine_points: u32,
    pub coarse_points: u32,
}

/// Diamond-square heights of patches by themselves. Compiled for one distribution and one way of injection.
#[derive(Debug, Clone)]
pub struct WrapPass {
    first: Kernel,
    next: Kernel,
    with_features: bool,
}

impl WrapPass {
    /// Compiles the pipelines. `features` is how features are injected; without it there are none.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, offset: Offset, features: Option<FeatureMode>) -> Result<Self, GpuError> {
        let kernel = |first: bool| {
            let constants = [
                ("FIRST", f64::from(u8::from(first))),
                ("DISTRIBUTION", f64::from(offset.code())),
                ("FEATURES", features.map_or(0.0, |mode| f64::from(mode.code()))),
            ];
            Kernel::new(gpu, &shaders::TERRAIN_WRAP, &constants)
        };
        Ok(Self { first: kernel(true)?, next: kernel(false)?, with_features: features.is_some() })
    }

    /// Prepares generation of `count` patches into `output`, which holds patchSize² heights a patch, with
    /// `scratch` of [`WrapJob::scratch_points`] and room for `feature_capacity` injected points.
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
        output: &Buffer<i32>,
        scratch: &Buffer<i32>,
    ) -> Result<WrapJob, Error> {
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
            let params = WrapLevel {
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
            let resources = [
                uniform.raw().as_entire_binding(),
                origins.raw().as_entire_binding(),
                coarse.raw().as_entire_binding(),
                fine.raw().as_entire_binding(),
            ];
            let groups = vec![kernel.bind(gpu, 0, &resources)?, kernel.bind(gpu, 1, &features.resources())?];
            let workgroups = [kernel.groups_for(widths[level]), widths[level], count];
            steps.push(Step { kernel: kernel.clone(), groups, workgroups });
        }
        let job = Job::new(gpu, "terrain/wrap", steps)?;
        Ok(WrapJob { config: config.clone(), count, widths, origins, features, job })
    }
}

/// Generation of a batch of patches, prepared: set the patches, then record as often as wanted.
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
    /// Heights that the scratch must hold: about a quarter of the output.
    pub fn scratch_points(config: &Config, count: u32) -> usize {
        let width = (config.patch_size as usize - 1) / 2 + 1;
        count as usize * width * width
    }

    /// Chooses the patches and features of the next recordings: at most `count` patches.
    ///
    /// # Errors
    /// [`InputError`] for patches out of bounds; [`GpuError::Limit`] for more features than there is room for.
    pub fn set(&self, gpu: &Gpu, patches: &[[i32; 2]], features: &Features) -> Result<(), Error> {
        if patches.len() > self.count as usize {
            let bound = format!("must be at most {}, the batch's count", self.count);
            return Err(InputError::new("patches", patches.len(), bound).into());
        }
        for &patch in patches {
            Window { patch, reach: 0 }.validate(&self.config)?;
        }
        let origins: Vec<_> =
            patches.iter().map(|patch| patch.map(|index| (i64::from(index) * PATCH_EDGE) as i32)).collect();
        self.origins.write(gpu, &origins)?;
        self.features.write(gpu, patches.len() as u32, |level, window| {
            let spacing = PATCH_EDGE >> level;
            let lattice = Lattice { origin: [0, 0], width: self.widths[level], spacing };
            let world = Features::world_of(&self.config, patches[window as usize]);
            features.on_lattice(world, lattice.grown(), level > 0)
        })?;
        Ok(())
    }

    /// Records the generation of all patches.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(wrap_level_layout: WrapLevel = TERRAIN_WRAP "WrapLevel");
}
