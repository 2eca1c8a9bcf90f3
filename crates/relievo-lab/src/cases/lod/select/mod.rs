//! Parity and benchmark cases of `kernels/lod/select.wgsl`.

use relievo::Error;
use relievo::asset::Affine;
use relievo::gpu::{Buffer, Gpu, GpuError, Uniform};
use relievo::ops::lod::allowed::allowed_by;
use relievo::ops::lod::object::level_within;
use relievo::ops::lod::select::reference::{counts, depth_inside, is_shown, placed_sphere, select};
use relievo::ops::lod::select::{SelectBuffers, SelectPass, UNSEEN_ALLOWED};
use relievo::ops::lod::transition::morph_within;
use relievo::ops::lod::{BLOCK, LodObject, OBJECT_LISTS, SceneInstance, SelectView};
use relievo::shared::lod::object::{
    MORPH_STEPS, decision_list, decision_morph, decision_word, morph_level, morph_steps, morph_word,
};
use relievo::shared::lod::view::POSITION_SLACK;

use crate::cases::lod::{Blocks, SIZES, frame, random_instances};
use crate::cases::measure;
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases, compare};

/// How far rounding may move a level or an allowed displacement beyond what it does to positions: kernel and reference
/// round some 40 times each, by at most 2⁻²³.
const FORMULA: f32 = 1e-5;

/// The largest error of a row's component: 18 · 2⁻²⁴ of the scale.
const AXES_BOUND: f32 = 1.1e-6;

/// The largest error of a position: 4 · 2⁻²⁴ of the lengths that are added.
const POSITION_BOUND: f32 = 2.4e-7;

/// The fraction of instances for which rounding may decide either way.
const MAY_TOUCH: f64 = 1.0 / 200.0;

/// The cases cover one object and several, some whose levels move into each other, one without instances and one that is not shown, blocks of no object and blocks
/// beyond the view's, and the four views of a frame one after another. Where rounding may decide either way, both
/// decisions are accepted and counted.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (case, sizes) in (0..).zip(SIZES) {
        let scene = Scene::new(case, sizes);
        let outputs = Outputs::new(cases.gpu, scene.instances.len())?;
        let mut state = vec![State::Untouched; scene.instances.len()];
        for (at, (name, view)) in (0..).zip(frame()?) {
            // The last block is the scene's but not the view's, except in the smallest scene.
            let all = scene.blocks.block_objects.len() as u32;
            let blocks = all - u32::from(all > 2);
            let view = SelectView { blocks, is_next: u32::from(at != 2), ..view };
            let name = format!("{} blocks, {name}", view.blocks);
            let found = outputs.run(cases, &name, &scene, &view).await?;
            for (what, comparison) in found.compared(&scene, &view, &mut state) {
                cases.add(format!("{name}: {what}"), comparison);
            }
        }
    }
    Ok(())
}

/// Objects and instances.
struct Scene {
    blocks: Blocks,
    instances: Vec<SceneInstance>,
}

impl Scene {
    fn new(case: u32, sizes: &[u32]) -> Self {
        let blocks = Blocks::new(case, sizes);
        let instances = random_instances(case, BLOCK as usize * blocks.block_objects.len());
        Self { blocks, instances }
    }

    /// The object of an instance, if its block is one of the view's.
    fn object_of(&self, view: &SelectView, instance: usize) -> Option<&LodObject> {
        self.blocks.object_of(instance).filter(|_| instance < (BLOCK * view.blocks) as usize)
    }
}

/// The outputs on the device.
struct Outputs {
    allowed: Poisoned<f32>,
    decisions: Poisoned<u32>,
    placements: Poisoned<Affine>,
    counts: Poisoned<u32>,
    last_decisions: Poisoned<u32>,
}

/// What the kernel wrote.
#[derive(Clone, PartialEq, Default)]
struct Found {
    allowed: Vec<f32>,
    decisions: Vec<u32>,
    placements: Vec<Affine>,
    counts: Vec<u32>,
    last_decisions: Vec<u32>,
}

