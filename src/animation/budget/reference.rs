//! Selection of bones within a budget: the CPU reference of `kernels/animation/budget.wgsl`.

use crate::animation::clip_clock::{ClipClock, UpdateReason};
use crate::animation::gate_table::ExpectationTable;
use crate::animation::gate_table::sums::{motion_at, motion_between};
use crate::animation::lod::Lod;

/// Returns the selected bones as one bit per slot, in [`AnimatedBones::words`](crate::animation::AnimatedBones::words) words per
/// instance. For each slot of each instance, `sampled` holds the accumulated motion at the time of the slot's last sample.
///
/// # Panics
/// If `lods` or `sampled` is too short for the clip clocks.
pub fn budget(
    table: &ExpectationTable,
    budget: u32,
    lods: &[Lod],
    clip_clocks: &[ClipClock],
    sampled: &mut [u32],
) -> Vec<u32> {
    let animated = table.animated_bones();
    let (bones, words) = (animated.bones(), animated.words());
    let mut chosen = Vec::new();
    let mut ranked: Vec<(u32, usize)> = Vec::new();
    let is_unlimited = budget as usize >= clip_clocks.len() * bones;
    for (instance, (clip_clock, lod)) in clip_clocks.iter().zip(lods).enumerate() {
        let first = instance * bones;
        let tier = lod.tier as usize;
        let is_set = |bits: &[u32], slot: usize| bits[slot / 32] >> (slot % 32) & 1 != 0;
        if clip_clock.reason().forces_motion() {
            let all = (0..bones).filter(|slot| is_set(animated.all(tier), *slot));
            chosen.extend(all.map(|slot| first + slot));
        }
        if clip_clock.reason() != UpdateReason::Free {
            continue;
        }
        for slot in animated.slots(tier, clip_clock.clip) {
            if is_set(animated.always(tier), slot) {
                chosen.push(first + slot);
                continue;
            }
            let missed = missed_by(table, clip_clock, slot, sampled[first + slot]);
            if missed > 0 || is_unlimited {
                ranked.push((rank_of(missed, lod.weight), first + slot));
            }
        }
    }
    let room = (budget as usize).saturating_sub(chosen.len());
    // The sort is stable: equal ranks stay in order.
    ranked.sort_by_key(|(rank, _)| std::cmp::Reverse(*rank));
    chosen.extend(ranked.iter().take(room).map(|(_, at)| *at));
    let mut bits = vec![0; clip_clocks.len() * words];
    for at in chosen {
        let (instance, slot) = (at / bones, at % bones);
        bits[instance * words + slot / 32] |= 1 << (slot % 32);
        sampled[at] = motion_now(table, &clip_clocks[instance], slot);
    }
    bits
}

fn motion_now(table: &ExpectationTable, clip_clock: &ClipClock, slot: usize) -> u32 {
    motion_at(table.motion(clip_clock.row, slot), clip_clock.fraction())
}

fn missed_by(table: &ExpectationTable, clip_clock: &ClipClock, slot: usize, last: u32) -> u32 {
    motion_between(motion_now(table, clip_clock, slot), last, table.period(clip_clock.clip, slot))
}

/// Rank from 1 to 768: the logarithm of `missed · weight`, with sixteen ranks per octave. The function uses a 64-bit product and
/// its own constants, so that it independently checks the two-word arithmetic of the kernel.
pub fn rank_of(missed: u32, weight: u32) -> u32 {
    let product = u64::from(missed) * u64::from(weight);
    let Some(lead) = product.checked_ilog2() else { return 1 };
    let fine = if lead >= 4 { product >> (lead - 4) } else { product << (4 - lead) };
    1 + 16 * lead + (fine & 15) as u32
}
