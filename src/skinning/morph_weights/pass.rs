//! The GPU pass of `kernels/skinning/morph_weights.wgsl`.

use super::{WeightEntry, WeightSet};
use crate::Error;
use crate::animation::instance::{Instance, check_elapsed};
use crate::gpu::bindings::skinning::morph_weights as bindings;
use crate::gpu::{Buffer, Gpu, Job, ParamsJob, Step, Uniform, Upload, pass};
use crate::shared::skinning::morph_weights::MorphWeightsParams;
use crate::skinning::buffers::SkinnedCrowd;

pass! {
    /// GPU pass that evaluates the weights of morph targets.
    pub struct MorphWeightsPass;
}

impl MorphWeightsPass {
    /// Prepares the evaluation of a crowd's morph weights. `instances` gives the clip of the set that each instance
    /// plays. Layers on top of these clips are ignored. For a mesh without morph targets the job is empty.
    ///
    /// # Errors
    /// [`crate::InputError`] if there are fewer instances than the crowd has, or if the crowd belongs to another mesh;
    /// [`crate::gpu::GpuError`] from the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        set: &WeightSet,
        instances: &Buffer<Instance>,
        crowd: &SkinnedCrowd,
    ) -> Result<MorphWeightsJob, Error> {
        let pairs = crowd.instances * set.targets;
        instances.check_holds("instances", crowd.instances)?;
        crowd.weights.check_holds("crowd.weights", pairs)?;
        crowd.instance_lods.check_holds("crowd.instance_lods", crowd.instances)?;
        let params = MorphWeightsParams { targets: set.targets as u32, pairs: pairs as u32, elapsed: 0.0 };
        let uniform = Uniform::new(gpu, "morph weights", &params)?;
        let mut steps = Vec::new();
        if pairs > 0 {
            let entries: Vec<_> = set.entries.iter().map(WeightEntry::packed).collect();
            let entries = Buffer::constant(gpu, "weight keys", &entries)?;
            let times = Buffer::constant(gpu, "weight times", &set.times)?;
            let values = Buffer::constant(gpu, "weight values", &set.values)?;
            let group = bindings::Group {
                params: &uniform,
                instances: instances.slice(),
                entries: entries.slice(),
                instance_lods: crowd.instance_lods.slice(),
                times: times.slice(),
                values: values.slice(),
                weights: crowd.weights.slice(),
            };
            let groups = vec![group.bind(gpu, &self.kernel)?];
            steps.push(Step::spread(gpu, &self.kernel, groups, params.pairs));
        }
        Ok(ParamsJob { params, uniform, job: Job::new(gpu, "skinning/morph_weights", steps)? })
    }
}

/// A prepared evaluation of morph weights. Set the time with [`MorphWeightsJob::set`], then record the job.
pub type MorphWeightsJob = ParamsJob<MorphWeightsParams>;

impl MorphWeightsJob {
    /// Sets the time for the next submission, in seconds on the clock of the instances' start times.
    ///
    /// # Errors
    /// [`crate::InputError`] for seconds beyond ±[`MAX_SECONDS`](crate::animation::instance::MAX_SECONDS);
    /// [`crate::gpu::GpuError`].
    pub fn set(&self, gpu: &Gpu, elapsed: f32) -> Result<(), Error> {
        self.set_through(&mut &*gpu, elapsed)
    }

    /// As [`MorphWeightsJob::set`], but writes the time through `upload`.
    ///
    /// # Errors
    /// The same errors as [`MorphWeightsJob::set`].
    pub fn set_through(&self, upload: &mut impl Upload, elapsed: f32) -> Result<(), Error> {
        check_elapsed(elapsed)?;
        Ok(upload.uniform(&self.uniform, &MorphWeightsParams { elapsed, ..self.params })?)
    }
}
