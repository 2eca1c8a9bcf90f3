//! Tables of gates: data about the bones of clips, computed once at load time. Columns are slots of an
//! [`Order`]. Rows are the common times of each clip, one clip after another, with one more row per clip.

use super::clip_set::ClipSet;
use super::motion::{
    BoneMotion, Path, bounding_levers, budget_fractions, motions, subtree_radii, typical_levers,
};
use super::priority::Priorities;
use crate::InputError;
use crate::animation::order::{NO_PARENT, Order};
use crate::asset::clip::{Clip, Interpolation, Part};
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;
use crate::shared::animation::gate;
pub(crate) use crate::shared::animation::gate::EVERYTHING;

/// The largest sum of motion over a whole clip, in units of the table.
const MAX_MOTION: f64 = EVERYTHING as f64;

/// The exponent of the rates of motion in the fractions of the error budget. With 1, the fewest samples are
/// needed if fractions alone decide; with 0, all moving bones get equal fractions.
const EVENNESS: f64 = 0.5;

/// The factor by which a bone may exceed its fraction. The bound holds for any factor, because bones below use
/// what is left. Bones seldom miss all of their fractions at once: of 1, 1.6, 2.5 and 4, the factor 1.6 needs
/// the fewest samples on a walk and a run if `uniform` samples every 2nd to 4th frame, and 1 if it samples
/// every 8th.
const FAVOUR: f64 = 1.6;

/// The largest number of entries.
const MAX_ENTRIES: usize = 1 << 27;

/// The kind of data in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// [`GateTable::of_animated_bones`].
    AnimatedBones,
    /// [`GateTable::of_priorities`].
    Priorities,
    /// [`GateTable::of_bounds`].
    Bounds,
    /// [`GateTable::of_expectations`].
    Expectations,
}

#[cfg(feature = "gpu")]
impl Kind {
    /// Refuses a table of another kind than `needed`.
    pub(crate) fn check(self, needed: Self) -> Result<(), InputError> {
        if self == needed {
            return Ok(());
        }
        Err(InputError::new("table.kind", format!("{self:?}"), format!("must be {needed:?} for this gate")))
    }
}

/// Refuses sampling with another rotation path than the one for which a table's motion was computed. Tables
/// without motion permit any.
pub(crate) fn check_path(of_table: Option<RotationPath>, sampled: RotationPath) -> Result<(), InputError> {
    match of_table {
        Some(path) if path != sampled => {
            let bound = format!("must be {path:?}, the path whose motion the gate's table holds");
            Err(InputError::new("crowd.path", format!("{sampled:?}"), bound))
        }
        _ => Ok(()),
    }
}

/// A gate's table.
#[derive(Debug, Clone, PartialEq)]
pub struct GateTable {
    kind: Kind,
    /// The rotation path of the motion; `None` without motion.
    path: Option<RotationPath>,
    bones: usize,
    words: usize,
    stride: usize,
    animated_bones: Vec<u32>,
    rows: Vec<[u32; 2]>,
    /// Metres (or what the table's motion measures) per unit; 0 without motion.
    unit: f64,
    radius: f32,
    /// The first clip's row of parents; only in tables of bounds.
    first_above: usize,
}

impl GateTable {
    /// A table of the bones that each clip moves, for [`Gate::Off`](super::gate::Gate::Off), `Uniform` and
    /// `Random`.
    ///
    /// # Errors
    /// [`InputError`] for clips other than the set's, and for a skeleton with another number of bones.
    pub fn of_animated_bones(order: &Order, set: &ClipSet, clips: &[&Clip]) -> Result<Self, InputError> {
        set.check_clips(clips)?;
        if order.slots.len() != set.bones() {
            let bound = format!("must be {}, as the clips'", set.bones());
            return Err(InputError::new("skeleton.len", order.slots.len(), bound));
        }
        let words = order.words();
        let mut animated_bones = Vec::with_capacity(clips.len() * (words + 1));
        for (entry, clip) in set.clips().iter().zip(clips) {
            animated_bones.push(entry.first_row + set.rows(entry) - 1);
            let first = animated_bones.len();
            animated_bones.resize(first + words, 0);
            for (at, slot) in order.slots.iter().enumerate() {
                animated_bones[first + at / 32] |= u32::from(moves(clip, slot.bone as usize)) << (at % 32);
            }
        }
        let bones = order.slots.len();
        let kind = Kind::AnimatedBones;
        Ok(Self {
            kind,
            path: None,
            bones,
            words,
            stride: 0,
            animated_bones,
            rows: vec![[0; 2]],
            unit: 0.0,
            radius: 0.0,
            first_above: 0,
        })
    }

