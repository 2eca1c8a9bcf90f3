//! Placements of attached meshes in a view.

use super::View;
use crate::Error;
use crate::gpu::{Gpu, Job};
use crate::lod::attach::{AttachBuffers, AttachPass};
use crate::scene::attach::Attachments;
use crate::scene::handles::Slots;
use crate::scene::layout::Layout;
use crate::scene::object::Object;

/// Compute jobs that place attached meshes, one for each list of attachments.
#[derive(Debug, Default)]
pub(in crate::scene) struct AttachedJobs {
    /// Version of the attachment lists for which the jobs were prepared.
    version: u64,
    jobs: Vec<Job>,
}

impl View {
    /// Prepares the jobs that place attached meshes, if the lists of attachments have changed.
    pub(in crate::scene) fn fit_attached(
        &mut self,
        gpu: &Gpu,
        pass: &AttachPass,
        attachments: &Attachments,
        objects: &Slots<Object>,
        layout: &Layout,
    ) -> Result<(), Error> {
        let Some(lists) = &mut self.lists else { return Ok(()) };
        if lists.attached.version == attachments.version {
            return Ok(());
        }
        let mut jobs = Vec::new();
        for ((object, chunk), list) in attachments.lists() {
            let Some(character) = objects.get(object).and_then(Object::character) else { continue };
            let Some(model_matrices) = character.matrices(chunk) else { continue };
            let buffers = AttachBuffers {
                view: &self.select,
                attachments: &list.attachments,
                model_matrices: &model_matrices.buffer().cast(),
                instances: &layout.instances,
                allowed: &layout.allowed,
                placements: &lists.placements,
                last_instances: &layout.last_instances,
                kept: &list.kept,
            };
            jobs.push(pass.prepare(gpu, &list.params, buffers)?);
        }
        lists.attached = AttachedJobs { version: attachments.version, jobs };
        Ok(())
    }

    /// Adds the jobs that place attached meshes to a compute pass.
    pub(in crate::scene) fn dispatch_attached(&self, pass: &mut wgpu::ComputePass<'_>) {
        let jobs = self.lists.iter().flat_map(|lists| &lists.attached.jobs);
        jobs.for_each(|job| job.dispatch(pass));
    }
}
