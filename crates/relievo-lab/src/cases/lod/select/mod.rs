//! Parity and benchmark cases of `kernels/lod/select.wgsl`.

use glam::{Vec3, Vec4};
use relievo::Error;
use relievo::asset::Affine;
use relievo::gpu::{Buffer, Gpu, GpuError, Uniform};
use relievo::ops::lod::allowed::allowed_by;
use relievo::ops::lod::select::reference::{depth_inside, is_shown, placed_sphere, select};
use relievo::ops::lod::select::{Allowed, SelectBuffers, SelectPass, UNSEEN_ALLOWED};
use relievo::ops::lod::{BLOCK, INSTANCE_ALIVE, LodCamera, LodObject, SceneInstance, SelectView};
use relievo::shared::lod::criterion::{
    CRITERION_BOX, CRITERION_DISTANCE, CRITERION_ERROR, CRITERION_NEAREST, MAX_METRIC,
};
use relievo::shared::lod::object::{
    UNSEEN_METRIC, decision_word, metric_bits, metric_mirrored, object_flags_criterion,
    object_flags_never_culled,
};
use relievo::shared::lod::view::POSITION_SLACK;

use crate::cases::lod::{Blocks, CELL, EYE, SIZES, frame, random_instances};
use crate::cases::measure;
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases};

/// How far rounding may move an allowed displacement beyond what it does to positions: kernel and reference
/// round some 40 times each, by at most 2⁻²³.
const FORMULA: f32 = 1e-5;

/// The largest error of a row's component: 18 · 2⁻²⁴ of the scale.
const AXES_BOUND: f32 = 1.1e-6;

/// The largest error of a position: 4 · 2⁻²⁴ of the lengths that are added.
const POSITION_BOUND: f32 = 2.4e-7;

/// The fraction of instances for which rounding may decide either way.
const MAY_TOUCH: f64 = 1.0 / 200.0;

/// The fraction of instances whose metric rounding may change by more than a fifth: boxes that are never culled and reach the
/// near plane.
const BOXES_MAY_TOUCH: f64 = 1.0 / 20.0;

/// The cases cover one object and several, with all criteria, with perceptual factors, one without instances, one that is not
/// shown and some that are never culled, blocks of no object and blocks beyond the view's, and the four views of a frame one
/// after another. Where rounding may decide either way, both results are accepted and counted.
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
        let mut instances = random_instances(case, BLOCK as usize * blocks.block_objects.len());
        let hidden = instances.iter_mut().enumerate().filter(|(at, _)| is_hidden(*at));
        hidden.for_each(|(_, instance)| instance.flags &= !INSTANCE_ALIVE);
        // A third of the boxes is near the eye, where their near faces appear larger than their far ones.
        let is_box = |at: usize| {
            let object = blocks.object_of(at);
            object.is_some_and(|object| object_flags_criterion(object.flags) == CRITERION_BOX)
        };
        for (_, instance) in instances.iter_mut().enumerate().filter(|(at, _)| at % 3 == 0 && is_box(*at)) {
            instance.cell = CELL.to_array();
            instance.offset = EYE.lerp(instance.offset.into(), 0.1).to_array();
        }
        Self { blocks, instances }
    }

    /// The instances on the device: those that the reference must not see are alive there, but not shown.
    fn uploaded(&self) -> Vec<SceneInstance> {
        let alive = |(at, instance): (usize, &SceneInstance)| match is_hidden(at) {
            true => SceneInstance { flags: instance.flags | INSTANCE_ALIVE, ..*instance },
            false => *instance,
        };
        self.instances.iter().enumerate().map(alive).collect()
    }

    /// The object of an instance, if its block is one of the view's.
    fn object_of(&self, view: &SelectView, instance: usize) -> Option<&LodObject> {
        self.blocks.object_of(instance).filter(|_| instance < (BLOCK * view.blocks) as usize)
    }
}

/// The outputs on the device.
struct Outputs {
    allowed: Poisoned<Allowed>,
    metrics: Poisoned<u32>,
    placements: Poisoned<Affine>,
}

/// What the kernel wrote.
#[derive(Clone, PartialEq, Default)]
struct Found {
    allowed: Vec<Allowed>,
    metrics: Vec<u32>,
    placements: Vec<Affine>,
}

