//! Motion that a stale bone is expected to show.

use super::AnimatedBones;
use super::columns::columns;
use super::motion::MotionTable;
use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::motion::{motions, typical_levers};
use crate::asset::clip::Clip;
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;

/// Expected motion that each bone contributes to points that follow it or a bone below it, as a root sum of squares.
/// [`Gate::Budget`](crate::animation::Gate::Budget) ranks bones by it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectationTable(MotionTable);

impl ExpectationTable {
    /// Computes the table of a set's clips. The arguments are those of
    /// [`BoundTable::new`](super::BoundTable::new).
    ///
    /// # Errors
    /// As [`BoundTable::new`](super::BoundTable::new).
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

    /// The bones that each clip moves.
    pub fn animated_bones(&self) -> &AnimatedBones {
        &self.0.animated_bones
    }

    /// Rotation path for which the motion was computed.
    pub fn path(&self) -> RotationPath {
        self.0.path
    }

    /// Entries row by row: the accumulated motion at the row's time and its rise to the next row. A clip's last row holds the
    /// motion of the whole clip and an [`BoneErrorBudget`](super::BoneErrorBudget) of 0.
    pub fn rows(&self) -> &[[u32; 2]] {
        &self.0.rows
    }

    /// The motion of a slot in a row.
    pub(crate) fn motion(&self, row: u32, slot: usize) -> [u32; 2] {
        self.0.motion(row, slot)
    }

    /// A slot's motion over a whole clip.
    pub(crate) fn period(&self, clip: u32, slot: usize) -> u32 {
        self.0.of_clip(clip, slot)[0]
    }
}
