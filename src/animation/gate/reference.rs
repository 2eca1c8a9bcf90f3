//! Gates: the CPU reference of `kernels/animation/gate.wgsl`.

use crate::animation::budget::reference::budget;
use crate::animation::clip_clock::{ClipClock, UpdateReason};
use crate::animation::gate::{Frame, Gate};
use crate::animation::gate_table::sums::{motion_at, motion_between, scale_by_fraction};
use crate::animation::gate_table::{AnimatedBones, BoundTable, EVERYTHING, PriorityTable, bits_of};
use crate::animation::lod::{Lod, OMEGA_ONE};
use crate::shared::animation::gate::{SCRAMBLE_FIRST, SCRAMBLE_SECOND};

/// Bones that a gate chose to sample.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ChosenBones {
    /// One bit per slot of each instance, in [`AnimatedBones::words`] words per instance. A bit is set if the slot's bone is
    /// sampled.
    pub bits: Vec<u32>,
    /// Subset of `bits` that is sampled ahead of the frame's time, in the same layout.
    pub ahead: Vec<u32>,
}

impl ChosenBones {
    /// Concatenates `bits` and `ahead`, as at the beginning of `Active::bits`.
    pub fn words(&self) -> Vec<u32> {
        [self.bits.as_slice(), &self.ahead].concat()
    }
}

/// Chooses the bones to sample. For each slot of each instance, `sampled` holds the accumulated motion at the time of the slot's
/// last sample. Only [`Gate::Bounded`] and [`Gate::Budget`] use `sampled`.
///
/// # Panics
/// If `lods` or `sampled` is too short for the clip clocks.
pub fn gate(
    gate: &Gate,
    frame: &Frame,
    lods: &[Lod],
    clip_clocks: &[ClipClock],
    sampled: &mut [u32],
) -> ChosenBones {
    match gate {
        Gate::Off(bones) => thinned(bones, lods, clip_clocks, |word| word.candidates),
        Gate::SkipPeriod { table, period } => thinned(table.animated_bones(), lods, clip_clocks, |word| {
            by_priority(table, word, frame, *period)
        }),
        Gate::Uniform(bones) => thinned(bones, lods, clip_clocks, |word| all_or_none(word, frame)),
        Gate::Random(bones) => {
            thinned(bones, lods, clip_clocks, |word| at_random(word, bones.bones(), frame))
        }
        Gate::Bounded(table) => bounded(table, lods, clip_clocks, sampled),
        Gate::Budget { table, bones } => {
            let bits = budget(table, *bones, lods, clip_clocks, sampled);
            ChosenBones { ahead: vec![0; bits.len()], bits }
        }
    }
}

/// Up to 32 bones of an instance: the bones of one word of bits.
struct Word<'a> {
    instance: u32,
    /// Slot of the word's first bone.
    first: usize,
    lod: &'a Lod,
    clip_clock: &'a ClipClock,
    /// Mask with a bit for each existing bone of the word.
    all: u32,
    /// Mask of the bones that the gate may have to sample.
    candidates: u32,
    /// Mask of the candidates that no gate skips.
    always: u32,
}

/// Splits the bones of one instance into words of 32.
fn words<'a>(
    bones: &'a AnimatedBones,
    instance: usize,
    lod: &'a Lod,
    clip_clock: &'a ClipClock,
) -> impl Iterator<Item = Word<'a>> {
    let tier = lod.tier as usize;
    bones.of_tier(tier, clip_clock.clip).iter().enumerate().map(move |(word, moving)| {
        let all = bones.all(tier)[word];
        let candidates = if clip_clock.reason() == UpdateReason::Blended { all } else { *moving };
        let always = candidates & bones.always(tier)[word];
        Word { instance: instance as u32, first: 32 * word, lod, clip_clock, all, candidates, always }
    })
}

