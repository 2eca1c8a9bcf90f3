//! Bounds of the motion that a stale bone misses.

use super::columns::{Column, columns};
use super::motion::MotionTable;
use super::{AnimatedBones, EVERYTHING, rows_of};
use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::motion::{bounding_levers, budget_fractions, motions, subtree_radii};
use crate::animation::order::{NO_PARENT, Order};
use crate::asset::clip::Clip;
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;

/// Power of the rates of motion that fractions are made of: 1 needs the fewest samples where fractions are all that
/// counts, 0 takes all moving bones alike.
const EVENNESS: f64 = 0.5;

/// How many times its fraction a bone may take. The promise holds for any, as bones below take what is left. Bones
/// seldom miss all of their fractions at once: of 1, 1.6, 2.5 and 4, 1.6 needs the fewest samples on a walk and a run
/// wherever `uniform` does every 2nd to 4th frame; 1 where it does every 8th.
const FAVOUR: f64 = 1.6;

/// Bounds of the motion that each bone contributes to any point, and the fractions that bones take of the error that is
/// allowed: what [`Gate::Bounded`](crate::animation::Gate::Bounded) decides by.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundTable {
    motion: MotionTable,
    /// The first clip's row of bones above.
    first_above: usize,
    radius: f32,
}

impl BoundTable {
    /// The table of a set's clips. `bone_radii`: for each bone, how far points that follow it alone lie from its origin,
    /// metres. `path`: as instances are sampled; crowds that are sampled otherwise are refused, since nlerp turns faster
    /// than slerp in the middle between two keys.
    ///
    /// # Errors
    /// As [`AnimatedBones::new`]; [`InputError`] for other than one reach a bone, or one that is negative or not finite,
    /// and a table of more than 2²⁷ entries.
    pub fn new(
        skeleton: &Skeleton,
        set: &ClipSet,
        clips: &[&Clip],
        bone_radii: &[f32],
        path: RotationPath,
    ) -> Result<Self, InputError> {
        let (motion, order) = MotionTable::new(skeleton, set, clips, bone_radii, path, clips.len())?;
        let mut table = Self { motion, first_above: rows_of(set), radius: 0.0 };
        let mut all = Vec::with_capacity(clips.len());
        for (entry, clip) in set.clips().iter().zip(clips) {
            let motions = motions(set, entry, clip, path);
            let mut columns = columns(&motions, &bounding_levers(skeleton, &motions, bone_radii));
            distribute_budget(skeleton, &mut columns);
            all.push(columns);
            let whole = subtree_radii(skeleton, &motions, bone_radii);
            let roots = skeleton.bones().iter().enumerate().filter(|(_, bone)| bone.parent.is_none());
            let radius = roots
                .map(|(root, _)| motions[root].translation + motions[root].scale * whole[root])
                .fold(0.0, f64::max);
            table.radius = table.radius.max(radius as f32 * 1.000_001);
        }
        table.motion.fill(&order, set, &all)?;
        for clip in 0..set.clips().len() as u32 {
            table.write_tree(skeleton, &order, clip);
        }
        Ok(table)
    }

    /// Writes the parent of each bone, skipping bones that the clip does not move.
    fn write_tree(&mut self, skeleton: &Skeleton, order: &Order, clip: u32) {
        let slot_of = order.slots_of_bones();
        let parent = |bone: u32| skeleton.bones()[bone as usize].parent;
        let stride = self.motion.stride();
        let first = (self.first_above + clip as usize) * stride;
        let MotionTable { animated_bones, rows, .. } = &mut self.motion;
        let last = animated_bones.last_row(clip) as usize * stride;
        let mut before = None;
        for slot in animated_bones.slots(clip) {
            let bones_above = std::iter::successors(parent(order.slots[slot].bone), |bone| parent(*bone));
            let above = bones_above
                .map(|bone| slot_of[bone as usize])
                .find(|slot| animated_bones.contains(clip, *slot));
            rows[first + slot][0] = above.map_or(NO_PARENT, |above| above as u32);
            if above.is_none() || above != before {
                rows[last + slot][1] |= ErrorBudget::STARTS;
                if let Some(above) = above {
                    rows[last + above][1] |= ErrorBudget::REMAINING;
                }
            }
            before = Some(slot);
        }
    }