impl Outputs {
    fn new(gpu: &Gpu, instances: usize) -> Result<Self, GpuError> {
        Ok(Self {
            allowed: Poisoned::new(gpu, instances)?,
            decisions: Poisoned::new(gpu, instances)?,
            placements: Poisoned::new(gpu, instances)?,
            last_decisions: Poisoned::new(gpu, instances)?,
            counts: Poisoned::new(gpu, instances / (BLOCK / OBJECT_LISTS) as usize)?,
        })
    }

    /// Runs the kernel, with the allowed displacements of the views before.
    async fn run(
        &self,
        cases: &mut Cases<'_>,
        name: &str,
        scene: &Scene,
        view: &SelectView,
    ) -> Result<Found, Error> {
        let gpu = cases.gpu;
        self.decisions.buffer.write(gpu, &before(scene.instances.len()))?;
        self.placements.poison(gpu)?;
        self.counts.poison(gpu)?;
        self.last_decisions.poison(gpu)?;
        let buffers = SelectBuffers {
            view: &Uniform::new(gpu, "view", view)?,
            objects: &Buffer::from_slice(gpu, "objects", &scene.blocks.objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &scene.blocks.block_objects)?,
            instances: &Buffer::from_slice(gpu, "instances", &scene.instances)?,
            allowed: &self.allowed.buffer,
            decisions: &self.decisions.buffer,
            placements: &self.placements.buffer,
            counts: &self.counts.buffer,
            last_decisions: &self.last_decisions.buffer,
        };
        let job = SelectPass::new(gpu)?.prepare(gpu, buffers)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let end = |output| format!("{name}: the end of {output}");
        Ok(Found {
            allowed: cases.values(end("allowed"), &self.allowed).await?,
            decisions: cases.values(end("decisions"), &self.decisions).await?,
            placements: cases.values(end("placements"), &self.placements).await?,
            counts: cases.values(end("counts"), &self.counts).await?,
            last_decisions: cases.values(end("last decisions"), &self.last_decisions).await?,
        })
    }
}

/// What is known of an instance's allowed displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    /// It was never written.
    Untouched,
    /// No view has seen the instance.
    Unseen,
    /// It lies between these.
    Within(f32, f32),
}

/// What may be decided for an instance, whichever way rounding goes.
struct Range {
    may_be_unseen: bool,
    may_be_seen: bool,
    levels: [u32; 2],
    /// How far the first of these may have moved at least, and the last at most, in steps.
    steps: [u32; 2],
    allowed: [f32; 2],
}

impl Range {
    /// The displacement that a camera allows, and how far a sphere reaches into the view volume, change with the sphere's
    /// radius at least as much as with the rounding of its center; so two radii bound what rounding may decide.
    fn of(view: &SelectView, object: &LodObject, instance: &SceneInstance) -> Self {
        let (center, radius) = placed_sphere(instance, view.cell);
        let scale = instance.largest_scale();
        let farthest = view.cameras().iter().map(|camera| camera.eye.length()).fold(0.0, f32::max);
        let farthest = view.planes.iter().map(|plane| plane.w.abs()).fold(farthest, f32::max);
        let lengths = 2.0 * (instance.position(view.cell).length() + center.length() + radius + farthest);
        let slack = 2.0 * POSITION_SLACK * lengths;
        let [less, more] =
            [radius + slack, radius - slack].map(|radius| allowed_by(view.cameras(), center, radius, scale));
        let allowed = [less * (1.0 - FORMULA), more * (1.0 + FORMULA)];
        let within = allowed.map(|allowed| object.mesh_fraction * allowed);
        let levels = within.map(|within| level_within(object.levels, &object.errors, within));
        let steps = [0, 1].map(|at| morph_steps(morph_within(object, levels[at], within[at])));
        let is_shown = is_shown(view, object, instance);
        Self {
            may_be_seen: is_shown && depth_inside(view, center, radius + slack) >= 0.0,
            may_be_unseen: !is_shown || depth_inside(view, center, radius - slack) < 0.0,
            levels,
            steps,
            allowed,
        }
    }

    /// Whether rounding may decide either way.
    fn touches(&self) -> bool {
        self.may_be_seen && (self.may_be_unseen || self.levels[0] != self.levels[1])
    }

