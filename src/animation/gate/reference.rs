//! Which bones are sampled: reference of `kernels/animation/gate.wgsl`.

use crate::animation::clip_clock::{ClipClock, UpdateReason};
use crate::animation::gate::{Frame, Gate};
use crate::animation::gate_table::{EVERYTHING, ErrorBudget, GateTable};
use crate::animation::lod::{Lod, OMEGA_ONE};
use crate::animation::order::NO_PARENT;

/// What is sampled.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Chosen {
    /// A bit for each slot of each instance: [`GateTable::words`] words an instance.
    pub bits: Vec<u32>,
    /// Likewise, those of them that are sampled ahead.
    pub ahead: Vec<u32>,
}

impl Chosen {
    /// As `Active::bits` holds them.
    pub fn words(&self) -> Vec<u32> {
        [self.bits.as_slice(), &self.ahead].concat()
    }
}

/// The bones that are sampled. `sampled` holds, for each slot of each instance, the sum of motion when it was sampled last; [`Gate::Bounded`] alone uses it.
///
/// # Panics
/// With fewer levels or sums than the phases need, and with a table of another kind than the gate needs.
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
                    // Sums of motion know of one clip alone.
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

/// A word's place.
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

/// The numbers of a word's bits.
pub fn bits_of(word: u32) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(word), |rest| Some(rest & rest.wrapping_sub(1)))
        .take_while(|rest| *rest != 0)
        .map(|rest| rest.trailing_zeros() as usize)
}

/// A skips an update each period: at once where a period is no longer than a frame, else when the last frame has
/// passed a multiple of it.
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

/// What is left of the allowed way of an instance.
struct AccumulatedMotion<'a> {
    /// By the bone before.
    left: u32,
    /// By bones that others hang below.
    remaining: &'a mut [u32],
}

/// Parents first: a bone that missed no more than its share of what is left stays, and leaves the rest to those below it.
/// One that missed more is sampled, and leaves them everything; or it is sampled ahead, where it moves no more than its
/// share until then. What is sampled, and of this, what is sampled ahead.
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
    // So are all where nothing may be missed.
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

/// `value · fraction / 65536`, the fraction at most 65536.
pub fn scale_by_fraction(value: u32, fraction: u32) -> u32 {
    ((u64::from(value) * u64::from(fraction)) >> 16) as u32
}

/// How far a bone has moved along its clip: the sum at a row's start, its rise to the next, and the way there.
pub fn motion_at([start, rise]: [u32; 2], fraction: u32) -> u32 {
    start.wrapping_add(scale_by_fraction(rise, fraction))
}

/// The shorter way between two sums: directly, or over the clip's end. `period`: that of the whole clip.
pub fn motion_between(now: u32, last: u32, period: u32) -> u32 {
    let direct = now.abs_diff(last);
    direct.min(period.max(direct) - direct)
}
