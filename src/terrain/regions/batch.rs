//! Batches with any number of windows, split into parts that each fit a storage binding.

use super::{HeightBuffers, HeightScratch, RegionJob, RegionPass};
use crate::gpu::Gpu;
use crate::terrain::config::TerrainConfig;
use crate::terrain::features::Features;
use crate::terrain::fields::Fields;
use crate::terrain::window::{Window, Windows};
use crate::{Error, InputError};

/// A batch of any number of windows to generate. Each part of the batch fits a storage binding of 128 MiB. All parts are recorded
/// together.
#[derive(Debug, Clone)]
pub struct HeightBatch {
    jobs: Vec<RegionJob>,
    fields: Vec<Fields>,
}

impl HeightBatch {
    /// Allocates all buffers for `windows`. Each part of the batch can hold `feature_capacity` injected points.
    ///
    /// # Errors
    /// [`InputError`] as [`RegionPass::prepare`]; [`crate::gpu::GpuError`].
    pub fn new(
        gpu: &Gpu,
        pass: &RegionPass,
        config: &TerrainConfig,
        windows: Windows,
        feature_capacity: usize,
    ) -> Result<Self, Error> {
        let Windows { count, apron } = windows;
        config.validate()?;
        Window { patch: [0, 0], apron }.validate(config)?;
        let largest = Fields::most(gpu, config.patch_size + 2 * apron) as u32;
        let parts = count.div_ceil(largest).max(1);
        let scratch = HeightScratch::new(gpu, config, Windows { count: count.div_ceil(parts), apron })?;
        let (mut jobs, mut fields) = (Vec::new(), Vec::new());
        for part in 0..parts {
            let size = count * (part + 1) / parts - count * part / parts;
            let output = Fields::new(gpu, "terrain heights", config.patch_size + 2 * apron, size)?;
            let buffers = HeightBuffers { output: &output.heights, scratch: &scratch };
            let windows = Windows { count: size, apron };
            jobs.push(pass.prepare(gpu, config, windows, feature_capacity, buffers)?);
            fields.push(output);
        }
        Ok(Self { jobs, fields })
    }

    /// Sets the patches and features for the next recordings. Patches fill the parts of the batch in order.
    ///
    /// # Errors
    /// The errors of [`RegionJob::set`].
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

    /// Records the generation of all windows in all parts.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.jobs.iter().for_each(|job| job.record(encoder));
    }

    /// The generated heights, one entry per part of the batch.
    pub fn fields(&self) -> &[Fields] {
        &self.fields
    }
}