/// Decides on each word separately. `thin` selects bones from a word's candidates. At full detail, `thin` is not called and all
/// candidates are selected.
fn thinned(
    bones: &AnimatedBones,
    lods: &[Lod],
    clip_clocks: &[ClipClock],
    thin: impl Fn(&Word<'_>) -> u32,
) -> ChosenBones {
    let mut chosen = ChosenBones::default();
    for (instance, (clip_clock, lod)) in clip_clocks.iter().zip(lods).enumerate() {
        chosen.bits.extend(words(bones, instance, lod, clip_clock).map(|word| match clip_clock.reason() {
            UpdateReason::Hidden => 0,
            UpdateReason::Forced => word.all,
            _ if lod.omega >= OMEGA_ONE => word.candidates,
            _ => thin(&word) | word.always,
        }));
    }
    chosen.ahead.resize(chosen.bits.len(), 0);
    chosen
}

/// Chooses bones by the rule of [`Gate::Bounded`].
fn bounded(table: &BoundTable, lods: &[Lod], clip_clocks: &[ClipClock], sampled: &mut [u32]) -> ChosenBones {
    let mut chosen = ChosenBones::default();
    let bones = table.animated_bones();
    let mut by_slot = vec![0; bones.bones()];
    for (instance, (clip_clock, lod)) in clip_clocks.iter().zip(lods).enumerate() {
        let mut remaining = Remaining { last: 0, by_slot: &mut by_slot };
        for word in words(bones, instance, lod, clip_clock) {
            let [active, ahead] = match clip_clock.reason() {
                UpdateReason::Hidden => [0; 2],
                _ => by_motion(table, &word, &mut sampled[instance * bones.bones()..], &mut remaining),
            };
            chosen.bits.push(active);
            chosen.ahead.push(ahead);
        }
    }
    chosen
}

/// Hashes a 32-bit word with the function "lowbias32" (Wellons 2018).
pub fn scramble(word: u32) -> u32 {
    let mixed = (word ^ (word >> 16)).wrapping_mul(SCRAMBLE_FIRST);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(SCRAMBLE_SECOND);
    mixed ^ (mixed >> 15)
}

/// Returns whether the rule of thesis A skips this update: one update per period. If the period is no longer than a frame, every
/// update is skipped. Otherwise, an update is skipped if the clock passes a multiple of the period in that frame.
pub fn is_skipped(period: u32, ticks: u32, frame_ticks: u32) -> bool {
    period <= frame_ticks || ticks % period < frame_ticks
}

fn by_priority(table: &PriorityTable, word: &Word<'_>, frame: &Frame, longest: u32) -> u32 {
    let ticks = frame.ticks.wrapping_add(scramble(word.instance) & 0xffff);
    let is_active = |bit: &usize| {
        let level = (table.priority(word.clip_clock.row, word.first + bit) * word.lod.omega) >> 16;
        let period = (longest >> 16) * level + (((longest & 0xffff) * level) >> 16);
        !is_skipped(period, ticks, frame.frame_ticks)
    };
    bits_of(word.candidates).filter(is_active).map(|bit| 1 << bit).sum()
}

fn all_or_none(word: &Word<'_>, frame: &Frame) -> u32 {
    let frame = frame.frame.wrapping_add(scramble(word.instance)) & 0xffff;
    let omega = word.lod.omega;
    let is_due = (frame * omega) >> 16 != ((frame + 1) * omega) >> 16;
    if is_due { word.candidates } else { 0 }
}

fn at_random(word: &Word<'_>, bones: usize, frame: &Frame) -> u32 {
    let first = scramble(frame.frame)
        .wrapping_add(word.instance.wrapping_mul(bones as u32))
        .wrapping_add(word.first as u32);
    let is_active = |bit: &usize| scramble(first.wrapping_add(*bit as u32)) >> 16 < word.lod.omega;
    bits_of(word.candidates).filter(is_active).map(|bit| 1 << bit).sum()
}

/// Error budget that remains while the bones of an instance are decided in order.
struct Remaining<'a> {
    /// Budget left by the previous bone in the order.
    last: u32,
    /// Budget left by each bone, by slot. Later children of the bone read it.
    by_slot: &'a mut [u32],
}

/// Chooses the bones of a word to sample, parents first. Returns two masks: the bones that are sampled, and the bones among them
/// that are sampled ahead.
///
/// A bone may use its fraction of the remaining budget. If its missed motion is within the fraction, the bone is not sampled, and
/// the missed motion is subtracted from the budget. Otherwise the bone is sampled and subtracts nothing. A sampled bone is
/// sampled ahead if its motion until the look-ahead time is within the fraction. In this case, that motion is subtracted from the
/// budget.
fn by_motion(
    table: &BoundTable,
    word: &Word<'_>,
    sampled: &mut [u32],
    remaining: &mut Remaining<'_>,
) -> [u32; 2] {
    let Word { first, lod, clip_clock, all, candidates, always, .. } = *word;
    // Accumulated motion describes a single clip, so forced or blended instances cannot use it and sample all bones. If no motion
    // may be missed, all candidates are sampled.
    let asked = if clip_clock.reason().forces_motion() { all } else { always };
    let forced = asked | if lod.allowed == 0 { candidates } else { 0 };
    let [mut active, mut ahead] = [forced, 0];
    for bit in bits_of(candidates | forced) {
        let slot = first + bit;
        let (period, budget) = table.of_clip(clip_clock.clip, slot);
        if budget.starts() {
            remaining.last = match table.above(clip_clock.clip, slot) {
                None => lod.allowed.min(EVERYTHING - 1),
                Some(above) => remaining.by_slot[above],
            };
        }
        let granted = scale_by_fraction(remaining.last, budget.fraction());
        let now = motion_at(table.motion(clip_clock.row, slot), clip_clock.fraction());
        let missed = motion_between(now, sampled[slot], period) + budget.quantization_slack();
        let is_forced = forced >> bit & 1 != 0;
        if is_forced || missed > granted {
            active |= 1 << bit;
            sampled[slot] = now;
            let later = motion_at(table.motion(clip_clock.ahead_row, slot), clip_clock.ahead_fraction);
            let early = motion_between(later, now, period) + budget.quantization_slack();
            if clip_clock.is_ahead() && !is_forced && early <= granted {
                ahead |= 1 << bit;
                sampled[slot] = later;
                remaining.last -= early;
            }
        } else {
            remaining.last -= missed;
        }
        remaining.by_slot[slot] = remaining.last;
    }
    [active, ahead]
}
