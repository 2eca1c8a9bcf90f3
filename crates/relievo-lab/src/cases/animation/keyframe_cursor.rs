//! Parity and benchmark cases of `kernels/animation/keyframe_cursor.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::keyframe::KeyframeCursor;
use relievo::ops::animation::active::Active;
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::gate_state::GateState;
use relievo::ops::animation::instance::{Instance, Wrap};
use relievo::ops::animation::keyframe_cursor::reference::{cursors, cursors_into, inside_clip};
use relievo::ops::animation::keyframe_cursor::{KEYFRAME_CURSOR_BOUND, KeyframeCursorPass};
use relievo::ops::animation::layers::{AnimationLayer, all_instances};
use relievo::ops::animation::order::Order;

use crate::cases::animation::edges::{ELAPSED, edges};
use crate::cases::animation::scene::{CROWDS, ELAPSED as MEASURED, Scene};
use crate::cases::animation::{SIZES, random_crowd, random_instances, random_skeleton};
use crate::cases::measure;
use crate::harness::compare::Comparison;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases, compare};

/// The cases cover every kind of timeline, loops, clamps, reverse play, and clips of 0 seconds, at the start
/// and later. Cursors of timelines that a clip does not have must stay unchanged.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = KeyframeCursorPass::new(gpu)?;
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (_, set, instances) = random_crowd(case as u32, bones, count)?;
        let clips = ClipBuffers::new(gpu, &set)?;
        for elapsed in [0.0, 1.375, -3.0] {
            let mut crowd = Crowd::new(gpu, &set, &instances)?;
            let rooms = crowd.cursors.len();
            let output = Poisoned::<KeyframeCursor>::new(gpu, rooms)?;
            crowd.cursors = output.buffer.clone();
            let job = pass.prepare(gpu, &clips, &crowd)?;
            job.set(gpu, elapsed)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let mut expected = cursors(&set, &instances, elapsed);
            let used = expected.len();
            // Nothing is sampled ahead.
            expected.resize(rooms, KeyframeCursor::default());
            let room = set.timelines_a_clip();
            let is_used = |at: usize| {
                at < used && at % room < set.clips()[instances[at / room].clip as usize].timelines as usize
            };
            let name = format!("{bones} bones × {count} after {elapsed} s");
            cases.check(name, &output, |actual| compare_cursors(actual, &expected, is_used)).await?;
        }
    }
    at_edges(cases, &pass).await?;
    nowhere(cases, &pass).await?;
    far_away(cases, &pass).await?;
    of_a_list(cases, &pass).await
}

