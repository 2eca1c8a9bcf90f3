//! Table of the motion that a stale bone is expected to show.

use super::AnimatedBones;
use super::columns::columns;
use super::motion::MotionTable;
use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::motion::{motions, typical_levers};
use crate::asset::clip::Clip;
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;

/// Table of [`Gate::Budget`](crate::animation::Gate::Budget): the motion that each bone is expected to add to points that follow
/// the bone or its descendants. The displacements of these points are combined as the root of the sum of their squares. The gate
/// ranks bones by this motion.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectationTable(MotionTable);

impl ExpectationTable {
    /// Computes the table for a set of clips. The arguments are the same as for [`BoundTable::new`](super::BoundTable::new).
    ///
    /// # Errors
    /// The same errors as [`BoundTable::new`](super::BoundTable::new).
    pub fn new(
        skeleton: &Skeleton,
        set: &ClipSet,
        clips: &[&Clip],
        bone_radii: &[f32],
        path: RotationPath,
    ) -> Result<Self, InputError> {
        let (mut table, order) = MotionTable::new(skeleton, set, clips, bone_radii, path, 0)?;
        let levers = typical_levers(skeleton, bone_radii);
        let of = |(entry, clip): (_, &&Clip)| columns(&motions(set, entry, clip, path), &levers);
        let all: Vec<_> = set.clips().iter().zip(clips).map(of).collect();
        table.fill(&order, set, &all)?;
        Ok(Self(table))
    }

    /// Table of the bones that each clip moves.
    pub fn animated_bones(&self) -> &AnimatedBones {
        &self.0.animated_bones
    }

    /// Mutable form of [`ExpectationTable::animated_bones`].
    pub(crate) fn animated_bones_mut(&mut self) -> &mut AnimatedBones {
        &mut self.0.animated_bones
    }

    /// Rotation path that the motion was computed for.
    pub fn path(&self) -> RotationPath {
        self.0.path
    }

    /// Table entries, row by row. Each entry is the accumulated motion at the row's time and its increase until the next row. In
    /// a clip's last row, the entry is the motion of the whole clip and a [`BoneErrorBudget`](super::BoneErrorBudget) whose
    /// fraction is 0.
    pub fn rows(&self) -> &[[u32; 2]] {
        &self.0.rows
    }

    /// Accumulated motion of a slot at a row, and its increase until the next row.
    pub(crate) fn motion(&self, row: u32, slot: usize) -> [u32; 2] {
        self.0.motion(row, slot)
    }

    /// Motion of a slot over a whole clip.
    pub(crate) fn period(&self, clip: u32, slot: usize) -> u32 {
        self.0.of_clip(clip, slot)[0]
    }
}
