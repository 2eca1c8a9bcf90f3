//! Table of each bone's priority at each key time.

use super::{AnimatedBones, empty_rows};
use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::order::Order;
use crate::animation::priority::Priorities;
use crate::asset::clip::Clip;

/// Table of [`Gate::SkipPeriod`](crate::animation::Gate::SkipPeriod): the priority of each bone at each key time of each clip.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PriorityTable {
    animated_bones: AnimatedBones,
    stride: usize,
    rows: Vec<[u32; 2]>,
}

impl PriorityTable {
    /// Computes the table. `priorities` has one entry per clip. Before its first key, a bone has the first key's priority.
    ///
    /// # Errors
    /// [`InputError`] for the errors of [`AnimatedBones::new`], if `priorities` does not have one entry per clip, and for a table
    /// of more than 2²⁷ entries.
    pub fn new(
        order: &Order,
        set: &ClipSet,
        clips: &[&Clip],
        priorities: &[Priorities],
    ) -> Result<Self, InputError> {
        let animated_bones = AnimatedBones::new(order, set, clips)?;
        InputError::check_len("priorities", priorities.len(), clips.len(), "a clip")?;
        let stride = animated_bones.bones().div_ceil(4);
        let mut rows = empty_rows(set, 0, stride)?;
        for (entry, priorities) in set.clips().iter().zip(priorities) {
            for (slot, bone) in order.slots.iter().enumerate() {
                let keys = priorities.of(bone.bone as usize);
                for (row, time) in (entry.first_row as usize..).zip(set.common_times(entry)) {
                    let key = keys.partition_point(|key| key.time <= *time).saturating_sub(1);
                    let priority = keys.get(key).map_or(0.0, |key| key.priority);
                    rows[row * stride + slot / 4][slot / 2 % 2] |=
                        ((priority.clamp(0.0, 1.0) * 65535.0).round() as u32) << (16 * (slot % 2));
                }
            }
        }
        Ok(Self { animated_bones, stride, rows })
    }

    /// Table of the bones that each clip moves.
    pub fn animated_bones(&self) -> &AnimatedBones {
        &self.animated_bones
    }

    /// Mutable form of [`PriorityTable::animated_bones`].
    pub(crate) fn animated_bones_mut(&mut self) -> &mut AnimatedBones {
        &mut self.animated_bones
    }

    /// Table entries, row by row. Each entry packs four 16-bit priorities.
    pub fn rows(&self) -> &[[u32; 2]] {
        &self.rows
    }

    /// Number of entries per row: one per four bones.
    #[cfg(feature = "gpu")]
    pub(crate) fn stride(&self) -> usize {
        self.stride
    }

    /// Priority of a slot in a row. The integers 0 to 65535 stand for the priorities 0 to 1.
    pub(crate) fn priority(&self, row: u32, slot: usize) -> u32 {
        self.rows[row as usize * self.stride + slot / 4][slot / 2 % 2] >> (16 * (slot % 2)) & 0xffff
    }
}