/// Compares listed instances with their layers, at the times that gates saw, and at the times ahead; the
/// cursors of others must stay unchanged.
async fn of_a_list(cases: &mut Cases<'_>, pass: &KeyframeCursorPass) -> Result<(), Error> {
    let gpu = cases.gpu;
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (skeleton, set, base) = random_crowd(case as u32, bones, count)?;
        let layer = AnimationLayer::new(random_instances(case as u32 + 50, &set, count), vec![0.5; count]);
        let layers = vec![layer; case % 3];
        let mut crowd = Crowd::layered(gpu, &set, &base, &layers)?;
        let rooms = crowd.cursors.len();
        let output = Poisoned::<KeyframeCursor>::new(gpu, rooms)?;
        crowd.cursors = output.buffer.clone();
        let (clips, order) = (ClipBuffers::new(gpu, &set)?, Order::new(&skeleton));
        let state = GateState::new(gpu, &crowd)?;
        let active = Active::new(gpu, &order, &crowd)?;
        // Every third instance is listed, and the times that the gate saw differ from the clock.
        let listed: Vec<u32> = (0..count as u32).step_by(3).collect();
        active.instances.write(gpu, &listed)?;
        let room = set.timelines_a_clip();
        let threads = listed.len() * room * (2 + layers.len());
        let mut dispatches = active.dispatches.read(gpu).await?;
        dispatches[0][3] = listed.len() as u32;
        *dispatches.last_mut().expect("two") = [threads.div_ceil(64) as u32, 1, 1, 0];
        active.dispatches.write(gpu, &dispatches)?;
        let seen: Vec<f32> = base
            .iter()
            .map(|instance| inside_clip(instance.wrap(), set.clips()[instance.clip as usize].duration, 1.25))
            .collect();
        // Every second listed instance has a different time when it is sampled ahead.
        let ahead: Vec<f32> = (seen.iter().enumerate())
            .map(|(at, time)| if at.is_multiple_of(6) { 0.75 * time } else { *time })
            .collect();
        let history = seen.iter().zip(&ahead).map(|(now, later)| [1, 0, now.to_bits(), later.to_bits()]);
        state.history.write(gpu, &history.collect::<Vec<_>>())?;
        let job = pass.prepare_active(gpu, &clips, &crowd, &state, &active)?;
        job.set(gpu, 0.5)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let all = all_instances(&base, &layers);
        let mut expected = cursors(&set, &all, 0.5);
        let first_ahead = expected.len();
        expected.resize(rooms, KeyframeCursor::default());
        for instance in listed.iter().map(|at| *at as usize) {
            for (first, time) in [(0, seen[instance]), (first_ahead, ahead[instance])] {
                let seen = Instance::new(base[instance].clip, Wrap::Clamp, time, 0.0);
                expected[first + instance * room..][..room].copy_from_slice(&cursors(&set, &[seen], 0.0));
            }
        }
        let is_used = |at: usize| {
            let instance = at / room % count;
            let playing = if at < first_ahead { &all[at / room] } else { &base[instance] };
            let is_looked_up = at < first_ahead || seen[instance] != ahead[instance];
            let is_listed = instance.is_multiple_of(3) && is_looked_up;
            is_listed && at % room < set.clips()[playing.clip as usize].timelines as usize
        };
        let name = format!("every third of {count}, {bones} bones, {} layers", 1 + layers.len());
        cases.check(name, &output, |actual| compare_cursors(actual, &expected, is_used)).await?;
    }
    Ok(())
}

/// Compares the cursors that are used, and expects poison elsewhere.
fn compare_cursors(
    actual: &[KeyframeCursor],
    expected: &[KeyframeCursor],
    is_used: impl Fn(usize) -> bool,
) -> Comparison {
    // Unused cursors compare as −1.
    let used = |cursor: &KeyframeCursor| match cursor.key == POISON {
        true if cursor.fraction.to_bits() == POISON => -1.0,
        _ => clip_clock(cursor),
    };
    let expected: Vec<f32> = (expected.iter().enumerate())
        .map(|(at, cursor)| if is_used(at) { used(cursor) } else { -1.0 })
        .collect();
    let actual: Vec<f32> = actual.iter().map(used).collect();
    compare::absolute(&actual, &expected, KEYFRAME_CURSOR_BOUND)
}

/// Loop times too large to resolve, up to infinity, give the clip's start, and clamped ones its end.
async fn nowhere(cases: &mut Cases<'_>, pass: &KeyframeCursorPass) -> Result<(), Error> {
    let set = edges()?.set;
    let far = [(1e8, 1.0), (-1e8, 1.0), (1.0, 1e9), (0.0, f32::MAX), (0.0, -f32::MAX)];
    let play = |wrap: Wrap| far.map(|(start, rate)| Instance::new(0, wrap, start, rate));
    let instances = [play(Wrap::Loop), play(Wrap::Clamp)].concat();
    let (at_start, at_end) =
        (Instance::new(0, Wrap::Clamp, 0.0, 0.0), Instance::new(0, Wrap::Clamp, 1.0, 0.0));
    let of = |instance: &Instance| match (instance.wrap(), instance.start < 0.0 || instance.rate < 0.0) {
        (Wrap::Clamp, false) => at_end,
        // 1e9 s at rate 1 outweigh the start.
        (Wrap::Clamp, true) if instance.rate > 0.0 => at_end,
        _ => at_start,
    };
    let known = cursors(&set, &instances.iter().map(of).collect::<Vec<_>>(), 0.0);
    let known: Vec<f32> = known.iter().map(clip_clock).collect();
    beyond(cases, pass, "nowhere in the clip", &set, &instances, 1e9, &known).await
}

