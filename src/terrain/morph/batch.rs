//! Blends over time between two batches of fields that are split into parts.

use super::{HeightMorphPass, Morph, MorphBuffers, MorphJob};
use crate::gpu::{Gpu, Upload};
use crate::terrain::fields::Fields;
use crate::{Error, InputError};

/// Fields that blend over time between two batches of fields. Set the time, then record. This value keeps both batches alive.
#[derive(Debug, Clone)]
pub struct MorphedFields {
    fields: Vec<Fields>,
    jobs: Vec<MorphJob>,
}

impl MorphedFields {
    /// Allocates fields for the blend from `from` (time 0) to `to` (time 1). Both must have parts of the same widths and counts.
    /// A [`Generator`](crate::terrain::generator::Generator) produces such parts for the same patches. The fields are zero until
    /// the blend has been recorded.
    ///
    /// # Errors
    /// [`InputError`] for different numbers of parts, widths or counts, and for buffers that are too short;
    /// [`crate::gpu::GpuError`].
    pub fn new(gpu: &Gpu, from: &[Fields], to: &[Fields]) -> Result<Self, Error> {
        InputError::check_same("to.len", to.len(), from.len(), "as from.len")?;
        let pass = HeightMorphPass::new(gpu)?;
        let (mut fields, mut jobs) = (Vec::new(), Vec::new());
        for (part, (from, to)) in from.iter().zip(to).enumerate() {
            let sizes = [("width", from.width, to.width), ("count", from.count, to.count)];
            for (field, from, to) in sizes {
                let (path, reason) = (format!("to[{part}].{field}"), format!("as from[{part}].{field}"));
                InputError::check_same(path, to, from, &reason)?;
            }
            // The buffers' lengths are not compared: after erosion a buffer is larger than its fields.
            from.check(&format!("from[{part}]"), 0)?;
            to.check(&format!("to[{part}]"), 0)?;
            let between = Fields::new(gpu, "terrain heights", from.width, from.count)?;
            let buffers = MorphBuffers { from: &from.heights, to: &to.heights, heights: &between.heights };
            jobs.push(pass.prepare_first(gpu, buffers, between.points(0) as u32)?);
            fields.push(between);
        }
        Ok(Self { fields, jobs })
    }

    /// The fields that receive the blended heights, in the order of the parts.
    pub fn fields(&self) -> &[Fields] {
        &self.fields
    }

    /// Sets the time of the blend for the next submission.
    ///
    /// # Errors
    /// [`InputError`] for a time outside 0..=1; [`crate::gpu::GpuError`].
    pub fn set(&self, gpu: &Gpu, morph: Morph) -> Result<(), Error> {
        let mut gpu = gpu;
        self.stage(&mut gpu, morph)
    }

    /// Sets the time of the blend for the next submission; the upload goes through `to`.
    pub(crate) fn stage(&self, to: &mut impl Upload, morph: Morph) -> Result<(), Error> {
        self.jobs.iter().try_for_each(|job| job.set_through(to, morph))
    }

    /// Records the blend of all parts at the time that was set.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.jobs.iter().for_each(|job| job.record(encoder));
    }
}
