//! The table of each bone's priority at each time.

use super::{AnimatedBones, empty_rows};
use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::order::Order;
use crate::animation::priority::Priorities;
use crate::asset::clip::Clip;

/// Priorities of each clip's bones, by which [`Gate::SkipPeriod`](crate::animation::Gate::SkipPeriod) decides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PriorityTable {
    animated_bones: AnimatedBones,
    stride: usize,
    rows: Vec<[u32; 2]>,
}

impl PriorityTable {
    /// Computes the table from one set of priorities per clip. Before its first key, a bone has the priority
    /// of that key.
    ///
    /// # Errors
    /// As [`AnimatedBones::new`]; [`InputError`] also if there is not one set of priorities per clip, and for
    /// a table of more than 2²⁷ entries.
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

    /// The bones that each clip moves.
    pub fn animated_bones(&self) -> &AnimatedBones {
        &self.animated_bones
    }

    /// Entries row by row: four priorities of 16 bits each.
    pub fn rows(&self) -> &[[u32; 2]] {
        &self.rows
    }

    /// Number of entries of a row.
    #[cfg(feature = "gpu")]
    pub(crate) fn stride(&self) -> usize {
        self.stride
    }

    /// The priority of a slot in a row, in 65536ths.
    pub(crate) fn priority(&self, row: u32, slot: usize) -> u32 {
        self.rows[row as usize * self.stride + slot / 4][slot / 2 % 2] >> (16 * (slot % 2)) & 0xffff
    }
}