/// Compares loops of 8 s after millions of turns, which an f32 still resolves to 2 s.
async fn far_away(cases: &mut Cases<'_>, pass: &KeyframeCursorPass) -> Result<(), Error> {
    let skeleton = random_skeleton(0, 1)?;
    let values = vec![[0.0; 4], [1.0, 0.0, 0.0, 0.0]];
    let keys = Keys { times: vec![0.0, 8.0], values, interpolation: Interpolation::Linear };
    let bone = BoneKeys { translation: Some(keys), ..BoneKeys::default() };
    let set = ClipSet::new(&[&Clip::new("eight seconds", &skeleton, &[bone], 0.0)?])?;
    let seconds = [20_000_006.0, -20_000_006.0, 16_777_218.0];
    let instances = seconds.map(|start| Instance::new(0, Wrap::Loop, start, 0.0));
    beyond(cases, pass, "after millions of turns", &set, &instances, 0.0, &[0.75, 0.25, 0.25]).await
}

/// Compares instances whose times are beyond those of valid ones with known keys and fractions, on the device and by the reference.
/// They are written to the device's buffer.
async fn beyond(
    cases: &mut Cases<'_>,
    pass: &KeyframeCursorPass,
    name: &str,
    set: &ClipSet,
    instances: &[Instance],
    elapsed: f32,
    known: &[f32],
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let still = vec![Instance::new(0, Wrap::Loop, 0.0, 0.0); instances.len()];
    let (clips, crowd) = (ClipBuffers::new(gpu, set)?, Crowd::new(gpu, set, &still)?);
    crowd.instances.write(gpu, instances)?;
    let job = pass.prepare(gpu, &clips, &crowd)?;
    job.set(gpu, elapsed)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let references = cursors(set, instances, elapsed);
    let found = crowd.cursors.read(gpu).await?;
    let actual: Vec<f32> = found[..references.len()].iter().chain(&references).map(clip_clock).collect();
    cases.add(name, compare::absolute(&actual, &known.repeat(2), KEYFRAME_CURSOR_BOUND));
    Ok(())
}

/// A key and the fraction after it, as one number.
fn clip_clock(cursor: &KeyframeCursor) -> f32 {
    cursor.key as f32 + cursor.fraction
}

/// Compares cursors that are known without a reference.
async fn at_edges(cases: &mut Cases<'_>, pass: &KeyframeCursorPass) -> Result<(), Error> {
    let (gpu, edges) = (cases.gpu, edges()?);
    let (clips, crowd) = (ClipBuffers::new(gpu, &edges.set)?, Crowd::new(gpu, &edges.set, &edges.instances)?);
    let job = pass.prepare(gpu, &clips, &crowd)?;
    job.set(gpu, ELAPSED)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let found = crowd.cursors.read(gpu).await?;
    let (mut actual, mut expected) = (Vec::new(), Vec::new());
    for (found, known) in found.chunks(edges.set.timelines_a_clip()).zip(edges.cursors()) {
        actual.extend(found[..known.len()].iter().map(clip_clock));
        expected.extend(known.iter().map(clip_clock));
    }
    cases.add("edges", compare::absolute(&actual, &expected, KEYFRAME_CURSOR_BOUND));
    Ok(())
}

/// Measures one timeline per instance, which all tracks share.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = KeyframeCursorPass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let job = pass.prepare(gpu, &scene.clips, &scene.crowd)?;
        job.set(gpu, MEASURED)?;
        // The kernel reads an instance and four times, and writes a cursor: 10 words.
        let mut cursors = vec![KeyframeCursor::default(); count];
        let name = format!("{count} instances");
        measure(bench, name, count, "instance", 10 * count, &|encoder| job.record(encoder), || {
            cursors_into(&scene.set, &scene.instances, MEASURED, black_box(&mut cursors));
        })?;
    }
    Ok(())
}
