//! The GPU pass of `kernels/animation/local_to_model.wgsl`.

use crate::animation::active::Active;
use crate::animation::crowd::Crowd;
use crate::animation::order::{Chain, Order};
use crate::asset::skeleton::Skeleton;
use crate::gpu::bindings::animation::local_to_model as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Job, Kernel, Step, Uniform};
use crate::shared::animation::local_to_model::LocalToModelParams;
use crate::shared::animation::order::Slot as PackedSlot;
use crate::{Error, InputError};

/// Computes model matrices from local transforms on the GPU.
#[derive(Debug, Clone)]
pub struct LocalToModelPass {
    all: Kernel,
    compacted: Kernel,
}

impl LocalToModelPass {
    /// Compiles the compute pipelines of this pass.
    ///
    /// # Errors
    /// [`GpuError`] for shader compilation errors of the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |compacted| bindings::kernel(gpu, &bindings::Constants { compacted });
        Ok(Self { all: kernel(false)?, compacted: kernel(true)? })
    }

    /// Prepares a job that computes all model matrices of a crowd from its local transforms. It uses one dispatch per level of
    /// bone chains.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another skeleton; [`GpuError`] for errors of the device.
    pub fn prepare(&self, gpu: &Gpu, skeleton: &Skeleton, crowd: &Crowd) -> Result<Job, Error> {
        let binder = Binder::new(gpu, skeleton, crowd)?;
        // Placeholders for the lists: this kernel processes every slot and reads no list.
        let (words, dispatches) = (Buffer::new(gpu, "nothing", 0)?, Buffer::new(gpu, "nothing", 1)?);
        let lists =
            Lists { updated_bones: &words, first_word: 0, instances: &words, dispatches: &dispatches };
        let step = |level: &[u32]| {
            let group = binder.bind(gpu, &self.all, level, &lists)?;
            Ok(Step::spread(gpu, &self.all, vec![group], crowd.len() as u32 * (level[1] - level[0])))
        };
        let steps = binder.order.levels.windows(2).map(step).collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "animation/local_to_model", steps)?)
    }

    /// Prepares a job that computes the model matrices of updated bones. All other matrices stay unchanged.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another skeleton, and if `active` belongs to another crowd; [`GpuError`] for errors of the
    /// device.
    pub fn prepare_active(
        &self,
        gpu: &Gpu,
        skeleton: &Skeleton,
        crowd: &Crowd,
        active: &Active,
    ) -> Result<Job, Error> {
        active.pairs.check_crowd(crowd)?;
        let binder = Binder::new(gpu, skeleton, crowd)?;
        let lists = Lists {
            updated_bones: &active.bits,
            first_word: active.updated_words().start as u32,
            instances: &active.instances,
            dispatches: &active.dispatches,
        };
        // Entry 0 of `dispatches` is for a dispatch with one thread per updated instance. The levels of chains begin at entry 1.
        let step = |(dispatch, level): (u64, &[u32])| {
            let group = binder.bind(gpu, &self.compacted, level, &lists)?;
            Ok(Step::indirect(&self.compacted, group, active.dispatches.raw(), 16 * dispatch))
        };
        let levels = binder.order.levels.windows(2);
        let steps = (1..).zip(levels).map(step).collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "animation/local_to_model", steps)?)
    }
}

/// Buffers that list the instances and slots to process.
struct Lists<'a> {
    updated_bones: &'a Buffer<u32>,
    /// Index of the first word of the updated bones in `updated_bones`.
    first_word: u32,
    instances: &'a Buffer<u32>,
    dispatches: &'a Buffer<[u32; 4]>,
}

/// Resources that the dispatches of all levels bind.
struct Binder<'a> {
    order: Order,
    slots: Buffer<PackedSlot>,
    chains: Buffer<Chain>,
    crowd: &'a Crowd,
}

impl<'a> Binder<'a> {
    fn new(gpu: &Gpu, skeleton: &Skeleton, crowd: &'a Crowd) -> Result<Self, Error> {
        InputError::check_same("crowd.bones", crowd.bones, skeleton.len(), "as the skeleton's")?;
        let order = Order::new(skeleton);
        let slots = Buffer::from_slice(gpu, "slots", &order.packed_slots())?;
        let chains = Buffer::from_slice(gpu, "chains", &order.chains)?;
        Ok(Self { order, slots, chains, crowd })
    }

    fn bind(&self, gpu: &Gpu, kernel: &Kernel, level: &[u32], lists: &Lists<'_>) -> Result<Group, GpuError> {
        let crowd = self.crowd;
        let params = LocalToModelParams {
            instances: crowd.len() as u32,
            bones: crowd.bones as u32,
            words: self.order.words() as u32,
            first_chain: level[0],
            chains: level[1] - level[0],
            first_word: lists.first_word,
        };
        let uniform = Uniform::new(gpu, "local_to_model", &params)?;
        let group = bindings::Group {
            params: &uniform,
            slots: self.slots.slice(),
            chains: self.chains.slice(),
            updated_bones: lists.updated_bones.slice(),
            updated_instances: lists.instances.slice(),
            dispatches: lists.dispatches.slice(),
            locals: crowd.locals.slice().cast(),
            model_matrices: crowd.model_matrices.buffer().slice().cast(),
        };
        group.bind(gpu, kernel)
    }
}