    /// A table of each clip's priorities, for [`Gate::SkipPeriod`](super::gate::Gate::SkipPeriod). Before a
    /// bone's first key, the priority of that key counts.
    ///
    /// # Errors
    /// As [`GateTable::of_animated_bones`]; also for a number of priorities that is not one set per clip, and
    /// for a table of more than 2²⁷ entries.
    pub fn of_priorities(
        order: &Order,
        set: &ClipSet,
        clips: &[&Clip],
        priorities: &[Priorities],
    ) -> Result<Self, InputError> {
        let mut table = Self::of_animated_bones(order, set, clips)?;
        if priorities.len() != clips.len() {
            let bound = format!("must be {}, one a clip", clips.len());
            return Err(InputError::new("priorities.len", priorities.len(), bound));
        }
        table.kind = Kind::Priorities;
        table.make_room(set, table.bones.div_ceil(4))?;
        for (entry, priorities) in set.clips().iter().zip(priorities) {
            for (slot, bone) in order.slots.iter().enumerate() {
                let keys = priorities.of(bone.bone as usize);
                for (row, time) in (entry.first_row as usize..).zip(set.common_times(entry)) {
                    let key = keys.partition_point(|key| key.time <= *time).saturating_sub(1);
                    let priority = keys.get(key).map_or(0.0, |key| key.priority);
                    let four = &mut table.rows[row * table.stride + slot / 4];
                    four[slot / 2 % 2] |=
                        ((priority.clamp(0.0, 1.0) * 65535.0).round() as u32) << (16 * (slot % 2));
                }
            }
        }
        Ok(table)
    }

    /// A table of bounds on the motion that each bone contributes to any point, and of the fractions of the
    /// error budget that bones take, for [`Gate::Bounded`](super::gate::Gate::Bounded). `bone_radii` gives, for
    /// each bone, the distance from its origin, in metres, of points that follow it alone. `path` is the
    /// rotation path with which instances are sampled; crowds with another path are refused, because nlerp
    /// turns faster than slerp in the middle between two keys.
    ///
    /// # Errors
    /// As [`GateTable::of_animated_bones`]; also for a number of radii that is not one per bone, for radii that
    /// are negative or not finite, and for a table of more than 2²⁷ entries.
    pub fn of_bounds(
        skeleton: &Skeleton,
        set: &ClipSet,
        clips: &[&Clip],
        bone_radii: &[f32],
        path: RotationPath,
    ) -> Result<Self, InputError> {
        let (mut table, order) = Self::with_room((Kind::Bounds, path), skeleton, set, clips, bone_radii)?;
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
        Ok(table.fill(&order, set, &all)?.with_trees(skeleton, &order, set))
    }

    /// A table of the expected motion that each bone contributes to points at and below it, as a root of the
    /// sum of squares, by which [`super::budget`] ranks bones. The arguments are those of
    /// [`GateTable::of_bounds`].
    ///
    /// # Errors
    /// As [`GateTable::of_bounds`].
    pub fn of_expectations(
        skeleton: &Skeleton,
        set: &ClipSet,
        clips: &[&Clip],
        bone_radii: &[f32],
        path: RotationPath,
    ) -> Result<Self, InputError> {
        let (table, order) = Self::with_room((Kind::Expectations, path), skeleton, set, clips, bone_radii)?;
        let levers = typical_levers(skeleton, bone_radii);
        let of = |(entry, clip): (_, &&Clip)| columns(&motions(set, entry, clip, path), &levers);
        let all: Vec<_> = set.clips().iter().zip(clips).map(of).collect();
        table.fill(&order, set, &all)
    }

