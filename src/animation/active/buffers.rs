//! GPU buffers that list the active bones and instances of a frame.

use crate::animation::crowd::Crowd;
use crate::animation::model_matrices::ExclusiveConsumer;
use crate::animation::order::Order;
use crate::animation::updated_bones::UpdatedBones;
use crate::gpu::{Buffer, Gpu, GpuError, rows_of_workgroups};
use crate::shared::animation::compact::WIDTH;
use crate::{Error, InputError};

/// GPU list of the (instance, bone) pairs that a frame samples. The host or a kernel fills it.
#[derive(Debug, Clone)]
pub struct ActivePairs {
    /// Pair index `instance · bones + bone` of each listed pair. The flag [`PAIR_AHEAD`](crate::animation::active::PAIR_AHEAD) is
    /// set if the bone is sampled ahead of the frame's time. Pairs that are not listed are skipped.
    pub pairs: Buffer<u32>,
    /// Indirect dispatch arguments: workgroups of 64 threads along x, y and z, then the number of listed pairs.
    pub dispatched: Buffer<u32>,
    consumer: ExclusiveConsumer,
}

impl ActivePairs {
    /// Allocates an empty list with capacity for all pairs of a crowd.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, crowd: &Crowd) -> Result<Self, GpuError> {
        let dispatched = Buffer::from_slice(gpu, "dispatched", &[0, 1, 1, 0])?;
        let consumer = crowd.model_matrices.consumer().clone();
        Ok(Self { pairs: Buffer::new(gpu, "pairs", crowd.pairs())?, dispatched, consumer })
    }

    /// Returns an error for any crowd other than the one that this list was made for.
    pub(crate) fn check_crowd(&self, crowd: &Crowd) -> Result<(), InputError> {
        crowd.model_matrices.consumer().check_same(&self.consumer)
    }

    /// Uploads a list of pairs and the dispatch arguments for it.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device, and for more pairs than the crowd has.
    pub fn write(&self, gpu: &Gpu, pairs: &[u32]) -> Result<(), GpuError> {
        self.pairs.write(gpu, pairs)?;
        let groups = (pairs.len() as u32).div_ceil(WIDTH);
        let [x, y, z] = rows_of_workgroups(gpu, groups);
        self.dispatched.write(gpu, &[x, y, z, pairs.len() as u32])
    }
}

/// Work lists of one frame of a crowd: active bones, active instances and indirect dispatch arguments. The caller may read and
/// bind all buffers.
#[derive(Debug, Clone)]
pub struct Active {
    /// Three bit masks, one after another. Each has one bit per slot (position of a bone in the [`Order`]), in [`Order::words`]
    /// words per instance. A gate or the caller writes the first two masks. In order, the masks hold:
    ///
    /// - the sampled bones;
    /// - the subset of these bones that is sampled at the look-ahead time, to stay valid for later frames;
    /// - the bones whose model matrices the frame updates ([`Active::updated_words`]).
    pub bits: Buffer<u32>,
    /// Bones whose model matrices were updated in this or an earlier frame, and whose vertices have not been skinned since.
    pub updated_bones: UpdatedBones,
    /// The (instance, bone) pairs that the frame samples.
    pub pairs: ActivePairs,
    /// Indices of the instances with at least one active bone.
    pub instances: Buffer<u32>,
    /// Arguments of indirect dispatches for active instances, in three groups:
    ///
    /// - workgroups of 64 threads along x, y and z, for one thread per listed instance; then the number of these instances;
    /// - for each level of bone chains, workgroups for one thread per chain of each instance; then the number of chains;
    /// - workgroups for one thread per keyframe cursor of each instance; then the number of cursors per instance.
    pub dispatches: Buffer<[u32; 4]>,
    pub(crate) slots: Buffer<crate::shared::animation::order::Slot>,
    pub(crate) counts: Buffer<u32>,
    pub(crate) words: u32,
}

impl Active {
    /// Allocates the lists for a crowd. Nothing is active at first.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another skeleton; [`GpuError`] for errors of the device.
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

    /// Range of words in [`Active::bits`] that marks the updated bones. The updated bones are the active bones and all their
    /// descendants. The frame updates their model matrices.
    pub fn updated_words(&self) -> std::ops::Range<usize> {
        let words = self.instances.len() * self.words as usize;
        2 * words..3 * words
    }
}
