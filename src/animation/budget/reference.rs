//! Which bones are sampled when only so many may be: twin of `kernels/animation/budget.wgsl`.

use crate::animation::gate::reference::{bits_of, motion_at, motion_between};
use crate::animation::gate_table::GateTable;
use crate::animation::lod::Lod;
use crate::animation::phase::{Phase, Verdict};

/// A bit for each slot of each instance: [`GateTable::words`] words an instance. `sampled` holds, for each slot of each
/// instance, the sum of motion when it was sampled last.
///
/// # Panics
/// With fewer levels or sums than the phases need, and with a table without motion.
pub fn budget(
    table: &GateTable,
    budget: u32,
    lods: &[Lod],
    phases: &[Phase],
    sampled: &mut [u32],
) -> Vec<u32> {
    let (bones, words) = (table.bones(), table.words());
    let mut chosen = Vec::new();
    let mut ranked: Vec<(u32, usize)> = Vec::new();
    let is_unlimited = budget as usize >= phases.len() * bones;
    for (instance, (phase, lod)) in phases.iter().zip(lods).enumerate() {
        let first = instance * bones;
        if phase.verdict().forces_motion() {
            chosen.extend(first..first + bones);
        }
        if phase.verdict() != Verdict::Free {
            continue;
        }
        for slot in movers(table, phase) {
            let missed = missed_by(table, phase, slot, sampled[first + slot]);
            if missed > 0 || is_unlimited {
                ranked.push((rank_of(missed, lod.weight), first + slot));
            }
        }
    }
    let room = (budget as usize).saturating_sub(chosen.len());
    // Stable: equal ranks stay in order.
    ranked.sort_by_key(|(rank, _)| std::cmp::Reverse(*rank));
    chosen.extend(ranked.iter().take(room).map(|(_, at)| *at));
    let mut bits = vec![0; phases.len() * words];
    for at in chosen {
        let (instance, slot) = (at / bones, at % bones);
        bits[instance * words + slot / 32] |= 1 << (slot % 32);
        sampled[at] = motion_now(table, &phases[instance], slot);
    }
    bits
}

/// Slots that the phase's clip moves.
fn movers(table: &GateTable, phase: &Phase) -> impl Iterator<Item = usize> {
    let (_, movers) = table.record(phase.clip);
    movers.iter().enumerate().flat_map(|(word, bits)| bits_of(*bits).map(move |bit| 32 * word + bit))
}

fn motion_now(table: &GateTable, phase: &Phase, slot: usize) -> u32 {
    motion_at(table.motion(phase.row, slot), phase.fraction())
}

fn missed_by(table: &GateTable, phase: &Phase, slot: usize, last: u32) -> u32 {
    let (periods, _) = table.record(phase.clip);
    let [period, _] = table.motion(periods, slot);
    motion_between(motion_now(table, phase, slot), last, period)
}

/// 1 to 768, by the logarithm of `missed · weight`: sixteen an octave.
pub fn rank_of(missed: u32, weight: u32) -> u32 {
    let product = u64::from(missed) * u64::from(weight);
    let Some(lead) = product.checked_ilog2() else { return 1 };
    let fine = if lead >= 4 { product >> (lead - 4) } else { product << (4 - lead) };
    1 + 16 * lead + (fine & 15) as u32
}