    /// An empty table with room for motion, and the order of its columns.
    fn with_room(
        (kind, path): (Kind, RotationPath),
        skeleton: &Skeleton,
        set: &ClipSet,
        clips: &[&Clip],
        bone_radii: &[f32],
    ) -> Result<(Self, Order), InputError> {
        let order = Order::new(skeleton);
        let mut table = Self { kind, path: Some(path), ..Self::of_animated_bones(&order, set, clips)? };
        check_bone_radii(skeleton, bone_radii)?;
        table.make_room(set, table.bones)?;
        Ok((table, order))
    }

    /// Writes the columns of every clip, in the smallest unit for which they fit.
    fn fill(mut self, order: &Order, set: &ClipSet, columns: &[Vec<Column>]) -> Result<Self, InputError> {
        for (clip, columns) in columns.iter().enumerate() {
            if let Some(bone) = columns.iter().position(|column| !column.total().is_finite()) {
                let bound = "must be finite: the scales above it are too large";
                return Err(InputError::new(format!("clips[{clip}].bones[{bone}].motion"), "inf", bound));
            }
        }
        let largest = columns.iter().flatten().map(Column::total).fold(0.0, f64::max);
        self.unit = if largest > 0.0 { largest / MAX_MOTION } else { 1.0 };
        for (entry, columns) in set.clips().iter().zip(columns) {
            for (slot, bone) in order.slots.iter().enumerate() {
                let at = entry.first_row as usize * self.stride + slot;
                columns[bone.bone as usize].write(&mut self.rows[at..], self.stride, self.unit);
            }
        }
        Ok(self)
    }

    /// Writes the parent of each bone, skipping bones that the clip does not move.
    fn with_trees(mut self, skeleton: &Skeleton, order: &Order, set: &ClipSet) -> Self {
        let slot_of = order.slots_of_bones();
        let parent = |bone: u32| skeleton.bones()[bone as usize].parent;
        for clip in 0..set.clips().len() as u32 {
            let (last, animated_bones) = self.record(clip);
            let (last, animated_bones) = (last as usize * self.stride, animated_bones.to_vec());
            let moves = |slot: u32| animated_bones[slot as usize / 32] >> (slot % 32) & 1 != 0;
            let first = self.above(clip) as usize * self.stride;
            let mut before = NO_PARENT;
            for slot in (0..self.bones as u32).filter(|slot| moves(*slot)) {
                let bones_above =
                    std::iter::successors(parent(order.slots[slot as usize].bone), |bone| parent(*bone));
                let above = bones_above.map(|bone| slot_of[bone as usize] as u32).find(|slot| moves(*slot));
                self.rows[first + slot as usize][0] = above.unwrap_or(NO_PARENT);
                if above.is_none_or(|above| above != before) {
                    self.rows[last + slot as usize][1] |= ErrorBudget::STARTS;
                    if let Some(above) = above {
                        self.rows[last + above as usize][1] |= ErrorBudget::REMAINING;
                    }
                }
                before = slot;
            }
        }
        self
    }

    fn make_room(&mut self, set: &ClipSet, stride: usize) -> Result<(), InputError> {
        let mut rows: usize = set.clips().iter().map(|entry| set.rows(entry) as usize).sum();
        if self.kind == Kind::Bounds {
            self.first_above = rows;
            rows += set.clips().len();
        }
        match rows.checked_mul(stride).filter(|entries| *entries <= MAX_ENTRIES) {
            Some(entries) => {
                (self.stride, self.rows) = (stride, vec![[0; 2]; entries]);
                Ok(())
            }
            None => {
                let bound = format!(
                    "times {stride} columns must be at most 2^27: let more tracks share their key times"
                );
                Err(InputError::new("table.rows", rows, bound))
            }
        }
    }

