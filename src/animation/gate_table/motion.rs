//! Table of accumulated motion, used by the bound table and the expectation table.

use super::columns::Column;
use super::{AnimatedBones, MAX_MOTION, empty_rows};
use crate::InputError;
use crate::animation::bounds::check_bone_radii;
use crate::animation::clip_set::ClipSet;
use crate::animation::order::Order;
use crate::asset::clip::Clip;
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;

/// Motion per row and slot. Each entry is the accumulated motion at the row's time and its increase until the next row, in units
/// of the table. A clip's last row holds the motion of the whole clip and a [`BoneErrorBudget`](super::BoneErrorBudget).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MotionTable {
    pub animated_bones: AnimatedBones,
    /// Rotation path between keys that the motion was computed for.
    pub path: RotationPath,
    pub rows: Vec<[u32; 2]>,
    /// Size of one unit of accumulated motion, in the unit in which the motion is measured: metres for distances.
    pub unit: f64,
}

impl MotionTable {
    /// Makes a table without motion, with `more` rows after the clips' rows. Also returns the order of the table's columns.
    pub fn new(
        skeleton: &Skeleton,
        set: &ClipSet,
        clips: &[&Clip],
        bone_radii: &[f32],
        path: RotationPath,
        more: usize,
    ) -> Result<(Self, Order), InputError> {
        let order = Order::new(skeleton);
        let animated_bones = AnimatedBones::new(&order, set, clips)?;
        check_bone_radii(bone_radii, skeleton.len())?;
        let rows = empty_rows(set, more, animated_bones.bones())?;
        Ok((Self { animated_bones, path, rows, unit: 1.0 }, order))
    }

    /// Writes the columns of every clip, in the smallest unit in which every clip's motion fits.
    pub fn fill(&mut self, order: &Order, set: &ClipSet, columns: &[Vec<Column>]) -> Result<(), InputError> {
        for (clip, columns) in columns.iter().enumerate() {
            if let Some(bone) = columns.iter().position(|column| !column.path.total().is_finite()) {
                let bound = "must be finite: the scales above it are too large";
                return Err(InputError::new(format!("clips[{clip}].bones[{bone}].motion"), "inf", bound));
            }
        }
        let largest = columns.iter().flatten().map(|column| column.path.total()).fold(0.0, f64::max);
        self.unit = if largest > 0.0 { largest / MAX_MOTION } else { 1.0 };
        let stride = self.stride();
        for (entry, columns) in set.clips().iter().zip(columns) {
            for (slot, bone) in order.slots.iter().enumerate() {
                let at = entry.first_row as usize * stride + slot;
                columns[bone.bone as usize].write(&mut self.rows[at..], stride, self.unit);
            }
        }
        Ok(())
    }

    /// Number of entries per row: one per bone.
    pub fn stride(&self) -> usize {
        self.animated_bones.bones()
    }

    /// Accumulated motion of a slot at a row, and its increase until the next row.
    pub fn motion(&self, row: u32, slot: usize) -> [u32; 2] {
        self.rows[row as usize * self.stride() + slot]
    }

    /// Entry of a slot in a clip's last row: the motion of the whole clip, and the encoded error budget.
    pub fn of_clip(&self, clip: u32, slot: usize) -> [u32; 2] {
        self.motion(self.animated_bones.last_row(clip), slot)
    }
}
