//! Table of upper bounds on the motion that a stale bone misses.

use super::columns::{Column, columns};
use super::motion::MotionTable;
use super::{AnimatedBones, EVERYTHING, rows_of};
use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::motion::{bounding_levers, budget_fractions, motions, subtree_radii};
use crate::animation::order::Order;
use crate::asset::clip::Clip;
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;
use crate::shared::animation::gate;
use crate::shared::animation::gate_state::FRACTION_ONE;
use crate::shared::animation::order::NO_PARENT;

/// Exponent applied to each bone's rate of motion when the error budget is divided into fractions. If no bone could use budget
/// that others leave, the exponent 1 would need the fewest samples. The exponent 0 treats all animated bones as equally fast.
const EVENNESS: f64 = 0.5;

/// Factor by which a bone may exceed its fraction of the budget. The error bound holds for any factor, because the bones below
/// get only the budget that remains. A factor above 1 helps because bones seldom miss their whole fraction at the same time.
///
/// The factors 1, 1.6, 2.5 and 4 were compared on a walk and a run, at the error that the gate `uniform` causes. If `uniform`
/// samples every 2nd to 4th frame, the factor 1.6 needs the fewest samples. If it samples every 8th frame, the factor 1 does.
const FAVOUR: f64 = 1.6;

/// Table of [`Gate::Bounded`](crate::animation::Gate::Bounded): upper bounds on the motion that each bone adds to any point, and
/// each bone's fraction of the error budget.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundTable {
    motion: MotionTable,
    /// Index of the first clip's row of parents. A row of parents has, per slot, the nearest ancestor slot that the clip moves.
    first_above: usize,
    radius: f32,
}

impl BoundTable {
    /// Computes the table for a set of clips. `bone_radii` gives, for each bone, the largest distance in metres from its origin
    /// to a point that follows only this bone. `path` is the rotation path that instances are sampled with. Crowds with another
    /// path are refused, because nlerp turns faster than slerp midway between two keys.
    ///
    /// # Errors
    /// [`InputError`] in these cases:
    ///
    /// - [`AnimatedBones::new`] refuses the skeleton, set or clips;
    /// - there is not one radius per bone, or a radius is negative or not finite;
    /// - the table would have more than 2²⁷ entries.
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
            (0..skeleton.tiers()).for_each(|tier| table.write_tree(skeleton, &order, tier, clip));
        }
        Ok(table)
    }

    /// Writes the row of parents of a clip, for one tier: for each animated slot, the nearest ancestor slot that the clip moves.
    fn write_tree(&mut self, skeleton: &Skeleton, order: &Order, tier: usize, clip: u32) {
        let slot_of = order.slots_of_bones();
        let parent = |bone: u32| skeleton.bones()[bone as usize].parent;
        let stride = self.motion.stride();
        let first = (self.first_above + clip as usize) * stride;
        let MotionTable { animated_bones, rows, .. } = &mut self.motion;
        let last = animated_bones.last_row(clip) as usize * stride;
        let mut before = None;
        for slot in animated_bones.slots(tier, clip) {
            let bones_above = std::iter::successors(parent(order.slots[slot].bone), |bone| parent(*bone));
            let above = bones_above
                .map(|bone| slot_of[bone as usize])
                .find(|slot| animated_bones.contains(tier, clip, *slot));
            rows[first + slot][0] = above.map_or(NO_PARENT, |above| above as u32);
            if above.is_none() || above != before {
                rows[last + slot][1] |= BoneErrorBudget::STARTS;
                if let Some(above) = above {
                    rows[last + above][1] |= BoneErrorBudget::REMAINING;
                }
            }
            before = Some(slot);
        }
    }

    /// Table of the bones that each clip moves.
    pub fn animated_bones(&self) -> &AnimatedBones {
        &self.motion.animated_bones
    }

    /// Mutable form of [`BoundTable::animated_bones`].
    pub(crate) fn animated_bones_mut(&mut self) -> &mut AnimatedBones {
        &mut self.motion.animated_bones
    }

    /// Rotation path that the motion was computed for.
    pub fn path(&self) -> RotationPath {
        self.motion.path
    }

    /// Table entries, row by row. Each entry is the accumulated motion at the row's time and its increase until the next row. In
    /// a clip's last row, the entry is the motion of the whole clip and a [`BoneErrorBudget`]. After the rows of all clips, one
    /// row per clip follows. For each slot that the clip moves, it gives the nearest ancestor slot that the clip moves, or
    /// `u32::MAX` if there is none.
    pub fn rows(&self) -> &[[u32; 2]] {
        &self.motion.rows
    }

    /// Upper bound, in metres, on the distance of any point from the model's origin in any clip.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Converts a distance in model space, in metres, to the unit of [`Lod::allowed`](crate::animation::Lod::allowed). Divide a
    /// distance in world space by the instance's scale first.
    pub fn units(&self, metres: f32) -> u32 {
        // The motion of a whole clip is below `EVERYTHING`, so the clamp changes no decision.
        (f64::from(metres) / self.motion.unit).clamp(0.0, f64::from(EVERYTHING - 1)).floor() as u32
    }

    /// Size of one unit of [`BoundTable::units`], in metres of model space.
    pub fn unit(&self) -> f32 {
        self.motion.unit as f32
    }

    /// Index of the first clip's row of parents. A row of parents has, per slot, the nearest ancestor slot that the clip moves.
    #[cfg(feature = "gpu")]
    pub(crate) fn first_above(&self) -> u32 {
        self.first_above as u32
    }

    /// Accumulated motion of a slot at a row, and its increase until the next row.
    pub(crate) fn motion(&self, row: u32, slot: usize) -> [u32; 2] {
        self.motion.motion(row, slot)
    }

    /// Motion of a slot over a whole clip, and the slot's error budget.
    pub(crate) fn of_clip(&self, clip: u32, slot: usize) -> (u32, BoneErrorBudget) {
        let [period, granted] = self.motion.of_clip(clip, slot);
        (period, BoneErrorBudget(granted))
    }

    /// Nearest ancestor slot that the clip moves. `slot` must be a slot that the clip moves.
    pub(crate) fn above(&self, clip: u32, slot: usize) -> Option<usize> {
        let [above, _] = self.motion.motion(self.first_above as u32 + clip, slot);
        (above != NO_PARENT).then_some(above as usize)
    }
}

