//! Decisions: the CPU reference of `kernels/lod/decide.wgsl`.

use crate::lod::transition::{Circumstances, decision, entries, finest_of};
use crate::lod::{BLOCK, LodObject, OBJECT_LISTS, SelectView};
use crate::shared::lod::budget_state::BudgetState;
use crate::shared::lod::object::{UNSEEN_METRIC, metric_bits, metric_mirrored};

/// A view's decision word for an instance: its level, and its progress to another level. `metric` is the instance's metric word;
/// `last` is the view's decision in the last frame.
pub fn decide(view: &SelectView, object: &LodObject, budget: &BudgetState, metric: u32, last: u32) -> u32 {
    if metric == UNSEEN_METRIC {
        return 0;
    }
    let circumstances = Circumstances {
        factor: budget.factor(object.rank),
        is_mirrored: metric_mirrored(metric) != 0,
        last: if view.is_next == 0 { 0 } else { last },
        seconds: view.seconds,
        ends_fades: budget.ends_fades != 0,
    };
    decision(object, f32::from_bits(metric_bits(metric)), &circumstances)
}

/// Finest level of an instance in the views of a frame, updated by the decision of one more view. `before` is the result of the
/// earlier views; for the first view, it is [`UNSEEN_LEVEL`](super::UNSEEN_LEVEL).
pub fn finest(before: u32, decision: u32) -> u32 {
    if decision == 0 { before } else { before.min(finest_of(decision)) }
}

/// Instance counts per block and list, from the decisions of all instances. `object_of` gives a block's object.
pub fn counts<'a>(decisions: &[u32], object_of: impl Fn(usize) -> Option<&'a LodObject>) -> Vec<u32> {
    let mut counts = Vec::with_capacity(decisions.len() / 2);
    for (block, decisions) in decisions.chunks(BLOCK as usize).enumerate() {
        let mut tally = [0; OBJECT_LISTS as usize];
        if let Some(object) = object_of(block) {
            let lists = decisions.iter().flat_map(|decision| entries(object, *decision, 0));
            lists.for_each(|(list, _)| tally[list as usize] += 1);
        }
        counts.extend(tally);
    }
    counts
}

impl BudgetState {
    /// Budget state that coarsens nothing.
    pub const FREE: Self =
        Self { factors: [[1.0; 4]; 3], ends_fades: 0, is_missed: 0, triangles: 0, pressure: 0 };

    /// Factor by which the budget scales the metric of objects with this rank.
    pub fn factor(&self, rank: u32) -> f32 {
        self.factors.as_flattened()[rank as usize]
    }
}