    /// Which bones the clips move.
    pub fn animated_bones(&self) -> &AnimatedBones {
        &self.motion.animated_bones
    }

    /// The path between rotation keys whose motion it holds.
    pub fn path(&self) -> RotationPath {
        self.motion.path
    }

    /// The entries, row by row: a sum of motion at the row's time and its rise to the next. In a clip's last row stand its
    /// sum over the whole clip, and an [`ErrorBudget`]. Behind all others is one row a clip more: for each slot that the
    /// clip moves, the next slot above it that the clip moves, or [`NO_PARENT`].
    pub fn rows(&self) -> &[[u32; 2]] {
        &self.motion.rows
    }

    /// A bound of how far any point lies from the model's origin in any clip, metres.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// [`Lod::allowed`](crate::animation::Lod::allowed) for an error in metres in the model's space: divide metres in the
    /// world by the instance's scale.
    pub fn units(&self, metres: f32) -> u32 {
        // The motion of a whole clip is less than `EVERYTHING`.
        (f64::from(metres) / self.motion.unit).clamp(0.0, f64::from(EVERYTHING - 1)).floor() as u32
    }

    /// The first clip's row of bones above.
    #[cfg(feature = "gpu")]
    pub(crate) fn first_above(&self) -> u32 {
        self.first_above as u32
    }

    /// The motion of a slot in a row.
    pub(crate) fn motion(&self, row: u32, slot: usize) -> [u32; 2] {
        self.motion.motion(row, slot)
    }

    /// A slot's motion along a whole clip, and what it may miss.
    pub(crate) fn of_clip(&self, clip: u32, slot: usize) -> (u32, ErrorBudget) {
        let [period, granted] = self.motion.of_clip(clip, slot);
        (period, ErrorBudget(granted))
    }

    /// The next slot above one that a clip moves, of those that the clip moves.
    pub(crate) fn above(&self, clip: u32, slot: usize) -> Option<usize> {
        let [above, _] = self.motion.motion(self.first_above as u32 + clip, slot);
        (above != NO_PARENT).then_some(above as usize)
    }
}

/// How much of the allowed error a bone may take, as the kernel reads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ErrorBudget(pub u32);

impl ErrorBudget {
    /// Set if the bone above is not the previous one in the order.
    const STARTS: u32 = 1 << 5;
    /// Set if what the bone leaves is needed later.
    const REMAINING: u32 = 1 << 6;

    /// `quantization_slack` is a power of two, or 0.
    pub(super) fn new(fraction: f64, quantization_slack: u32) -> Self {
        let bits = u32::BITS - quantization_slack.leading_zeros();
        Self(((fraction * 65536.0).floor() as u32) << 8 | bits)
    }

    /// The fraction of what the bones above leave, in 65536ths.
    pub fn fraction(self) -> u32 {
        self.0 >> 8
    }

    /// The number of units that rounding may hide.
    pub fn quantization_slack(self) -> u32 {
        ((1_u64 << (self.0 & 31)) >> 1) as u32
    }

    /// Whether the bone above is not the previous one in the order.
    pub fn starts(self) -> bool {
        self.0 & Self::STARTS != 0
    }
}

/// Gives each bone its fraction of what the bones above it leave.
fn distribute_budget(skeleton: &Skeleton, columns: &mut [Column]) {
    let rates: Vec<f64> = columns.iter().map(|column| column.total().powf(EVENNESS)).collect();
    for (column, fraction) in columns.iter_mut().zip(budget_fractions(skeleton, &rates)) {
        column.fraction = (FAVOUR * fraction).min(1.0);
    }
}
