//! Draws of single instances: the CPU reference of `kernels/lod/sorted.wgsl`.

use super::SortedDraw;
use crate::lod::transition::sorted_entry;
use crate::lod::{LodObject, SceneDraw};

/// Draw arguments and list entry for each element of `sorted`. `decisions` has the decision of every instance. `arguments` has
/// the draws of all lists.
///
/// # Panics
/// If an object, the decision of an instance, or the draw of a list does not exist.
pub fn draws(
    sorted: &[SortedDraw],
    objects: &[LodObject],
    decisions: &[u32],
    arguments: &[SceneDraw],
) -> Vec<(SceneDraw, u32)> {
    let none =
        SceneDraw { index_count: 0, instance_count: 0, first_index: 0, base_vertex: 0, first_instance: 0 };
    let draw = |single: &SortedDraw| match decisions[single.instance as usize] {
        0 => (none, single.slot),
        decision => {
            let (list, entry) = sorted_entry(&objects[single.object as usize], decision, single.slot);
            let draw = arguments[(single.first_draw + list) as usize];
            (SceneDraw { instance_count: 1, first_instance: 0, ..draw }, entry)
        }
    };
    sorted.iter().map(draw).collect()
}