impl Outputs {
    fn new(gpu: &Gpu, instances: usize) -> Result<Self, GpuError> {
        Ok(Self {
            allowed: Poisoned::new(gpu, instances)?,
            metrics: Poisoned::new(gpu, instances)?,
            placements: Poisoned::new(gpu, instances)?,
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
        self.metrics.poison(gpu)?;
        self.placements.buffer.write(gpu, &last_placements(&scene.instances))?;
        let buffers = SelectBuffers {
            view: &Uniform::new(gpu, "view", view)?,
            objects: &Buffer::from_slice(gpu, "objects", &scene.blocks.objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &scene.blocks.block_objects)?,
            instances: &Buffer::from_slice(gpu, "instances", &scene.uploaded())?,
            allowed: &self.allowed.buffer,
            metrics: &self.metrics.buffer,
            placements: &self.placements.buffer,
            decisions: &Buffer::from_slice(gpu, "decisions", &last_decisions(scene.instances.len()))?,
            shown: &Buffer::from_slice(gpu, "shown", &shown_bits(scene.instances.len()))?,
        };
        let job = SelectPass::new(gpu)?.prepare(gpu, buffers)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let end = |output| format!("{name}: the end of {output}");
        Ok(Found {
            allowed: cases.values(end("allowed"), &self.allowed).await?,
            metrics: cases.values(end("metrics"), &self.metrics).await?,
            placements: cases.values(end("placements"), &self.placements).await?,
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
    /// Displacement and distance lie between these.
    Within([f32; 2], [f32; 2]),
}

/// What may be found of an instance, whichever way rounding goes.
struct Range {
    may_be_unseen: bool,
    may_be_seen: bool,
    metric: [f32; 2],
    allowed: [f32; 2],
    distance: [f32; 2],
}

impl Range {
    /// The displacement that a camera allows, and how far a sphere reaches into the view volume, change with the sphere's
    /// radius at least as much as with the rounding of its center; so two radii bound what rounding may decide. Other
    /// metrics change by the rounding of the center at the instance's depth.
    fn of(view: &SelectView, object: &LodObject, instance: &SceneInstance, last: Option<&Affine>) -> Self {
        let (center, radius) = placed_sphere(instance, view.cell);
        let scale = instance.largest_scale();
        let farthest = view.cameras().iter().map(|camera| camera.eye.length()).fold(0.0, f32::max);
        let farthest = view.planes.iter().map(|plane| plane.w.abs()).fold(farthest, f32::max);
        let lengths = 2.0 * (instance.position(view.cell).length() + center.length() + radius + farthest);
        let slack = 2.0 * POSITION_SLACK * lengths;
        let [less, more] =
            [radius + slack, radius - slack].map(|radius| allowed_by(view.cameras(), center, radius, scale));
        let allowed = [less * (1.0 - FORMULA), more * (1.0 + FORMULA)];
        let eye = |camera: &LodCamera| camera.perspective * center.distance(camera.eye);
        let distance = view.cameras().iter().map(eye).fold(MAX_METRIC, f32::min);
        let is_shown = is_shown(view, object, instance);
        let is_culled = object_flags_never_culled(object.flags) == 0;
        let never = SelectView { planes: [Vec4::W; 6], ..*view };
        let metric = select(&never, object, instance, last).map_or(0.0, |selected| selected.metric);
        // The part of itself by which a length on the screen changes.
        let is_box = object_flags_criterion(object.flags) == CRITERION_BOX;
        let part_of = |camera: &LodCamera| {
            let reach = if is_box { radius } else { 0.0 };
            let depth = camera.ahead.dot(center - camera.eye);
            match camera.perspective == 0.0 || !is_box && depth + slack < camera.near {
                true => 0.0,
                false => 4.0 * slack / (depth - reach - slack).max(camera.near),
            }
        };
        let part_on_screen = view.cameras().iter().map(part_of).fold(0.0, f32::max);
        let factor = perceptual_slack(view, object, center, slack);
        let metric = match object_flags_criterion(object.flags) {
            CRITERION_ERROR if metric > 0.0 => {
                let [least, most] = allowed.map(|allowed| allowed * metric / less.max(1e-30));
                [least * (1.0 - factor), most.max(metric) * (1.0 + factor)]
            }
            CRITERION_ERROR => [0.0, object.metric_scale * more * (1.0 + factor + 5.0)],
            CRITERION_DISTANCE..=CRITERION_NEAREST => {
                [metric * (1.0 - factor) - 4.0 * slack, metric * (1.0 + factor) + 4.0 * slack]
            }
            _ => {
                let part = 1e-4 + factor + part_on_screen;
                if part < 0.2 { [metric * (1.0 - part), metric * (1.0 + part)] } else { [0.0, MAX_METRIC] }
            }
        };
        Self {
            may_be_seen: is_shown && (!is_culled || depth_inside(view, center, radius + slack) >= 0.0),
            may_be_unseen: !is_shown || is_culled && depth_inside(view, center, radius - slack) < 0.0,
            metric,
            allowed,
            distance: [distance - slack, distance + slack],
        }
    }

    /// Whether rounding may decide either way.
    fn touches(&self) -> bool {
        self.may_be_seen && (self.may_be_unseen || self.metric[1] == MAX_METRIC)
    }

    /// Whether a metric word is one of those that are right.
    fn permits(&self, word: u32, instance: &SceneInstance) -> bool {
        if word == UNSEEN_METRIC {
            return self.may_be_unseen;
        }
        let metric = f32::from_bits(metric_bits(word));
        let is_right = metric_mirrored(word) == u32::from(instance.is_mirrored());
        self.may_be_seen && is_right && (self.metric[0]..=self.metric[1]).contains(&metric)
    }
}

/// The fraction by which rounding may change the perceptual factor.
fn perceptual_slack(view: &SelectView, object: &LodObject, center: Vec3, slack: f32) -> f32 {
    if object.motion == 0.0 && object.periphery == 0.0 {
        return 1e-5;
    }
    let [x, y, w] = view.clip_rows.map(|row| row.dot(center.extend(1.0)));
    let most = 4.0 * object.motion + object.periphery;
    if w <= 0.0 {
        return most;
    }
    // The last frame's place may be behind the eye, too.
    let length = 1.0 + (x.hypot(y) / w);
    let position = 8.0 * slack * view.clip_rows[0].truncate().length() * length / w;
    (1e-4 + (object.motion / view.seconds + object.periphery) * position).min(most)
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
    ) -> [(&'static str, Comparison); 3] {
        [
            ("metrics", self.compared_metrics(scene, view)),
            ("placements", self.compared_placements(scene, view)),
            ("allowed", self.compared_allowed(scene, view, state)),
        ]
    }

    fn compared_metrics(&self, scene: &Scene, view: &SelectView) -> Comparison {
        let (placements, decisions) = (last_placements(&scene.instances), last_decisions(self.metrics.len()));
        let last = |index: usize| (decisions[index] != 0).then_some(&placements[index]);
        let judge = |(index, word): (usize, &u32)| match scene.object_of(view, index) {
            None => judgement(*word == POISON, false),
            Some(object) => {
                let instance = &scene.instances[index];
                let range = Range::of(view, object, instance, last(index));
                judgement(range.permits(*word, instance), range.touches())
            }
        };
        let judgements: Vec<Judgement> = self.metrics.iter().enumerate().map(judge).collect();
        each(&judgements, "wrong metrics", BOXES_MAY_TOUCH, |index| {
            let expected = scene
                .object_of(view, index)
                .map(|object| select(view, object, &scene.instances[index], last(index)));
            let found = f32::from_bits(metric_bits(self.metrics[index]));
            format!("{:#x} ({found}) instead of {expected:?}", self.metrics[index])
        })
    }

    fn compared_placements(&self, scene: &Scene, view: &SelectView) -> Comparison {
        let mut judgements = Vec::with_capacity(12 * self.placements.len());
        let before = last_placements(&scene.instances);
        for (index, rows) in self.placements.iter().enumerate() {
            let instance = &scene.instances[index];
            if !self.is_seen(scene, view, index) {
                let values = rows.as_flattened().iter().zip(before[index].as_flattened());
                judgements.extend(
                    values.map(|(value, before)| judgement(value.to_bits() == before.to_bits(), false)),
                );
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

    fn is_seen(&self, scene: &Scene, view: &SelectView, index: usize) -> bool {
        self.metrics[index] != UNSEEN_METRIC && scene.object_of(view, index).is_some()
    }

    fn compared_allowed(&self, scene: &Scene, view: &SelectView, state: &mut [State]) -> Comparison {
        let mut judgements = Vec::with_capacity(self.allowed.len());
        for (index, allowed) in self.allowed.iter().enumerate() {
            if let Some(object) = scene.object_of(view, index) {
                let Range { allowed, distance, .. } = Range::of(view, object, &scene.instances[index], None);
                let [low, high] = [0, 1].map(|end| [allowed[end], distance[end]]);
                let less = |a: [f32; 2], b: [f32; 2]| [a[0].min(b[0]), a[1].min(b[1])];
                let before = if view.is_first == 0 { state[index] } else { State::Unseen };
                state[index] = match (before, self.is_seen(scene, view, index)) {
                    (before, false) => before,
                    (State::Within(l, h), _) => State::Within(less(l, low), less(h, high)),
                    _ => State::Within(low, high),
                };
            }
            judgements.push(match state[index] {
                State::Untouched => judgement(allowed.displacement.to_bits() == POISON, false),
                State::Unseen => judgement(allowed.displacement == UNSEEN_ALLOWED, false),
                State::Within(low, high) => {
                    let is_within = (low[0]..=high[0]).contains(&allowed.displacement)
                        && (low[1]..=high[1]).contains(&allowed.distance);
                    judgement(is_within, high[0] > 1.01 * low[0])
                }
            });
        }
        each(&judgements, "wrong displacements", 4.0 * MAY_TOUCH, |at| {
            format!("{:?} instead of {:?} of instance {at}", self.allowed[at], state[at])
        })
    }
}

/// Whether an instance is not shown in the views.
fn is_hidden(index: usize) -> bool {
    index % 11 == 3
}

/// The bits of the instances that are shown.
fn shown_bits(count: usize) -> Vec<u32> {
    let word = |word: usize| (0..32).fold(0, |bits, at| bits | u32::from(!is_hidden(32 * word + at)) << at);
    (0..count / 32).map(word).collect()
}

/// Decisions of a frame before: of every seventh instance none.
fn last_decisions(count: usize) -> Vec<u32> {
    (0..count as u32).map(|at| decision_word(u32::from(at % 7 > 0), 0, 0, 0, 0)).collect()
}

/// Placements of a frame before: instances were a little aside.
fn last_placements(instances: &[SceneInstance]) -> Vec<Affine> {
    let placement = |(at, instance): (usize, &SceneInstance)| {
        let ([x, y, z], origin) = (instance.axes(), instance.position(CELL));
        let aside = 0.5 * (at % 5) as f32;
        std::array::from_fn(|axis| [x[axis], y[axis], z[axis], origin[axis] + aside])
    };
    instances.iter().enumerate().map(placement).collect()
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
        let buffers = SelectBuffers {
            view: &Uniform::new(gpu, "view", &view)?,
            objects: &Buffer::from_slice(gpu, "objects", &objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &block_objects)?,
            instances: &Buffer::from_slice(gpu, "instances", &instances)?,
            allowed: &Buffer::new(gpu, "allowed", count)?,
            metrics: &Buffer::new(gpu, "metrics", count)?,
            placements: &Buffer::new(gpu, "placements", count)?,
            decisions: &Buffer::new(gpu, "decisions", count)?,
            shown: &Buffer::from_slice(gpu, "shown", &vec![u32::MAX; count / 32])?,
        };
        let job = pass.prepare(gpu, buffers)?;
        let seen =
            instances.iter().filter(|instance| select(&view, &objects[0], instance, None).is_some()).count();
        // The kernel reads 18 of an instance's words and writes two, and the placements of those that are seen.
        let words = 20 * count + 12 * seen;
        let case = format!("{count} instances, {seen} seen");
        measure(bench, case, count, "instance", words, &|encoder| job.record(encoder), || {
            instances.iter().map(|instance| select(&view, &objects[0], instance, None)).collect::<Vec<_>>()
        })?;
    }
    Ok(())
}
