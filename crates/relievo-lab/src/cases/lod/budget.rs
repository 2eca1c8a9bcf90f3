//! Parity and benchmark cases of `kernels/lod/budget.wgsl`.

use relievo::Error;
use relievo::gpu::{Buffer, Gpu, Uniform};
use relievo::ops::lod::budget::reference::{Budgeted, MAX_PRESSURE, drawn, pressure, state, triangles};
use relievo::ops::lod::budget::{
    BudgetBuffers, BudgetParams, BudgetPass, BudgetStage, BudgetStages, BudgetWork,
};
use relievo::ops::lod::{BLOCK, BudgetState, LodObject, SelectView};
use relievo::shared::lod::budget::MAX_FACTOR;
use relievo::shared::lod::object::{UNSEEN_METRIC, metric_word};

use crate::cases::animation::Draw;
use crate::cases::lod::list::random_decision;
use crate::cases::lod::{Blocks, SIZES, frame};
use crate::cases::measure;
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// Parts by which `log2` may move a saving on a device: 3 ULP of 16 octaves are 0.4 parts.
const PARTS: u32 = 1;

/// Relative error of a factor: `exp2` has 3 + 2 · 16 ULP.
const FACTOR: f32 = 5e-6;

/// The cases cover limits from none to one that no level fits, objects of all ranks and transitions, one view and two that share
/// the budget, and states of a last frame that was coarser. The sums must be zero in the end.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = BudgetPass::new(gpu)?;
    let [(_, view), ..] = frame()?;
    for (case, sizes) in (0..).zip(SIZES) {
        for (is_next, views) in [(0, 1), (1, 1), (1, 2)] {
            let given: Vec<Given> = (0..views)
                .map(|at| Given::new(case + 8 * at, sizes, SelectView { is_next, ..view }))
                .collect();
            let all: Vec<Budgeted<'_>> = given.iter().flat_map(Given::instances).collect();
            let most = triangles(&all);
            for part in [1.0, 0.6, 0.2, 0.01, 0.0] {
                let limit = (part * f64::from(most)) as u32 + 1;
                let last = BudgetState { pressure: MAX_PRESSURE / 3, ..BudgetState::FREE };
                let found = Poisoned::<BudgetState>::new(gpu, 1)?;
                found.buffer.write(gpu, &[last])?;
                let work = Buffer::<BudgetWork>::new(gpu, "work", 1)?;
                let stages =
                    given.iter().map(|given| given.prepared(gpu, &pass, limit, &found.buffer, &work));
                let stages = stages.collect::<Result<Vec<_>, Error>>()?;
                gpu.submit("verify", |encoder| record(encoder, &stages))?;
                let name = format!("{} instances, {views} views, {part} of them", all.len());
                let compared =
                    |states: &[BudgetState]| compared(&given[0].view, &all, limit, &last, &states[0]);
                cases.check(format!("{name}: state"), &found, compared).await?;
                let left = work.read(gpu).await?;
                let is_clear = |sums: &BudgetWork| sums.bins.iter().chain(&sums.parts).all(|sum| *sum == 0);
                let sums = [left[0].triangles, left[0].fading, u32::from(!left.iter().all(is_clear))];
                cases.add(format!("{name}: sums"), crate::harness::compare::exact(&sums, &[0; 3]));
            }
        }
    }
    Ok(())
}

fn record(encoder: &mut wgpu::CommandEncoder, views: &[BudgetStages]) {
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    for stage in BudgetStage::EACH {
        let count = if stage.is_of_each_view() { views.len() } else { 1 };
        views[..count].iter().for_each(|view| view.dispatch(stage, &mut pass));
    }
}

/// The inputs of a view.
struct Given {
    blocks: Blocks,
    view: SelectView,
    metrics: Vec<u32>,
    last: Vec<u32>,
}

impl Given {
    fn new(case: u32, sizes: &[u32], view: SelectView) -> Self {
        let mut blocks = Blocks::new(case, sizes);
        let mut draw = Draw::new(case ^ 0xb0d6);
        for object in &mut blocks.objects {
            let mut most = 200 + draw.word() % 5000;
            object.triangles = [0; 2].map(|_| {
                [0; 4].map(|_| {
                    most = most * 2 / 3;
                    most
                })
            });
            let farthest = object.thresholds.as_flattened()[object.levels as usize - 1];
            object.metric_floor = farthest * object.coarser / (0.5 * MAX_FACTOR);
        }
        let count = BLOCK as usize * blocks.block_objects.len();
        let mut metric = |_| match draw.word() % 8 {
            0 => UNSEEN_METRIC,
            1 => metric_word(0, draw.word() % 2),
            _ => metric_word((1e-2 * libm::exp2f(7.0 * draw.signed())).to_bits(), draw.word() % 2),
        };
        let metrics = (0..count).map(&mut metric).collect();
        let mut decision = |index: usize| match blocks.object_of(index) {
            Some(object) if !draw.word().is_multiple_of(6) => random_decision(&mut draw, object),
            _ => 0,
        };
        let last = (0..count).map(&mut decision).collect();
        Self { view, metrics, last, blocks }
    }

