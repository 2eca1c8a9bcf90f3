//! The lists of active bones and instances on the device.

use crate::animation::crowd::Crowd;
use crate::animation::model_matrices::ExclusiveConsumer;
use crate::animation::order::Order;
use crate::animation::updated_bones::UpdatedBones;
use crate::gpu::{Buffer, Gpu, GpuError, rows_of_workgroups};
use crate::shared::animation::compact::WIDTH;
use crate::{Error, InputError};

/// The pairs of instance and bone to be sampled, in a buffer that kernels may fill.
#[derive(Debug, Clone)]
pub struct ActivePairs {
    /// `instance · bones + bone` of each pair, with [`PAIR_AHEAD`](crate::animation::active::PAIR_AHEAD) if it
    /// is sampled ahead. All other pairs are skipped.
    pub pairs: Buffer<u32>,
    /// Workgroups of 64 along x, y and z, as arguments of an indirect dispatch, and the number of pairs.
    pub dispatched: Buffer<u32>,
    consumer: ExclusiveConsumer,
}

impl ActivePairs {
    /// Allocates a list with room for all pairs of a crowd. It is empty at first.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, crowd: &Crowd) -> Result<Self, GpuError> {
        let dispatched = Buffer::from_slice(gpu, "dispatched", &[0, 1, 1, 0])?;
        let consumer = crowd.model_matrices.consumer().clone();
        Ok(Self { pairs: Buffer::new(gpu, "pairs", crowd.pairs())?, dispatched, consumer })
    }

    /// Refuses a crowd other than the one for which the list was made.
    pub(crate) fn check_crowd(&self, crowd: &Crowd) -> Result<(), InputError> {
        crowd.model_matrices.consumer().check_same(&self.consumer)
    }

    /// Sets the list from the host.
    ///
    /// # Errors
    /// [`GpuError`], also for more pairs than the crowd has.
    pub fn write(&self, gpu: &Gpu, pairs: &[u32]) -> Result<(), GpuError> {
        self.pairs.write(gpu, pairs)?;
        let groups = (pairs.len() as u32).div_ceil(WIDTH);
        let [x, y, z] = rows_of_workgroups(gpu, groups);
        self.dispatched.write(gpu, &[x, y, z, pairs.len() as u32])
    }
}

/// The work of a frame for a crowd. The caller may read and bind all buffers.
#[derive(Debug, Clone)]
pub struct Active {
    /// One bit per slot of each instance, in [`Order::words`] words per instance: the bones that are sampled;
    /// then, in the same layout, those of them that are sampled ahead. A gate or the caller writes them. Then
    /// come those whose model matrices the frame updates ([`Active::updated_words`]).
    pub bits: Buffer<u32>,
    /// The bones whose model matrices this frame or one before updated, until skinning has followed them.
    pub updated_bones: UpdatedBones,
    /// The pairs to be sampled.
    pub pairs: ActivePairs,
    /// Indices of the instances that have an active bone.
    pub instances: Buffer<u32>,
    /// Arguments of indirect dispatches. First, workgroups of 64 along x, y and z for one thread per listed
    /// instance, and the number of these instances. Then, for each level of chains, workgroups for one thread
    /// per chain of each instance, and the level's number of chains. Last, workgroups for one thread per cursor
    /// of each instance, and an instance's number of cursors.
    pub dispatches: Buffer<[u32; 4]>,
    pub(crate) slots: Buffer<crate::shared::animation::order::Slot>,
    pub(crate) counts: Buffer<u32>,
    pub(crate) words: u32,
}

impl Active {
    /// Allocates the lists for a crowd of a skeleton; nothing is active.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another skeleton; [`GpuError`].
    pub fn new(gpu: &Gpu, order: &Order, crowd: &Crowd) -> Result<Self, Error> {
        InputError::check_same("crowd.bones", crowd.bones, order.slots.len(), "as the skeleton's")?;
        let instances = crowd.len();
        let words = order.words();
        let chains = order.levels.windows(2).map(|level| [0, 1, 1, level[1] - level[0]]);
        let cursors = [0, 1, 1, (crowd.cursors.len() / crowd.len()) as u32];
        let dispatches: Vec<[u32; 4]> =
            std::iter::once([0, 1, 1, 0]).chain(chains).chain(std::iter::once(cursors)).collect();
        Ok(Self {
            bits: Buffer::new(gpu, "active bits", 3 * instances * words)?,
            updated_bones: UpdatedBones::new(gpu, instances * words)?,
            pairs: ActivePairs::new(gpu, crowd)?,
            instances: Buffer::new(gpu, "updated instances", instances)?,
            dispatches: Buffer::from_slice(gpu, "dispatches", &dispatches)?,
            slots: Buffer::from_slice(gpu, "slots", &order.packed_slots())?,
            counts: Buffer::new(gpu, "counts", instances)?,
            words: words as u32,
        })
    }

    /// The words of [`Active::bits`] that hold the bones whose model matrices the frame updates: active ones, and all
    /// below them.
    pub fn updated_words(&self) -> std::ops::Range<usize> {
        let words = self.instances.len() * self.words as usize;
        2 * words..3 * words
    }
}
