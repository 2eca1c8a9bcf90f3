//! Parity and benchmark cases of `kernels/lod/decide.wgsl`.

use relievo::Error;
use relievo::gpu::{Buffer, Uniform};
use relievo::ops::lod::decide::reference::{decide, finest};
use relievo::ops::lod::decide::{DecideBuffers, DecidePass, UNSEEN_LEVEL};
use relievo::ops::lod::{BLOCK, BudgetState, LodObject, OBJECT_LISTS, SelectView};
use relievo::shared::lod::object::{
    UNSEEN_METRIC, decision_level, decision_next, decision_steps, metric_bits, metric_mirrored, metric_word,
};

use crate::cases::animation::Draw;
use crate::cases::lod::list::random_decision;
use crate::cases::lod::{Blocks, SIZES, frame};
use crate::cases::measure;
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases, compare};

/// How far rounding may move a threshold or a coarsened metric, as a fraction.
const ROUNDING: f32 = 3e-7;

/// The fraction of instances whose level rounding may decide either way.
const MAY_TOUCH: f64 = 1.0 / 200.0;

/// The cases cover objects with every transition, by band and in time, with decisions of a last frame and without, budgets
/// that coarsen some ranks or end all fades, first views and later ones, and blocks of no object or beyond the view's.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = DecidePass::new(gpu)?;
    let view = frame()?[0].1;
    for (case, sizes) in (0..).zip(SIZES) {
        for (name, is_next, budget) in budgets() {
            for is_first in [1, 0] {
                let given = Given::new(case, sizes, SelectView { is_first, is_next, ..view }, budget);
                let count = given.metrics.len();
                let decisions = Poisoned::<u32>::new(gpu, count)?;
                let last_decisions = Poisoned::<u32>::new(gpu, count)?;
                let finest = Poisoned::<u32>::new(gpu, count)?;
                let counts = Poisoned::<u32>::new(gpu, count / 2)?;
                decisions.buffer.write(gpu, &given.last)?;
                finest.buffer.write(gpu, &given.finest)?;
                let buffers = DecideBuffers {
                    view: &Uniform::new(gpu, "view", &given.view)?,
                    objects: &Buffer::from_slice(gpu, "objects", &given.blocks.objects)?,
                    block_objects: &Buffer::from_slice(gpu, "block_objects", &given.blocks.block_objects)?,
                    metrics: &Buffer::from_slice(gpu, "metrics", &given.metrics)?,
                    decisions: &decisions.buffer,
                    last_decisions: &last_decisions.buffer,
                    counts: &counts.buffer,
                    finest: &finest.buffer,
                    budget: &Buffer::from_slice(gpu, "budget", &[given.budget])?,
                };
                let job = pass.prepare(gpu, buffers)?;
                gpu.submit("verify", |encoder| job.record(encoder))?;
                let name = format!("{} blocks, {name}, first {is_first}", given.blocks.block_objects.len());
                let end = |output| format!("{name}: the end of {output}");
                let found = Found {
                    decisions: cases.values(end("decisions"), &decisions).await?,
                    last_decisions: cases.values(end("last decisions"), &last_decisions).await?,
                    finest: cases.values(end("finest"), &finest).await?,
                    counts: cases.values(end("counts"), &counts).await?,
                };
                for (what, comparison) in found.compared(&given) {
                    cases.add(format!("{name}: {what}"), comparison);
                }
            }
        }
    }
    Ok(())
}