    /// Whether a decision is one of those that are right.
    fn permits(&self, decision: u32, instance: &SceneInstance) -> bool {
        let Some(list) = decision_list(decision).checked_sub(1) else {
            return self.may_be_unseen && decision == 0;
        };
        let is_right = list % 2 == u32::from(instance.is_mirrored());
        let level = list / 2;
        let is_right = is_right && (self.levels[0]..=self.levels[1]).contains(&level);
        let morph = decision_morph(decision);
        let is_right = is_right && decision == decision_word(1 + list, morph);
        self.may_be_seen && is_right && self.permits_morph(level, morph)
    }

    /// Whether a level may have moved so far. Steps are judged by an interval, and none counts as one that touches.
    fn permits_morph(&self, level: u32, morph: u32) -> bool {
        let steps = morph_steps(morph);
        let least = if level == self.levels[0] { self.steps[0] } else { 0 };
        let most = if level == self.levels[1] { self.steps[1] } else { MORPH_STEPS };
        let is_named = morph_level(morph) == if steps > 0 { level } else { 0 };
        is_named && (least..=most).contains(&steps)
    }
}

fn judgement(is_right: bool, touches: bool) -> Judgement {
    Judgement::exact(is_right, f64::from(u8::from(!is_right)), touches)
}

impl Found {
    /// Compares the outputs after a view. `state` is what is known after the views before, and becomes that after this one.
    fn compared(
        &self,
        scene: &Scene,
        view: &SelectView,
        state: &mut [State],
    ) -> [(&'static str, Comparison); 5] {
        [
            ("decisions", self.compared_decisions(scene, view)),
            ("counts", self.compared_counts(scene, view)),
            ("placements", self.compared_placements(scene, view)),
            ("last decisions", self.compared_last_decisions(scene, view)),
            ("allowed", self.compared_allowed(scene, view, state)),
        ]
    }

    fn compared_decisions(&self, scene: &Scene, view: &SelectView) -> Comparison {
        let before = before(self.decisions.len());
        let judge = |(index, decision): (usize, &u32)| match scene.object_of(view, index) {
            None => judgement(*decision == before[index], false),
            Some(object) => {
                let instance = &scene.instances[index];
                let range = Range::of(view, object, instance);
                judgement(range.permits(*decision, instance), range.touches())
            }
        };
        let judgements: Vec<Judgement> = self.decisions.iter().enumerate().map(judge).collect();
        each(&judgements, "wrong decisions", MAY_TOUCH, |index| {
            let expected =
                scene.object_of(view, index).map(|object| select(view, object, &scene.instances[index]));
            format!("{:#x} instead of {expected:?}", self.decisions[index])
        })
    }

    fn compared_counts(&self, scene: &Scene, view: &SelectView) -> Comparison {
        let mut expected = Vec::with_capacity(self.counts.len());
        for (block, decisions) in self.decisions.chunks(BLOCK as usize).enumerate() {
            match scene.object_of(view, block * BLOCK as usize) {
                Some(_) if decisions.iter().all(|decision| decision_list(*decision) <= OBJECT_LISTS) => {
                    expected.extend(counts(decisions))
                }
                _ => expected.extend([POISON; OBJECT_LISTS as usize]),
            }
        }
        compare::exact(&self.counts, &expected)
    }

    fn compared_placements(&self, scene: &Scene, view: &SelectView) -> Comparison {
        let mut judgements = Vec::with_capacity(12 * self.placements.len());
        for (index, rows) in self.placements.iter().enumerate() {
            let instance = &scene.instances[index];
            let is_seen = self.decisions[index] != 0 && scene.object_of(view, index).is_some();
            if !is_seen {
                let values = rows.iter().flatten().map(|value| judgement(value.to_bits() == POISON, false));
                judgements.extend(values);
                continue;
            }
            let ([x, y, z], at) = (instance.axes(), instance.position(view.cell));
            let lengths = 256.0 + at.abs().max_element();
            for (axis, row) in rows.iter().enumerate() {
                let columns = [x, y, z].into_iter().zip(instance.scale);
                let parts = columns.map(|(column, scale)| (column[axis], AXES_BOUND * scale.abs()));
                let parts = parts.chain([(at[axis], POSITION_BOUND * lengths)]);
                judgements.extend(parts.zip(row).map(|((expected, bound), value)| {
                    let error = f64::from((value - expected).abs());
                    Judgement { ratio: error / f64::from(bound), error, touches: false }
                }));
            }
        }
        each(&judgements, "units", MAY_TOUCH, |at| {
            format!("{:?} of instance {}", self.placements[at / 12][at / 4 % 3], at / 12)
        })
    }

    fn compared_last_decisions(&self, scene: &Scene, view: &SelectView) -> Comparison {
        let expected = |(index, before): (usize, &u32)| match scene.object_of(view, index) {
            Some(_) => *before * view.is_next,
            None => POISON,
        };
        let expected: Vec<u32> = before(self.last_decisions.len()).iter().enumerate().map(expected).collect();
        compare::exact(&self.last_decisions, &expected)
    }

    fn compared_allowed(&self, scene: &Scene, view: &SelectView, state: &mut [State]) -> Comparison {
        let mut judgements = Vec::with_capacity(self.allowed.len());
        for (index, allowed) in self.allowed.iter().enumerate() {
            if let Some(object) = scene.object_of(view, index) {
                let range = Range::of(view, object, &scene.instances[index]).allowed;
                let before = if view.is_first == 0 { state[index] } else { State::Unseen };
                state[index] = match (before, self.decisions[index]) {
                    (before, 0) => before,
                    (State::Within(low, high), _) => State::Within(low.min(range[0]), high.min(range[1])),
                    _ => State::Within(range[0], range[1]),
                };
            }
            judgements.push(match state[index] {
                State::Untouched => judgement(allowed.to_bits() == POISON, false),
                State::Unseen => judgement(*allowed == UNSEEN_ALLOWED, false),
                State::Within(low, high) => judgement((low..=high).contains(allowed), high > 1.01 * low),
            });
        }
        each(&judgements, "wrong displacements", 4.0 * MAY_TOUCH, |at| {
            format!("{} instead of {:?} of instance {at}", self.allowed[at], state[at])
        })
    }
}

/// The decisions of a frame before: all lists, some instances that were not seen, and all numbers of steps.
fn before(count: usize) -> Vec<u32> {
    let decision = |at: u32| match at % (OBJECT_LISTS + 1) {
        0 => 0,
        list => decision_word(list, morph_word(0, at.wrapping_mul(37) % (MORPH_STEPS + 1))),
    };
    (0..count as u32).map(decision).collect()
}

#[cfg(test)]
mod tests;

/// Measures scenes of one object, seen by a perspective.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SelectPass::new(gpu)?;
    let [(_, view), ..] = frame()?;
    for blocks in [16, 1_600] {
        let Blocks { objects, block_objects } = Blocks::new(0, &[blocks - 1]);
        let view = SelectView { blocks, ..view };
        let count = 64 * blocks as usize;
        let instances: Vec<_> = random_instances(1, 1024).into_iter().cycle().take(count).collect();
        let decisions = Buffer::new(gpu, "decisions", count)?;
        let buffers = SelectBuffers {
            view: &Uniform::new(gpu, "view", &view)?,
            objects: &Buffer::from_slice(gpu, "objects", &objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &block_objects)?,
            instances: &Buffer::from_slice(gpu, "instances", &instances)?,
            allowed: &Buffer::new(gpu, "allowed", count)?,
            decisions: &decisions,
            placements: &Buffer::new(gpu, "placements", count)?,
            counts: &Buffer::new(gpu, "counts", (OBJECT_LISTS * blocks) as usize)?,
            last_decisions: &Buffer::new(gpu, "last decisions", count)?,
        };
        let job = pass.prepare(gpu, buffers)?;
        let seen = instances.iter().filter(|instance| select(&view, &objects[0], instance).is_some()).count();
        // The kernel reads 18 of an instance's words and a decision and writes three, and the placements of those that are seen.
        let words = 22 * count + 12 * seen;
        let case = format!("{count} instances, {seen} seen");
        measure(bench, case, (count, "instance"), words, &|encoder| job.record(encoder), || {
            instances.iter().map(|instance| select(&view, &objects[0], instance)).collect::<Vec<_>>()
        })?;
    }
    Ok(())
}
