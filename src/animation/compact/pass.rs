//! `kernels/animation/compact.wgsl`.

use crate::animation::concat::Order;
use crate::animation::crowd::Crowd;
use crate::animation::sample::ActivePairs;
use crate::gpu::bindings::animation::compact as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::animation::compact::{ALL, CompactParams, SCAN, SCATTER, SPREAD};
use crate::{Error, InputError};

/// What is to be done for a crowd in a frame. All buffers may be read and bound by the caller.
#[derive(Debug, Clone)]
pub struct Active {
    /// A bit for each slot of each instance, [`Order::words`] words an instance: those that are sampled; then likewise, those
    /// of them that are sampled ahead. Written by a gate, or by the caller.
    pub bits: Buffer<u32>,
    /// Likewise: those that are concatenated.
    pub dirty: Buffer<u32>,
    /// The pairs that are sampled.
    pub pairs: ActivePairs,
    /// Instances with an active bone.
    pub instances: Buffer<u32>,
    /// Workgroups of 64 along x, y, z for a thread an instance of the list, and how many these are; then, for each
    /// level of chains, workgroups for a thread a chain of each of them, and the level's chains; last, workgroups for a
    /// thread a place of each of them, and an instance's places.
    pub dispatches: Buffer<[u32; 4]>,
    pub(crate) slots: Buffer<super::super::concat::Slot>,
    pub(crate) counts: Buffer<u32>,
    pub(crate) words: u32,
}

impl Active {
    /// Room for a crowd of a skeleton; nothing is active.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another skeleton; [`GpuError`].
    pub fn new(gpu: &Gpu, order: &Order, crowd: &Crowd) -> Result<Self, Error> {
        if crowd.bones != order.slots.len() {
            let bound = format!("must be {}, as the skeleton's", order.slots.len());
            return Err(InputError::new("crowd.bones", crowd.bones, bound).into());
        }
        let instances = crowd.len();
        let words = order.words();
        let chains = order.levels.windows(2).map(|level| [0, 1, 1, level[1] - level[0]]);
        let places = [0, 1, 1, (crowd.places.len() / crowd.len()) as u32];
        let dispatches: Vec<[u32; 4]> =
            std::iter::once([0, 1, 1, 0]).chain(chains).chain(std::iter::once(places)).collect();
        Ok(Self {
            bits: Buffer::new(gpu, "active bits", 2 * instances * words)?,
            dirty: Buffer::new(gpu, "dirty bits", instances * words)?,
            pairs: ActivePairs::new(gpu, crowd)?,
            instances: Buffer::new(gpu, "dirty instances", instances)?,
            dispatches: Buffer::from_slice(gpu, "dispatches", &dispatches)?,
            slots: Buffer::from_slice(gpu, "slots", &order.slots)?,
            counts: Buffer::new(gpu, "counts", instances)?,
            words: words as u32,
        })
    }
}

/// How threads share the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stages {
    /// A dispatch that spreads, one that sums, one that lists.
    Three,
    /// One workgroup does all of it. On lavapipe, where a dispatch takes 20 µs and more, faster for some hundred
    /// instances.
    One,
}

impl Stages {
    /// Words of bits up to which one workgroup is enough where processors are few.
    const FEW: usize = 2048;

    /// The faster way for a crowd on this kind of adapter.
    pub fn of(gpu: &Gpu, active: &Active) -> Self {
        if gpu.adapter().kind == "cpu" && active.dirty.len() <= Self::FEW { Self::One } else { Self::Three }
    }
}

/// Makes lists of bits.
#[derive(Debug, Clone)]
pub struct CompactPass {
    stages: [Kernel; 3],
    all: Kernel,
}

/// Prepared lists.
pub type CompactJob = Job;

impl CompactPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let stage = |stage| bindings::kernel(gpu, &bindings::Constants { stage });
        Ok(Self { stages: [stage(SPREAD)?, stage(SCAN)?, stage(SCATTER)?], all: stage(ALL)? })
    }

    /// Prepares the lists of a crowd's active bits.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        active: &Active,
        stages: Stages,
    ) -> Result<CompactJob, Error> {
        let params = CompactParams::new(gpu, crowd, active);
        let uniform = Uniform::new(gpu, "compact", &params)?;
        let group = bindings::Group {
            bits: active.bits.slice(),
            compact_params: &uniform,
            slots: active.slots.slice().cast(),
            dirty: active.dirty.slice(),
            counts: active.counts.slice(),
            pairs: active.pairs.pairs.slice(),
            pair_dispatch: active.pairs.dispatched.slice().cast(),
            dirty_instances: active.instances.slice(),
            instance_dispatches: active.dispatches.slice(),
        };
        let step = |kernel: &Kernel, threads: u32| {
            Ok::<_, GpuError>(Step {
                groups: vec![group.bind(gpu, kernel)?],
                workgroups: kernel.spread(gpu, threads),
                kernel: kernel.clone(),
            })
        };
        let [spread, scan, scatter] = &self.stages;
        let steps = match stages {
            Stages::One => vec![step(&self.all, 1)?],
            Stages::Three => vec![
                step(spread, params.instances)?,
                step(scan, 1)?,
                step(scatter, params.instances * params.words)?,
            ],
        };
        Ok(Job::new(gpu, "animation/compact", steps)?)
    }
}

impl CompactParams {
    pub fn new(gpu: &Gpu, crowd: &Crowd, active: &Active) -> Self {
        Self {
            instances: crowd.len() as u32,
            bones: crowd.bones as u32,
            words: active.words,
            served: active.dispatches.len() as u32 - 1,
            most_groups: gpu.device().limits().max_compute_workgroups_per_dimension,
        }
    }
}
