//! Budgets: the CPU reference of `kernels/lod/budget.wgsl`.

use crate::lod::transition::{Circumstances, decision, held_level, is_faded_out, level_within, threshold_of};
use crate::lod::{BudgetState, LodObject, SelectView};
use crate::shared::lod::budget::{
    ALL_BINS, BIN_PARTS, MAX_FACTOR, OCTAVE, RANK_BINS, ROUNDED_PARTS, SETTLING,
};
use crate::shared::lod::object::{
    NO_RANK, RANKS, UNSEEN_METRIC, decision_level, decision_next, decision_steps, metric_bits,
};

/// Inputs of a budget for one instance in a view.
#[derive(Debug, Clone, Copy)]
pub struct Budgeted<'a> {
    /// The instance's object.
    pub object: &'a LodObject,
    /// Metric word of the instance, or `UNSEEN_METRIC`.
    pub metric: u32,
    /// The view's decision for the instance in the last frame; 0 for none.
    pub last: u32,
}

/// Largest pressure. Pressure measures how far a budget coarsens. At the largest pressure, every object with a rank is at its
/// coarsest level.
pub const MAX_PRESSURE: u32 = BIN_PARTS * ALL_BINS - 1;

fn part_of(factor: f32) -> u32 {
    (factor.log2().max(0.0) * OCTAVE).ceil() as u32 + ROUNDED_PARTS
}

/// Number of triangles of a level, in units of the budget.
pub fn triangles_of(object: &LodObject, level: u32) -> u32 {
    object.triangles.as_flattened()[level as usize]
}

/// Three values of an instance: its level if there were no budget, its metric, and the level that hysteresis holds. `None` if the
/// instance is unseen or has faded out.
fn level_of(instance: &Budgeted<'_>) -> Option<(u32, f32, u32)> {
    let Budgeted { object, metric, last } = *instance;
    let value = f32::from_bits(metric_bits(metric));
    if metric == UNSEEN_METRIC || is_faded_out(object, value) {
        return None;
    }
    let held = held_level(object, last);
    Some((level_within(object, value, held), value, held))
}

/// Savings of an instance. For each coarser level that saves triangles: the smallest pressure at which the level is drawn, and
/// the number of triangles that it saves compared with the level before, in units of the budget.
pub fn savings(instance: &Budgeted<'_>) -> Vec<(u32, u32)> {
    let Some((level, metric, held)) = level_of(instance) else { return Vec::new() };
    let object = instance.object;
    let (mut before, mut all) = (triangles_of(object, level), Vec::new());
    for coarser in level + 1..object.levels {
        let floor = object.metric_floor;
        let factor = (threshold_of(object, coarser, held) + floor) / (metric + floor);
        let saved = before - triangles_of(object, coarser).min(before);
        if factor < 0.5 * MAX_FACTOR && saved > 0 && object.rank < RANKS {
            before -= saved;
            all.push((RANK_BINS * BIN_PARTS * object.rank + part_of(factor), saved));
        }
    }
    all
}

/// Number of triangles that all instances would draw if there were no budget, in units of the budget.
pub fn triangles(instances: &[Budgeted<'_>]) -> u32 {
    let of = |instance: &Budgeted<'_>| Some(triangles_of(instance.object, level_of(instance)?.0));
    instances.iter().filter_map(of).sum()
}

/// Smallest pressure at which the instances have at most `limit` triangles; `None` if even the coarsest levels have more.
pub fn pressure(instances: &[Budgeted<'_>], limit: u32) -> Option<u32> {
    let mut left = triangles(instances);
    if left <= limit {
        return Some(0);
    }
    let mut all: Vec<(u32, u32)> = instances.iter().flat_map(savings).collect();
    all.sort_unstable();
    for (at, saved) in all {
        left -= saved;
        if left <= limit {
            return Some(at);
        }
    }
    None
}

/// State of a budget after a frame: factors and pressure. `needed` is the smallest pressure at which the frame's triangles are
/// within the limit; `None` if there is none. `last` is the state after the view's last frame.
pub fn state(view: &SelectView, needed: Option<u32>, last: &BudgetState) -> BudgetState {
    let at_least = needed.unwrap_or(MAX_PRESSURE);
    let before = if view.is_next == 0 { at_least } else { last.pressure };
    let ahead = before.saturating_sub(at_least) as f32 * (-view.seconds / SETTLING).exp();
    let pressure = (at_least + ahead as u32).min(MAX_PRESSURE);
    let size = RANK_BINS * BIN_PARTS;
    let factor = |rank: u32| match rank < NO_RANK {
        true => {
            let part = pressure.saturating_sub(rank * size).min(size - 1);
            (part as f32 / OCTAVE).exp2().min(MAX_FACTOR)
        }
        false => 1.0,
    };
    BudgetState {
        factors: [0, 4, 8].map(|first| [0, 1, 2, 3].map(|lane| factor(first + lane))),
        is_missed: needed.is_none().into(),
        pressure,
        ..*last
    }
}

/// Number of triangles that all instances draw with the factors of `state`, in units of the budget. An instance that fades counts
/// with both levels.
pub fn drawn(view: &SelectView, instances: &[Budgeted<'_>], state: &BudgetState) -> u32 {
    let of = |instance: &Budgeted<'_>| {
        let (_, metric, _) = level_of(instance)?;
        let circumstances = Circumstances {
            factor: state.factor(instance.object.rank),
            is_mirrored: false,
            last: instance.last,
            seconds: view.seconds,
            ends_fades: false,
        };
        let found = decision(instance.object, metric, &circumstances);
        let [level, next] = [decision_level(found), decision_next(found)];
        let both = decision_steps(found) > 0 && level != next;
        let next = if both { triangles_of(instance.object, next) } else { 0 };
        Some(triangles_of(instance.object, level) + next)
    };
    instances.iter().filter_map(of).sum()
}