    /// The instances of objects.
    fn instances(&self) -> impl Iterator<Item = Budgeted<'_>> {
        let of = |index: usize| {
            let object: &LodObject = self.blocks.object_of(index)?;
            let last = if self.view.is_next == 0 { 0 } else { self.last[index] };
            Some(Budgeted { object, metric: self.metrics[index], last })
        };
        (0..self.metrics.len()).filter_map(of)
    }

    fn prepared(
        &self,
        gpu: &Gpu,
        pass: &BudgetPass,
        limit: u32,
        state: &Buffer<BudgetState>,
        work: &Buffer<BudgetWork>,
    ) -> Result<BudgetStages, Error> {
        let blocks = self.blocks.block_objects.len() as u32;
        let buffers = BudgetBuffers {
            view: &Uniform::new(gpu, "view", &self.view)?,
            objects: &Buffer::from_slice(gpu, "objects", &self.blocks.objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &self.blocks.block_objects)?,
            metrics: &Buffer::from_slice(gpu, "metrics", &self.metrics)?,
            decisions: &Buffer::from_slice(gpu, "decisions", &self.last)?,
            state,
            work,
        };
        pass.prepare(gpu, &Uniform::new(gpu, "params", &BudgetParams { limit, blocks })?, buffers)
    }
}

/// The pressure must be that of a saving at which the triangles fit, up to rounding; factors must be those of the pressure, and
/// triangles those that are drawn with them.
fn compared(
    view: &SelectView,
    all: &[Budgeted<'_>],
    limit: u32,
    last: &BudgetState,
    found: &BudgetState,
) -> Comparison {
    let needed = pressure(all, limit);
    let right = state(view, needed, last);
    // The factors in force are the device's.
    let triangles = drawn(view, all, found);
    let is_near = |(found, right): (&f32, &f32)| (found - right).abs() <= FACTOR * right;
    let exact = state(view, Some(found.pressure), &BudgetState { pressure: found.pressure, ..*last });
    let checks = [
        ("pressure", found.pressure.abs_diff(right.pressure) <= PARTS),
        ("missed", found.is_missed == right.is_missed),
        ("factors", found.factors.as_flattened().iter().zip(exact.factors.as_flattened()).all(is_near)),
        ("triangles", found.triangles == triangles),
        ("fades", found.ends_fades == u32::from(found.triangles > limit)),
    ];
    let judgements =
        checks.map(|(_, is_right)| Judgement::exact(is_right, f64::from(u8::from(!is_right)), false));
    each(&judgements, "wrong values", 0.0, |at| {
        let (what, _) = checks[at];
        format!("{what}: {found:?} instead of {right:?}, with {triangles} triangles and the limit {limit}")
    })
}

/// Measures views of many instances with a tenth of their triangles.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = BudgetPass::new(gpu)?;
    let [(_, view), ..] = frame()?;
    for blocks in [16, 1_600] {
        let given = Given::new(3, &[blocks - 1], SelectView { is_next: 1, ..view });
        let all: Vec<Budgeted<'_>> = given.instances().collect();
        let limit = triangles(&all) / 10;
        let (state, work) = (Buffer::new(gpu, "state", 1)?, Buffer::new(gpu, "work", 1)?);
        let stages = [given.prepared(gpu, &pass, limit, &state, &work)?];
        // Three stages read metric and decision of an instance; some levels are added to the histogram.
        let words = 8 * all.len();
        let case = format!("{} instances", all.len());
        let record = |encoder: &mut wgpu::CommandEncoder| record(encoder, &stages);
        measure(bench, case, all.len(), "instance", words, &record, || pressure(&all, limit))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::ops::lod::budget::reference::savings;

    #[test]
    fn what_is_wrong_is_seen_and_what_fits_is_the_least() {
        let [(_, view), ..] = frame().expect("valid");
        let given = Given::new(3, &[17, 1, 16, 40], SelectView { is_next: 1, ..view });
        let all: Vec<Budgeted<'_>> = given.instances().collect();
        let limit = triangles(&all) * 3 / 5;
        let needed = pressure(&all, limit).expect("it fits");
        let left = |pressure: u32| {
            let saved = all.iter().flat_map(savings).filter(|(at, _)| *at <= pressure);
            triangles(&all) - saved.map(|(_, saved)| saved).sum::<u32>()
        };
        assert!(left(needed) <= limit && left(needed - 1) > limit);
        assert!(pressure(&all, 0).is_none(), "some objects are spared");
        let last = BudgetState::FREE;
        let mut right = state(&view, Some(needed), &last);
        right.triangles = drawn(&view, &all, &right);
        right.ends_fades = u32::from(right.triangles > limit);
        let holds = |found: &BudgetState| compared(&view, &all, limit, &last, found).holds;
        assert!(holds(&right));
        assert!(!holds(&BudgetState { pressure: right.pressure + 2, ..right }));
        assert!(!holds(&BudgetState { is_missed: 1, ..right }));
        assert!(!holds(&BudgetState { triangles: right.triangles + 1, ..right }));
        assert!(!holds(&BudgetState { ends_fades: 1 - right.ends_fades, ..right }));
        let mut other = right;
        other.factors[0][0] *= 1.001;
        assert!(!holds(&other));
        other = BudgetState { factors: [[1.0; 4]; 3], ..right };
        assert!(!holds(&other));
    }

    /// A smaller factor is approached in time, and a larger one is taken at once.
    #[test]
    fn the_factor_falls_in_time() {
        let [(_, view), ..] = frame().expect("valid");
        let view = SelectView { is_next: 1, seconds: 0.02, ..view };
        let mut last = BudgetState { pressure: 50_000, ..BudgetState::FREE };
        for _ in 0..50 {
            let next = state(&view, Some(10_000), &last);
            assert!((10_000..last.pressure).contains(&next.pressure) || next.pressure == 10_000);
            last = next;
        }
        assert!(last.pressure < 10_100, "{} after a second", last.pressure);
        assert_eq!(state(&view, Some(70_000), &last).pressure, 70_000);
        assert_eq!(state(&SelectView { is_next: 0, ..view }, Some(10_000), &last).pressure, 10_000);
    }
}