/// A bone's fraction of the error budget and the bone's quantization slack, packed into one word for the kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoneErrorBudget(pub u32);

impl BoneErrorBudget {
    /// Flag: the nearest animated ancestor is not the previous animated bone in the order.
    const STARTS: u32 = gate::STARTS;
    /// Flag: a later bone reads the budget that this bone leaves.
    const REMAINING: u32 = gate::REMAINING;

    /// Packs a fraction from 0 to 1, and a quantization slack in units of motion. The slack must be a power of two or 0.
    pub(super) fn new(fraction: f64, quantization_slack: u32) -> Self {
        let bits = u32::BITS - quantization_slack.leading_zeros();
        Self(((fraction * f64::from(FRACTION_ONE)).floor() as u32) << gate::BUDGET_FRACTION_SHIFT | bits)
    }

    /// Fraction of the budget left by the bone's ancestors, in 1/65536.
    pub fn fraction(self) -> u32 {
        self.0 >> gate::BUDGET_FRACTION_SHIFT
    }

    /// Motion that rounding may hide, in units of the table. It is added to the missed motion.
    pub fn quantization_slack(self) -> u32 {
        ((1_u64 << (self.0 & gate::BUDGET_SLACK_MASK)) >> 1) as u32
    }

    /// Returns whether the nearest animated ancestor differs from the previous animated bone in the order.
    pub fn starts(self) -> bool {
        self.0 & Self::STARTS != 0
    }
}

/// Sets each bone's fraction of the error budget that the bone's ancestors leave. The fractions follow from the bones' rates of
/// motion.
fn distribute_budget(skeleton: &Skeleton, columns: &mut [Column]) {
    let rates: Vec<f64> = columns.iter().map(|column| column.path.total().powf(EVENNESS)).collect();
    for (column, fraction) in columns.iter_mut().zip(budget_fractions(skeleton, &rates)) {
        column.fraction = (FAVOUR * fraction).min(1.0);
    }
}
