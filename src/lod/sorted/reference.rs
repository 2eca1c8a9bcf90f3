//! Draws of single instances: the CPU reference of `kernels/lod/sorted.wgsl`.

use super::SortedDraw;
use crate::lod::SceneDraw;
use crate::shared::lod::object::{decision_list, decision_morph, list_entry_word};

/// The draw arguments of each of `sorted`, from the decisions of all instances and the draws of all lists.
///
/// # Panics
/// For an instance without a decision, and a decision without a draw.
pub fn draws(sorted: &[SortedDraw], decisions: &[u32], arguments: &[SceneDraw]) -> Vec<SceneDraw> {
    let draw = |single: &SortedDraw| match decisions[single.instance as usize] {
        0 => {
            SceneDraw { index_count: 0, instance_count: 0, first_index: 0, base_vertex: 0, first_instance: 0 }
        }
        decision => {
            let draw = arguments[(single.first_draw + decision_list(decision) - 1) as usize];
            SceneDraw { instance_count: 1, first_instance: 0, ..draw }
        }
    };
    sorted.iter().map(draw).collect()
}

/// The list entry of each of `sorted`, from the decisions of all instances.
///
/// # Panics
/// For an instance without a decision.
pub fn entries(sorted: &[SortedDraw], decisions: &[u32]) -> Vec<u32> {
    let morph = |single: &SortedDraw| decision_morph(decisions[single.instance as usize]);
    sorted.iter().map(|single| list_entry_word(single.slot, morph(single))).collect()
}
