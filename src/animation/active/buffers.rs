//! The lists on the device.

use crate::animation::crowd::Crowd;
use crate::animation::model_matrices::ExclusiveConsumer;
use crate::animation::order::Order;
use crate::gpu::{Buffer, Gpu, GpuError, rows_of_workgroups};
use crate::{Error, InputError};

/// The pairs of instance and bone that are to be sampled, in a buffer that kernels may fill.
#[derive(Debug, Clone)]
pub struct ActivePairs {
    /// `instance · bones + bone`, with [`PAIR_AHEAD`](crate::animation::active::PAIR_AHEAD) where it is sampled ahead; others are skipped.
    pub pairs: Buffer<u32>,
    /// Workgroups of 64 along x, y and z, and how many pairs: arguments of an indirect dispatch.
    pub dispatched: Buffer<u32>,
    consumer: ExclusiveConsumer,
}

impl ActivePairs {
    /// Room for all pairs of a crowd; none is active.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, crowd: &Crowd) -> Result<Self, GpuError> {
        let dispatched = Buffer::from_slice(gpu, "dispatched", &[0, 1, 1, 0])?;
        let consumer = crowd.model_matrices.consumer().clone();
        Ok(Self { pairs: Buffer::new(gpu, "pairs", crowd.pairs())?, dispatched, consumer })
    }

    /// Refuses another crowd than the one that they were made for.
    pub(crate) fn check_crowd(&self, crowd: &Crowd) -> Result<(), InputError> {
        crowd.model_matrices.consumer().check_same(&self.consumer)
    }

    /// Makes these pairs active, from the host.
    ///
    /// # Errors
    /// [`GpuError`], for more pairs than the crowd has too.
    pub fn write(&self, gpu: &Gpu, pairs: &[u32]) -> Result<(), GpuError> {
        self.pairs.write(gpu, pairs)?;
        let groups = pairs.len().div_ceil(64) as u32;
        let [x, y, z] = rows_of_workgroups(gpu, groups);
        self.dispatched.write(gpu, &[x, y, z, pairs.len() as u32])
    }
}

/// What is to be done for a crowd in a frame. All buffers may be read and bound by the caller.
#[derive(Debug, Clone)]
pub struct Active {
    /// A bit for each slot of each instance, [`Order::words`] words an instance: those that are sampled; then likewise, those
    /// of them that are sampled ahead. Written by a gate, or by the caller.
    pub bits: Buffer<u32>,
    /// Likewise: those that are concatenated.
    pub updated_bones: Buffer<u32>,
    /// The pairs that are sampled.
    pub pairs: ActivePairs,
    /// Instances with an active bone.
    pub instances: Buffer<u32>,
    /// Workgroups of 64 along x, y, z for a thread an instance of the list, and how many these are; then, for each
    /// level of chains, workgroups for a thread a chain of each of them, and the level's chains; last, workgroups for a
    /// thread a place of each of them, and an instance's places.
    pub dispatches: Buffer<[u32; 4]>,
    pub(crate) slots: Buffer<crate::animation::order::Slot>,
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
        let cursors = [0, 1, 1, (crowd.cursors.len() / crowd.len()) as u32];
        let dispatches: Vec<[u32; 4]> =
            std::iter::once([0, 1, 1, 0]).chain(chains).chain(std::iter::once(cursors)).collect();
        Ok(Self {
            bits: Buffer::new(gpu, "active bits", 2 * instances * words)?,
            updated_bones: Buffer::new(gpu, "updated bones", instances * words)?,
            pairs: ActivePairs::new(gpu, crowd)?,
            instances: Buffer::new(gpu, "updated instances", instances)?,
            dispatches: Buffer::from_slice(gpu, "dispatches", &dispatches)?,
            slots: Buffer::from_slice(gpu, "slots", &order.slots)?,
            counts: Buffer::new(gpu, "counts", instances)?,
            words: words as u32,
        })
    }
}
