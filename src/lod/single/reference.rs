//! Draws of single instances: the CPU reference of `kernels/lod/single.wgsl`.

use super::Single;
use crate::lod::SceneDraw;
use crate::shared::lod::object::{decision_list, decision_morph, list_entry_word};

/// The draw of each of `singles`, from the decisions of all instances and the draws of all lists.
///
/// # Panics
/// For an instance without a decision, and a decision without a draw.
pub fn draws(singles: &[Single], decisions: &[u32], arguments: &[SceneDraw]) -> Vec<SceneDraw> {
    let draw = |single: &Single| match decisions[single.instance as usize] {
        0 => SceneDraw { indices: 0, instances: 0, first_index: 0, base_vertex: 0, first_instance: 0 },
        decision => {
            let draw = arguments[(single.first_draw + decision_list(decision) - 1) as usize];
            SceneDraw { instances: 1, first_instance: 0, ..draw }
        }
    };
    singles.iter().map(draw).collect()
}

/// The entry of the list of each of `singles`, from the decisions of all instances.
///
/// # Panics
/// For an instance without a decision.
pub fn entries(singles: &[Single], decisions: &[u32]) -> Vec<u32> {
    let morph = |single: &Single| decision_morph(decisions[single.instance as usize]);
    singles.iter().map(|single| list_entry_word(single.slot, morph(single))).collect()
}
