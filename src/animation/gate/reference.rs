//! Gates: the CPU reference of `kernels/animation/gate.wgsl`.

use crate::animation::clip_clock::{ClipClock, UpdateReason};
use crate::animation::gate::{Frame, Gate};
use crate::animation::gate_table::{EVERYTHING, ErrorBudget, GateTable};
use crate::animation::lod::{Lod, OMEGA_ONE};
use crate::animation::order::NO_PARENT;

/// The bones that are sampled.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Chosen {
    /// One bit per slot of each instance, in [`GateTable::words`] words per instance.
    pub bits: Vec<u32>,
    /// In the same layout: those of them that are sampled ahead.
    pub ahead: Vec<u32>,
}

impl Chosen {
    /// Both in the layout of `Active::bits`.
    pub fn words(&self) -> Vec<u32> {
        [self.bits.as_slice(), &self.ahead].concat()
    }
}

/// The bones that are sampled. `sampled` holds, for each slot of each instance, the sum of motion when it was
/// last sampled; only [`Gate::Bounded`] uses it.
///
/// # Panics
/// If there are fewer levels of detail or sums than clip clocks need, and with a table of a kind that the gate
/// cannot use.
pub fn gate(
    table: &GateTable,
    gate: Gate,
    frame: &Frame,
    lods: &[Lod],
    clip_clocks: &[ClipClock],
    sampled: &mut [u32],
) -> Chosen {
    let mut chosen = Chosen::default();
    let mut remaining = vec![0; table.bones()];
    for (instance, (clip_clock, lod)) in clip_clocks.iter().zip(lods).enumerate() {
        let animated_bones = table.record(clip_clock.clip).1;
        let mut accumulated = AccumulatedMotion { left: 0, remaining: &mut remaining };
        for (word, animated_bones) in animated_bones.iter().enumerate() {
            let at = At { instance: instance as u32, first: 32 * word, bones: table.bones() };
            let all = u32::MAX >> (32 - (table.bones() - at.first).min(32));
            let candidates = if clip_clock.reason() == UpdateReason::Blended { all } else { *animated_bones };
            let mut ahead = 0;
            chosen.bits.push(match (clip_clock.reason(), gate) {
                (UpdateReason::Hidden, _) => 0,
                (reason, Gate::Bounded) => {
                    // Sums of motion describe a single clip, so they cannot be used for other reasons to
                    // update.
                    let forced = if reason.forces_motion() { all } else { 0 };
                    let sampled = &mut sampled[instance * table.bones()..];
                    let [active, early] =
                        by_motion(table, &at, lod, candidates, forced, clip_clock, sampled, &mut accumulated);
                    ahead = early;
                    active
                }
                (UpdateReason::Forced, _) => all,
                (_, Gate::Off) => candidates,
                _ if lod.omega >= OMEGA_ONE => candidates,
                (_, Gate::SkipPeriod { period }) => {
                    by_priority(table, &at, lod, candidates, clip_clock, frame, period)
                }
                (_, Gate::Uniform) => all_or_none(&at, lod, candidates, frame),
                (_, Gate::Random) => at_random(&at, lod, candidates, frame),
            });
            chosen.ahead.push(ahead);
        }
    }
    chosen
}

/// The position of a word.
struct At {
    instance: u32,
    first: usize,
    bones: usize,
}

/// Wellons' "lowbias32".
pub fn scramble(word: u32) -> u32 {
    let mixed = (word ^ (word >> 16)).wrapping_mul(0x21f0_aaad);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x735a_2d97);
    mixed ^ (mixed >> 15)
}

/// The indices of the bits that are set in a word.
pub fn bits_of(word: u32) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(word), |rest| Some(rest & rest.wrapping_sub(1)))
        .take_while(|rest| *rest != 0)
        .map(|rest| rest.trailing_zeros() as usize)
}

/// A's rule skips one update per period: in every frame if a period is no longer than a frame, otherwise in a
/// frame in which the clock passes a multiple of the period.
pub fn is_skipped(period: u32, ticks: u32, frame_ticks: u32) -> bool {
    period <= frame_ticks || ticks % period < frame_ticks
}