    /// The kind of data in the table.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// The rotation path for which the motion was computed, in tables made by [`GateTable::of_bounds`] and
    /// [`GateTable::of_expectations`].
    pub fn path(&self) -> Option<RotationPath> {
        self.path
    }

    /// Number of columns: slots of the skeleton's order.
    pub fn bones(&self) -> usize {
        self.bones
    }

    /// Words of bits per instance.
    pub fn words(&self) -> usize {
        self.words
    }

    /// Entries per row.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// For each clip the index of its last row, then one bit for each slot that it moves.
    pub fn animated_bones(&self) -> &[u32] {
        &self.animated_bones
    }

    /// The entries, row by row: either four priorities of 16 bits, or the sum of motion at the row's time and
    /// its rise to the next row. A clip's last row holds the sum over the whole clip and, in a table of bounds,
    /// an [`ErrorBudget`]. Such a table has one more row per clip after all others; see [`GateTable::above`].
    pub fn rows(&self) -> &[[u32; 2]] {
        &self.rows
    }

    /// The index of a clip's last row, and the slots that the clip moves.
    pub fn record(&self, clip: u32) -> (u32, &[u32]) {
        let record = &self.animated_bones[clip as usize * (self.words + 1)..][..self.words + 1];
        (record[0], &record[1..])
    }

    /// The priority of a slot in a row, in 65536ths.
    pub fn priority(&self, row: u32, slot: usize) -> u32 {
        self.rows[row as usize * self.stride + slot / 4][slot / 2 % 2] >> (16 * (slot % 2)) & 0xffff
    }

    /// The motion of a slot in a row.
    pub fn motion(&self, row: u32, slot: usize) -> [u32; 2] {
        self.rows[row as usize * self.stride + slot]
    }

    /// The index of a row that gives, for each slot that a clip moves, the nearest slot above it that the clip
    /// moves, or [`NO_PARENT`]; in tables made by [`GateTable::of_bounds`].
    pub fn above(&self, clip: u32) -> u32 {
        self.first_above as u32 + clip
    }

    /// A bound on the distance of any point from the model's origin in any clip, in metres; in tables made by
    /// [`GateTable::of_bounds`].
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Converts a distance in metres in the model's space to [`Lod::allowed`](super::lod::Lod::allowed); divide
    /// metres in the world by the instance's scale. The result is 0 for a table that was not made by
    /// [`GateTable::of_bounds`].
    pub fn units(&self, metres: f32) -> u32 {
        if self.kind != Kind::Bounds {
            return 0;
        }
        // The motion of a whole clip is less than `EVERYTHING`.
        (f64::from(metres) / self.unit).clamp(0.0, f64::from(EVERYTHING - 1)).floor() as u32
    }
}

fn check_bone_radii(skeleton: &Skeleton, bone_radii: &[f32]) -> Result<(), InputError> {
    if bone_radii.len() != skeleton.len() {
        let bound = format!("must be {}, one a bone", skeleton.len());
        return Err(InputError::new("bone_radii.len", bone_radii.len(), bound));
    }
    match bone_radii.iter().position(|bone_radius| !(*bone_radius >= 0.0 && bone_radius.is_finite())) {
        None => Ok(()),
        Some(bone) => {
            let bound = "must be at least 0 and finite";
            Err(InputError::new(format!("bone_radii[{bone}]"), bone_radii[bone], bound))
        }
    }
}

/// The error budget that a clip grants a bone, as the kernel reads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ErrorBudget(pub u32);

impl ErrorBudget {
    /// Set if the bone above is not the previous one in the order.
    const STARTS: u32 = gate::STARTS;
    /// Set if what the bone leaves is needed later.
    const REMAINING: u32 = gate::REMAINING;

