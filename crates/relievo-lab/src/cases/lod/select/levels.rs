//! What a selection tells of the levels of the last frame, from the decisions that it finds.

use relievo::lod::select::reference::level_told;
use relievo::lod::{OBJECT_LISTS, SelectView};
use relievo::shared::lod::object::{MORPH_STEPS, decision_word, morph_word};

use crate::cases::lod::select::{Found, Scene};
use crate::harness::compare;
use crate::harness::compare::Comparison;
use crate::harness::poison::POISON;

impl Found {
    pub(super) fn compared_levels(&self, scene: &Scene, view: &SelectView) -> Comparison {
        let poison = [f32::from_bits(POISON); 4];
        let before = before(self.levels.len());
        let expected = |(index, before): (usize, &u32)| match scene.object_of(view, index) {
            Some(_) if view.last_levels != 0 && view.is_next != 0 => level_told(*before),
            Some(_) if view.last_levels != 0 => level_told(0),
            _ => poison,
        };
        let expected: Vec<[f32; 4]> = before.iter().enumerate().map(expected).collect();
        compare::exact(bits(&self.levels), bits(&expected))
    }
}

fn bits(values: &[[f32; 4]]) -> &[u32] {
    bytemuck::cast_slice(values)
}

/// The decisions of a frame before: all lists, some instances that were not seen, and all numbers of steps.
pub(super) fn before(count: usize) -> Vec<u32> {
    let decision = |at: u32| match at % (OBJECT_LISTS + 1) {
        0 => 0,
        list => decision_word(list, morph_word(0, at.wrapping_mul(37) % (MORPH_STEPS + 1))),
    };
    (0..count as u32).map(decision).collect()
}

/// What a decision is that a view does not write.
pub(super) fn untouched(view: &SelectView, count: usize, index: usize) -> u32 {
    if view.last_levels == 0 { POISON } else { before(count)[index] }
}
