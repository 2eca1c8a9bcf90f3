//! The lists of active bones and instances on the device.

use crate::animation::crowd::Crowd;
use crate::animation::model_matrices::ExclusiveConsumer;
use crate::animation::order::Order;
use crate::animation::updated_bones::UpdatedBones;
use crate::gpu::{Buffer, Gpu, GpuError, rows_of_workgroups};
use crate::shared::animation::compact::WIDTH;
use crate::{Error, InputError};

/// List of (instance, bone) pairs to sample, in a buffer that kernels may fill.
#[derive(Debug, Clone)]
pub struct ActivePairs {
    /// Pair index `instance · bones + bone`, with the flag [`PAIR_AHEAD`](crate::animation::active::PAIR_AHEAD) if the bone is
    /// sampled ahead. Pairs that are not listed are skipped.
    pub pairs: Buffer<u32>,
    /// Indirect dispatch arguments (workgroups of 64 along x, y and z), followed by the number of pairs.
    pub dispatched: Buffer<u32>,
    consumer: ExclusiveConsumer,
}

impl ActivePairs {
    /// Allocates an empty list with room for all pairs of a crowd.
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

    /// Uploads the list from the host.
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

/// Work lists of one frame for a crowd. The caller may read and bind all buffers.
#[derive(Debug, Clone)]
pub struct Active {
    /// Three bit masks, each with one bit per slot and [`Order::words`] words per instance. First: the sampled bones. Second:
    /// the bones among them that are sampled at the look-ahead time, for later frames. A gate or the caller writes both. Third ([`Active::updated_words`]): the
    /// bones whose model matrices the frame updates.
    pub bits: Buffer<u32>,
    /// Bones whose model matrices this or an earlier frame updated and that skinning has not followed yet.
    pub updated_bones: UpdatedBones,
    /// The pairs to be sampled.
    pub pairs: ActivePairs,
    /// Indices of the instances that have an active bone.
    pub instances: Buffer<u32>,
    /// Arguments of indirect dispatches, in three groups:
    ///
    /// - workgroups of 64 along x, y and z for one thread per listed instance, then the number of these instances;
    /// - for each level of chains, workgroups for one thread per chain of each instance, then the level's number of chains;
    /// - workgroups for one thread per cursor of each instance, then the number of cursors per instance.
    pub dispatches: Buffer<[u32; 4]>,
    pub(crate) slots: Buffer<crate::shared::animation::order::Slot>,
    pub(crate) counts: Buffer<u32>,
    pub(crate) words: u32,
}

impl Active {
    /// Allocates lists for a crowd of a skeleton. Nothing is active at first.
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

    /// Range of words in [`Active::bits`] with the bones whose model matrices the frame updates: active bones and all their
    /// descendants.
    pub fn updated_words(&self) -> std::ops::Range<usize> {
        let words = self.instances.len() * self.words as usize;
        2 * words..3 * words
    }
}
