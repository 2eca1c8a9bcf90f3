//! The GPU pass of `kernels/skinning/morph_weights.wgsl`.

use super::{WeightEntry, WeightSet};
use crate::Error;
use crate::animation::instance::{Instance, check_elapsed};
use crate::gpu::bindings::skinning::morph_weights as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, ParamsJob, Step, Uniform, Upload};
use crate::shared::skinning::morph_weights::MorphWeightsParams;
use crate::skinning::buffers::SkinnedCrowd;

/// Evaluates the weights of morph targets.
#[derive(Debug, Clone)]
pub struct MorphWeightsPass {
    kernel: Kernel,
}

impl MorphWeightsPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the weights of a crowd that plays `instances` of the set's clips. Layers above them are
    /// ignored. For a mesh without targets the job is empty.
    ///
    /// # Errors
    /// [`crate::InputError`] for fewer instances than the crowd has, and for a crowd of another mesh;
    /// [`GpuError`].
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

/// Prepared weights: set the time, then record.
pub type MorphWeightsJob = ParamsJob<MorphWeightsParams>;

impl MorphWeightsJob {
    /// Sets the time for the next submission: seconds since the instances' starts.
    ///
    /// # Errors
    /// [`crate::InputError`] for seconds beyond ±[`MAX_SECONDS`](crate::animation::instance::MAX_SECONDS);
    /// [`GpuError`].
    pub fn set(&self, gpu: &Gpu, elapsed: f32) -> Result<(), Error> {
        self.set_through(&mut &*gpu, elapsed)
    }

    /// As [`MorphWeightsJob::set`], written by `upload`.
    ///
    /// # Errors
    /// As [`MorphWeightsJob::set`].
    pub fn set_through(&self, upload: &mut impl Upload, elapsed: f32) -> Result<(), Error> {
        check_elapsed(elapsed)?;
        Ok(upload.uniform(&self.uniform, &MorphWeightsParams { elapsed, ..self.params })?)
    }
}