/// Budgets, and whether the view was in the last frame.
fn budgets() -> [(&'static str, u32, BudgetState); 3] {
    let mut coarse = BudgetState::FREE;
    coarse.factors[..2].copy_from_slice(&[[3.7, 1.9, 1.0, 1.3], [1.0, 2.3, 1.0, 1.1]]);
    [
        ("no budget", 1, BudgetState::FREE),
        ("a budget, no last frame", 0, coarse),
        ("fades end", 1, BudgetState { ends_fades: 1, ..coarse }),
    ]
}

/// The inputs.
struct Given {
    blocks: Blocks,
    view: SelectView,
    budget: BudgetState,
    metrics: Vec<u32>,
    last: Vec<u32>,
    finest: Vec<u32>,
}

/// What the kernel wrote.
#[derive(Clone)]
struct Found {
    decisions: Vec<u32>,
    last_decisions: Vec<u32>,
    finest: Vec<u32>,
    counts: Vec<u32>,
}

impl Given {
    fn new(case: u32, sizes: &[u32], view: SelectView, budget: BudgetState) -> Self {
        let blocks = Blocks::new(case, sizes);
        let mut draw = Draw::new(case ^ 0xdec1);
        let count = BLOCK as usize * blocks.block_objects.len();
        let mut metric = |_| match draw.word() % 8 {
            0 => UNSEEN_METRIC,
            1 => metric_word(0, draw.word() % 2),
            _ => metric_word((4e-2 * libm::exp2f(6.0 * draw.signed())).to_bits(), draw.word() % 2),
        };
        let metrics = (0..count).map(&mut metric).collect();
        let mut decision = |index: usize| match blocks.object_of(index) {
            Some(object) if !draw.word().is_multiple_of(6) => random_decision(&mut draw, object),
            _ => 0,
        };
        let last = (0..count).map(&mut decision).collect();
        let finest = (0..count).map(|at| if at % 3 == 0 { UNSEEN_LEVEL } else { at as u32 % 8 }).collect();
        // The last block is the scene's but not the view's, except in the smallest scene.
        let all = blocks.block_objects.len() as u32;
        let view = SelectView { blocks: all - u32::from(all > 2), ..view };
        Self { blocks, view, budget, metrics, last, finest }
    }

    /// The object of an instance, if its block is one of the view's.
    fn object_of(&self, instance: usize) -> Option<&LodObject> {
        self.blocks.object_of(instance).filter(|_| instance < (BLOCK * self.view.blocks) as usize)
    }

    /// The decision for a metric that is `factor` times as large.
    fn decided(&self, index: usize, factor: f32) -> u32 {
        let Some(object) = self.object_of(index) else { return self.last[index] };
        let word = match self.metrics[index] {
            UNSEEN_METRIC => UNSEEN_METRIC,
            word => {
                let metric = factor * f32::from_bits(metric_bits(word));
                metric_word(metric.to_bits(), metric_mirrored(word))
            }
        };
        decide(&self.view, object, &self.budget, word, self.last[index])
    }

    /// The decisions that rounding may lead to.
    fn around(&self, index: usize) -> [u32; 3] {
        [1.0, 1.0 - ROUNDING, 1.0 + ROUNDING].map(|factor| self.decided(index, factor))
    }
}

impl Found {
    fn compared(&self, given: &Given) -> [(&'static str, Comparison); 4] {
        let (all, own) = (0..self.decisions.len(), |index: usize| given.object_of(index).is_some());
        let last = all.clone().map(|index| match own(index) {
            true => given.last[index] * given.view.is_next,
            false => POISON,
        });
        let expected_finest = all.map(|index| match own(index) {
            true => {
                let before = if given.view.is_first == 1 { UNSEEN_LEVEL } else { given.finest[index] };
                finest(before, self.decisions[index])
            }
            false => given.finest[index],
        });
        let mut counts = given.blocks.counts(&self.decisions);
        for (block, counts) in counts.chunks_mut(OBJECT_LISTS as usize).enumerate() {
            if !own(block * BLOCK as usize) {
                counts.fill(POISON);
            }
        }
        [
            ("decisions", self.compared_decisions(given)),
            ("last decisions", compare::exact(&self.last_decisions, &last.collect::<Vec<_>>())),
            ("finest", compare::exact(&self.finest, &expected_finest.collect::<Vec<_>>())),
            ("counts", compare::exact(&self.counts, &counts)),
        ]
    }

    /// Steps may differ by one, and levels where rounding may decide either way.
    fn compared_decisions(&self, given: &Given) -> Comparison {
        let levels = |decision: u32| (decision & 3, decision_level(decision), decision_next(decision));
        let judge = |(index, found): (usize, &u32)| {
            let around = given.around(index);
            let is_near = |right: &u32| {
                let is_there = (decision_steps(*found) == 0) == (decision_steps(*right) == 0);
                let steps = decision_steps(*found).abs_diff(decision_steps(*right));
                levels(*found) == levels(*right) && found >> 24 == 0 && is_there && steps <= 1
            };
            let is_right = found == &around[0] || around.iter().any(is_near);
            let touches = around.iter().any(|other| levels(*other) != levels(around[0]));
            Judgement::exact(is_right, f64::from(u8::from(!is_right)), touches)
        };
        let judgements: Vec<Judgement> = self.decisions.iter().enumerate().map(judge).collect();
        each(&judgements, "wrong decisions", MAY_TOUCH, |index| {
            format!("{:#x} instead of {:#x?}", self.decisions[index], given.around(index))
        })
    }
}

/// Measures one object whose instances are all seen, and fade in time.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = DecidePass::new(gpu)?;
    let [(_, view), ..] = frame()?;
    for blocks in [16, 1_600] {
        let view = SelectView { is_next: 1, ..view };
        let given = Given::new(3, &[blocks - 1], view, BudgetState::FREE);
        let count = given.metrics.len();
        let buffers = DecideBuffers {
            view: &Uniform::new(gpu, "view", &given.view)?,
            objects: &Buffer::from_slice(gpu, "objects", &given.blocks.objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &given.blocks.block_objects)?,
            metrics: &Buffer::from_slice(gpu, "metrics", &given.metrics)?,
            decisions: &Buffer::from_slice(gpu, "decisions", &given.last)?,
            last_decisions: &Buffer::new(gpu, "last decisions", count)?,
            counts: &Buffer::new(gpu, "counts", count / 2)?,
            finest: &Buffer::new(gpu, "finest", count)?,
            budget: &Buffer::from_slice(gpu, "budget", &[given.budget])?,
        };
        let job = pass.prepare(gpu, buffers)?;
        // The kernel reads metric, decision and finest level of an instance, writes two decisions and a level, and half a count.
        let words = 6 * count + count / 2;
        let case = format!("{count} instances");
        measure(bench, case, count, "instance", words, &|encoder| job.record(encoder), || {
            (0..count).map(|index| given.decided(index, 1.0)).collect::<Vec<_>>()
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the reference writes.
    fn right(given: &Given) -> Found {
        let count = given.metrics.len();
        let decisions: Vec<u32> = (0..count).map(|index| given.decided(index, 1.0)).collect();
        let of = |own: &dyn Fn(usize) -> u32, other: &dyn Fn(usize) -> u32| {
            let value = |index: usize| match given.object_of(index) {
                Some(_) => own(index),
                None => other(index),
            };
            (0..count).map(value).collect::<Vec<u32>>()
        };
        let before = |index: usize| if given.view.is_first == 1 { UNSEEN_LEVEL } else { given.finest[index] };
        let mut counts = given.blocks.counts(&decisions);
        for (block, counts) in counts.chunks_mut(OBJECT_LISTS as usize).enumerate() {
            if given.object_of(block * BLOCK as usize).is_none() {
                counts.fill(POISON);
            }
        }
        Found {
            last_decisions: of(&|index| given.last[index] * given.view.is_next, &|_| POISON),
            finest: of(&|index| finest(before(index), decisions[index]), &|index| given.finest[index]),
            decisions,
            counts,
        }
    }

    #[test]
    fn what_is_wrong_of_one_instance_is_seen() {
        let view = SelectView { is_next: 1, ..frame().expect("valid")[0].1 };
        let given = Given::new(3, &[17, 1, 16, 40], view, BudgetState::FREE);
        let right = right(&given);
        let faults = |given: &Given, found: &Found| {
            let compared = found.compared(given).into_iter();
            compared.filter(|(_, comparison)| !comparison.holds).map(|(what, _)| what).collect::<Vec<_>>()
        };
        assert_eq!(faults(&given, &right), Vec::<&str>::new());
        let own = |index: &usize| given.object_of(*index).is_some();
        let first = |is: &dyn Fn(u32) -> bool| {
            (0..right.decisions.len()).filter(own).find(|index| is(right.decisions[*index])).expect("some")
        };
        let fading = first(&|decision| decision_steps(decision) > 1000);
        let unseen = first(&|decision| decision == 0);
        let foreign = (0..right.decisions.len()).find(|index| !own(index)).expect("some");
        let with = |change: &dyn Fn(&mut Found)| {
            let mut found = right.clone();
            change(&mut found);
            faults(&given, &found)
        };
        assert_eq!(with(&|found| found.decisions[fading] ^= 2)[0], "decisions");
        assert_eq!(with(&|found| found.decisions[fading] += 2 << 8)[0], "decisions");
        assert_eq!(with(&|found| found.decisions[fading] ^= 1 << 2)[0], "decisions");
        assert_eq!(with(&|found| found.decisions[fading] ^= 1 << 5)[0], "decisions");
        assert_eq!(with(&|found| found.decisions[unseen] = 1)[0], "decisions");
        assert_eq!(with(&|found| found.decisions[foreign] ^= 1 << 31), ["decisions"]);
        assert_eq!(with(&|found| found.last_decisions[fading] ^= 1), ["last decisions"]);
        assert_eq!(with(&|found| found.finest[fading] += 1), ["finest"]);
        assert_eq!(with(&|found| found.finest[foreign] ^= 1), ["finest"]);
        assert_eq!(with(&|found| found.counts[fading / 2] ^= 1), ["counts"]);
        // What a kernel would do that forgets the last frame, or the budget.
        let forgetful = Given {
            view: SelectView { is_next: 0, ..given.view },
            ..Given::new(3, &[17, 1, 16, 40], view, BudgetState::FREE)
        };
        assert!(faults(&forgetful, &right).contains(&"decisions"));
        let poor = Given::new(3, &[17, 1, 16, 40], view, budgets()[1].2);
        assert!(faults(&poor, &right).contains(&"decisions"));
    }
}
