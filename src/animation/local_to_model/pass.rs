//! The GPU pass of `kernels/animation/local_to_model.wgsl`.

use crate::animation::active::Active;
use crate::animation::crowd::Crowd;
use crate::animation::order::{Chain, Order};
use crate::asset::skeleton::Skeleton;
use crate::gpu::bindings::animation::local_to_model as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Group, IndirectJob, Job, Kernel, Step, Uniform};
use crate::shared::animation::local_to_model::LocalToModelParams;
use crate::shared::animation::order::Slot as PackedSlot;
use crate::{Error, InputError};

/// How threads divide the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walk {
    /// One thread per chain and one dispatch per level of chains, which gives enough threads to hardware.
    Levels,
    /// One thread per instance, in one dispatch: the bones of an instance stay in a processor's cache. On
    /// lavapipe this is about one and a half times as fast; a workgroup per instance with barriers between
    /// levels is three times as slow.
    Whole,
}

impl Walk {
    /// The faster choice for this kind of adapter.
    pub fn of(gpu: &Gpu) -> Self {
        if gpu.tuning().wants_long_threads() { Self::Whole } else { Self::Levels }
    }
}

/// Concatenates local transforms.
#[derive(Debug, Clone)]
pub struct LocalToModelPass {
    all: Kernel,
    compacted: Kernel,
    walk: Walk,
}

/// A prepared concatenation, with one dispatch per level of chains.
pub type LocalToModelJob = Job;

/// A prepared concatenation of updated bones.
pub type LocalToModelActiveJob = IndirectJob;

impl LocalToModelPass {
    /// Compiles the pipelines that are fastest on this kind of adapter.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Self::with_walk(gpu, Walk::of(gpu))
    }

    /// Compiles the pipelines of a walk.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn with_walk(gpu: &Gpu, walk: Walk) -> Result<Self, GpuError> {
        let whole = walk == Walk::Whole;
        let kernel = |compacted| bindings::kernel(gpu, &bindings::Constants { whole, compacted });
        Ok(Self { all: kernel(false)?, compacted: kernel(true)?, walk })
    }

    /// Prepares the model matrices of a crowd from its local transforms.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another skeleton; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, skeleton: &Skeleton, crowd: &Crowd) -> Result<LocalToModelJob, Error> {
        let binder = Binder::new(gpu, skeleton, crowd)?;
        let nothing = Nothing::new(gpu)?;
        let instances = crowd.len() as u32;
        let step = |level: &[u32]| {
            let threads = match self.walk {
                Walk::Levels => instances * (level[1] - level[0]),
                Walk::Whole => instances,
            };
            Ok(Step {
                groups: vec![binder.bind(gpu, &self.all, level, &nothing.lists())?],
                workgroups: self.all.spread(gpu, threads),
                kernel: self.all.clone(),
            })
        };
        let steps = self.levels(&binder.order).into_iter().map(|level| step(&level));
        Ok(Job::new(gpu, "animation/local_to_model", steps.collect::<Result<_, GpuError>>()?)?)
    }

    /// Prepares the model matrices of updated bones; all others stay unchanged.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another skeleton, and for a crowd other than that of the active bones;
    /// [`GpuError`].
    pub fn prepare_active(
        &self,
        gpu: &Gpu,
        skeleton: &Skeleton,
        crowd: &Crowd,
        active: &Active,
    ) -> Result<LocalToModelActiveJob, Error> {
        active.pairs.check_crowd(crowd)?;
        let binder = Binder::new(gpu, skeleton, crowd)?;
        let lists = Lists {
            updated_bones: &active.bits,
            first_word: active.updated_words().start as u32,
            instances: &active.instances,
            dispatches: &active.dispatches,
        };
        let group = |(dispatch, level): (u64, &[u32; 2])| {
            Ok((binder.bind(gpu, &self.compacted, level, &lists)?, 16 * dispatch))
        };
        let first_dispatch = u64::from(self.walk == Walk::Levels);
        let levels = self.levels(&binder.order);
        let groups = (first_dispatch..).zip(&levels).map(group).collect::<Result<_, GpuError>>()?;
        Ok(IndirectJob::new("animation/local_to_model", &self.compacted, active.dispatches.raw(), groups))
    }

    /// First and last chain of each dispatch.
    fn levels(&self, order: &Order) -> Vec<[u32; 2]> {
        match self.walk {
            Walk::Levels => order.levels.windows(2).map(|level| [level[0], level[1]]).collect(),
            Walk::Whole => vec![[0, order.chains.len() as u32]],
        }
    }
}

/// The instances and slots that are walked.
struct Lists<'a> {
    updated_bones: &'a Buffer<u32>,
    /// The word at which the updated bones begin.
    first_word: u32,
    instances: &'a Buffer<u32>,
    dispatches: &'a Buffer<[u32; 4]>,
}

/// Stand-ins that are bound where every slot is walked.
struct Nothing {
    words: Buffer<u32>,
    dispatches: Buffer<[u32; 4]>,
}

impl Nothing {
    fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { words: Buffer::new(gpu, "nothing", 0)?, dispatches: Buffer::new(gpu, "nothing", 1)? })
    }

    fn lists(&self) -> Lists<'_> {
        Lists {
            updated_bones: &self.words,
            first_word: 0,
            instances: &self.words,
            dispatches: &self.dispatches,
        }
    }
}

/// The resources that all dispatches bind.
struct Binder<'a> {
    order: Order,
    slots: Buffer<PackedSlot>,
    chains: Buffer<Chain>,
    crowd: &'a Crowd,
}

impl<'a> Binder<'a> {
    fn new(gpu: &Gpu, skeleton: &Skeleton, crowd: &'a Crowd) -> Result<Self, Error> {
        if crowd.bones != skeleton.len() {
            let bound = format!("must be {}, as the skeleton's", skeleton.len());
            return Err(InputError::new("crowd.bones", crowd.bones, bound).into());
        }
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
