//! Motion as a stale bone is expected to show it.

use super::AnimatedBones;
use super::columns::columns;
use super::motion::MotionTable;
use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::motion::{motions, typical_levers};
use crate::asset::clip::Clip;
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;

/// The expected motion that each bone contributes to points at and below it, as a root of the sum of squares, by
/// which [`Gate::Budget`](crate::animation::Gate::Budget) ranks bones.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectationTable(MotionTable);

impl ExpectationTable {
    /// The table of a set's clips. Arguments as for [`BoundTable::new`](super::BoundTable::new).
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

    /// The rotation path for which the motion was computed.
    pub fn path(&self) -> RotationPath {
        self.0.path
    }

    /// The entries, row by row: a sum of motion at the row's time and its rise to the next. In a clip's last row stand its
    /// sum over the whole clip, and an [`ErrorBudget`](super::ErrorBudget) that grants nothing.
    pub fn rows(&self) -> &[[u32; 2]] {
        &self.0.rows
    }

    /// The motion of a slot in a row.
    pub(crate) fn motion(&self, row: u32, slot: usize) -> [u32; 2] {
        self.0.motion(row, slot)
    }

    /// A slot's motion along a whole clip.
    pub(crate) fn period(&self, clip: u32, slot: usize) -> u32 {
        self.0.of_clip(clip, slot)[0]
    }
}