fn by_priority(
    table: &GateTable,
    at: &At,
    lod: &Lod,
    candidates: u32,
    clip_clock: &ClipClock,
    frame: &Frame,
    longest: u32,
) -> u32 {
    let ticks = frame.ticks.wrapping_add(scramble(at.instance) & 0xffff);
    let is_active = |bit: &usize| {
        let level = (table.priority(clip_clock.row, at.first + bit) * lod.omega) >> 16;
        let period = (longest >> 16) * level + (((longest & 0xffff) * level) >> 16);
        !is_skipped(period, ticks, frame.frame_ticks)
    };
    bits_of(candidates).filter(is_active).map(|bit| 1 << bit).sum()
}

fn all_or_none(at: &At, lod: &Lod, candidates: u32, frame: &Frame) -> u32 {
    let frame = frame.frame.wrapping_add(scramble(at.instance)) & 0xffff;
    let is_due = (frame * lod.omega) >> 16 != ((frame + 1) * lod.omega) >> 16;
    if is_due { candidates } else { 0 }
}

fn at_random(at: &At, lod: &Lod, candidates: u32, frame: &Frame) -> u32 {
    let first = scramble(frame.frame)
        .wrapping_add(at.instance.wrapping_mul(at.bones as u32))
        .wrapping_add(at.first as u32);
    let is_active = |bit: &usize| scramble(first.wrapping_add(*bit as u32)) >> 16 < lod.omega;
    bits_of(candidates).filter(is_active).map(|bit| 1 << bit).sum()
}

/// What is left of the error budget of an instance.
struct AccumulatedMotion<'a> {
    /// What the previous bone left.
    left: u32,
    /// What bones with several children left.
    remaining: &'a mut [u32],
}

/// Decides for the bones of a word, parents first. A bone that missed no more than its fraction of the
/// remaining budget is not sampled, and passes the rest on to the bones below it. A bone that missed more is
/// sampled, and passes on all of it; or it is sampled ahead, if its motion until then is within its fraction
/// too. Returns the bones that are sampled, and those of them that are sampled ahead.
#[allow(clippy::too_many_arguments, reason = "the shader's own")]
fn by_motion(
    table: &GateTable,
    at: &At,
    lod: &Lod,
    candidates: u32,
    asked: u32,
    clip_clock: &ClipClock,
    sampled: &mut [u32],
    accumulated: &mut AccumulatedMotion<'_>,
) -> [u32; 2] {
    // If nothing may be missed, all bones are forced too.
    let forced = asked | if lod.allowed == 0 { candidates } else { 0 };
    let last_row = table.record(clip_clock.clip).0;
    let [mut active, mut ahead] = [forced, 0];
    for bit in bits_of(candidates | forced) {
        let slot = at.first + bit;
        let [period, granted] = table.motion(last_row, slot);
        let granted = ErrorBudget(granted);
        if granted.starts() {
            accumulated.left = match table.motion(table.above(clip_clock.clip), slot)[0] {
                NO_PARENT => lod.allowed.min(EVERYTHING - 1),
                above => accumulated.remaining[above as usize],
            };
        }
        let own_budget = scale_by_fraction(accumulated.left, granted.fraction());
        let now = motion_at(table.motion(clip_clock.row, slot), clip_clock.fraction());
        let missed = motion_between(now, sampled[slot], period) + granted.quantization_slack();
        let is_forced = forced >> bit & 1 != 0;
        if is_forced || missed > own_budget {
            active |= 1 << bit;
            sampled[slot] = now;
            let later = motion_at(table.motion(clip_clock.ahead_row, slot), clip_clock.ahead_fraction);
            let early = motion_between(later, now, period) + granted.quantization_slack();
            if clip_clock.is_ahead() && !is_forced && early <= own_budget {
                ahead |= 1 << bit;
                sampled[slot] = later;
                accumulated.left -= early;
            }
        } else {
            accumulated.left -= missed;
        }
        accumulated.remaining[slot] = accumulated.left;
    }
    [active, ahead]
}

/// `value · fraction / 65536`; the fraction is at most 65536.
pub fn scale_by_fraction(value: u32, fraction: u32) -> u32 {
    ((u64::from(value) * u64::from(fraction)) >> 16) as u32
}

/// The sum of motion at a time, given the sum at a row's start, its rise to the next row, and the fraction of
/// the way there.
pub fn motion_at([start, rise]: [u32; 2], fraction: u32) -> u32 {
    start.wrapping_add(scale_by_fraction(rise, fraction))
}

/// The smaller difference of two sums: directly, or across the clip's end. `period` is the sum of the whole
/// clip.
pub fn motion_between(now: u32, last: u32, period: u32) -> u32 {
    let direct = now.abs_diff(last);
    direct.min(period.max(direct) - direct)
}