    /// `quantization_slack` is a power of two, or 0.
    fn new(fraction: f64, quantization_slack: u32) -> Self {
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

/// Whether a clip changes any of a bone's parts.
fn moves(clip: &Clip, bone: usize) -> bool {
    Part::ALL.iter().any(|part| {
        let track = clip.track(bone, *part);
        let is_spline = track.interpolation() == Interpolation::CubicSpline;
        let each = if is_spline { 3 } else { 1 };
        let keys = track.keys as usize;
        let values = &clip.values()[track.first_value as usize..][..each * keys];
        let same = |value: [f32; 4], other: [f32; 4]| {
            value == other || *part == Part::Rotation && value == other.map(|component| -component)
        };
        keys > 1
            && values.chunks_exact(each).enumerate().any(|(at, key)| {
                if !is_spline {
                    return !same(key[0], clip.key(track, 0));
                }
                // The in-tangent of the first key and the out-tangent of the last have no effect.
                let bends = |tangent: [f32; 4], is_used: bool| is_used && tangent != [0.0; 4];
                key[1] != clip.key(track, 0) || bends(key[0], at > 0) || bends(key[2], at + 1 < keys)
            })
    })
}

/// The motion of one bone along a clip.
struct Column {
    rises: Vec<f64>,
    jumps: Vec<f64>,
    wrap: f64,
    is_boundless: bool,
    /// The fraction of what the bones above leave, 0 to 1.
    fraction: f64,
}

impl Column {
    fn new(bone: &BoneMotion, levers: &[f64; 3]) -> Self {
        let weighed = |of: &dyn Fn(&Path) -> f64| {
            bone.parts.iter().zip(levers).map(|(part, lever)| lever * of(part)).sum::<f64>()
        };
        let times = bone.parts[0].rises.len();
        Self {
            rises: (0..times).map(|at| weighed(&|path| path.rises[at])).collect(),
            jumps: (0..times).map(|at| weighed(&|path| path.jumps[at])).collect(),
            wrap: weighed(&|path| path.wrap),
            is_boundless: bone.parts.iter().any(|path| path.is_boundless),
            fraction: 0.0,
        }
    }

    fn total(&self) -> f64 {
        self.rises.iter().chain(&self.jumps).sum::<f64>() + self.wrap
    }

    /// Writes the column into a table.
    ///
    /// Sums at row starts are rounded to the nearest unit, rises up, and interpolated sums down, so that the
    /// difference of two sums is at most 4 units too small. Fractions are cut to 16 bits, 2⁻¹⁶ of a segment,
    /// and may be off by the rounding of their division; 2⁻¹² of the steepest segment exceeds both errors for
    /// two sums. The slack for these errors is a power of two.
    /// the steepest stretch is more than either costs for two sums. What rounding may hide so is a power of two.
    fn write(&self, table: &mut [[u32; 2]], stride: usize, unit: f64) {
        let mut sum = 0.0;
        let mut steepest = 0.0_f64;
        for (row, (rise, jump)) in self.rises.iter().zip(&self.jumps).enumerate() {
            sum += jump;
            table[row * stride] = [(sum / unit).round() as u32, (rise / unit).ceil() as u32];
            sum += rise;
            steepest = steepest.max(rise / unit);
        }
        let quantization_slack = match self.is_boundless {
            true => EVERYTHING,
            false if self.total() > 0.0 => (4 + (steepest / 4096.0).ceil() as u32).next_power_of_two(),
            false => 0,
        };
        let error_budget = ErrorBudget::new(self.fraction, quantization_slack);
        table[self.rises.len() * stride] = [(self.total() / unit).ceil() as u32, error_budget.0];
    }
}

fn columns(motions: &[BoneMotion], levers: &[[f64; 3]]) -> Vec<Column> {
    motions.iter().zip(levers).map(|(bone, levers)| Column::new(bone, levers)).collect()
}

/// Gives each bone its fraction of what the bones above it leave.
fn distribute_budget(skeleton: &Skeleton, columns: &mut [Column]) {
    let rates: Vec<f64> = columns.iter().map(|column| column.total().powf(EVENNESS)).collect();
    for (column, fraction) in columns.iter_mut().zip(budget_fractions(skeleton, &rates)) {
        column.fraction = (FAVOUR * fraction).min(1.0);
    }
}
