//! Parity and benchmark cases of `kernels/animation/clip_clock.wgsl`.

use relievo::Error;
use relievo::ops::animation::clip_clock::reference::{PlayedCrowd, clip_clocks};
use relievo::ops::animation::clip_clock::{ClipClock, ClipClockPass};
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::gate_state::GateState;
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::keyframe_cursor::reference::cursors;
use relievo::ops::animation::layers::AnimationLayer;
use relievo::ops::animation::lod::{BoneSampling, Lod};

use crate::cases::animation::scene::{CROWDS, Scene};
use crate::cases::animation::{Draw, SIZES, random_crowd};
use crate::cases::measure;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases, compare};

/// The cases cover a sequence of frames: the first one, hidden and refreshed instances, changed clips and
/// layers, and a leap of many turns. Times and clips are multiples of 1/64 s, so that all devices agree on
/// every key; a fraction may differ by 1, from the rounding of its division.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = ClipClockPass::new(gpu)?;
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let mut draw = Draw::new(case as u32 ^ 0xfa5e);
        let (_, set, mut instances) = random_crowd(case as u32, bones, count)?;
        // Every third case has layers.
        let layer = |draw: &mut Draw| {
            AnimationLayer::new(
                instances.clone(),
                (0..count).map(|_| (draw.word() % 3) as f32 / 2.0).collect(),
            )
        };
        let mut layers: Vec<AnimationLayer> = (0..case % 3).map(|_| layer(&mut draw)).collect();
        let crowd = Crowd::layered(gpu, &set, &instances, &layers)?;
        let clips = ClipBuffers::new(gpu, &set)?;
        let mut state = GateState::new(gpu, &crowd)?;
        let output = Poisoned::<ClipClock>::new(gpu, count)?;
        state.clip_clocks = output.buffer.clone();
        let mut history = vec![[0; 4]; count];
        for (frame, elapsed) in [0.0, 0.25, 0.5, 300.0, 300.25].into_iter().enumerate() {
            let choose = |draw: &mut Draw| match draw.word() % 8 {
                0 => BoneSampling::Hidden,
                1 => BoneSampling::Forced,
                _ => BoneSampling::Gated,
            };
            let lods: Vec<Lod> = (0..count)
                .map(|_| match frame {
                    0 => Lod::FULL,
                    _ => Lod { sampling: choose(&mut draw), tier: draw.word() % 8 / 7, ..Lod::FULL },
                })
                .collect();
            for instance in &mut instances {
                let start = (draw.word() % 4096) as f32 / 64.0 - 32.0;
                let clip = if draw.word().is_multiple_of(8) { draw.word() % 3 } else { instance.clip };
                *instance =
                    Instance { clip, start, rate: [1.0, -1.0, 0.5][draw.word() as usize % 3], ..*instance };
            }
            for (at, layer) in layers.iter_mut().enumerate() {
                layer.weights.iter_mut().for_each(|weight| *weight = (draw.word() % 4 / 3) as f32);
                crowd.set_weights(gpu, at + 1, &layer.weights)?;
            }
            crowd.instances.write_at(gpu, 0, &instances)?;
            state.write_lods(gpu, &lods)?;
            output.poison(gpu)?;
            let job = pass.prepare(gpu, &clips, &crowd, &state)?;
            let ahead = [0.0, 0.25, -0.5, 1.0, 0.125][frame];
            job.set(gpu, elapsed, ahead)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let played = PlayedCrowd {
                set: &set,
                instances: &instances,
                layers: &layers,
                lods: &lods,
                elapsed,
                ahead,
            };
            let expected = clip_clocks(&played, &mut history);
            let near = |actual: &[ClipClock]| compare::exact(&settled(actual, &expected), &expected);
            cases.check(format!("{bones} bones × {count}, frame {frame}"), &output, near).await?;
        }
        let kept = compare::exact(&state.history.read(gpu).await?, &history);
        cases.add(format!("{bones} bones × {count}, history"), kept);
    }
    Ok(())
}

/// The clip clocks, with those whose fractions differ from the expected ones by 1 replaced by the expected
/// ones.
pub(crate) fn settled(actual: &[ClipClock], expected: &[ClipClock]) -> Vec<ClipClock> {
    let settle = |(actual, expected): (&ClipClock, &ClipClock)| {
        let is_near = actual.fraction().abs_diff(expected.fraction()) <= 1
            && actual.ahead_fraction.abs_diff(expected.ahead_fraction) <= 1;
        let ClipClock { fraction_and_reason, ahead_fraction, .. } = *expected;
        let same = ClipClock { fraction_and_reason, ahead_fraction, ..*actual };
        if is_near && actual.reason() == expected.reason() { same } else { *actual }
    };
    actual.iter().zip(expected).map(settle).collect()
}

/// Measures every instance of a crowd.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = ClipClockPass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let state = GateState::new(gpu, &scene.crowd)?;
        let found = cursors(&scene.set, &scene.instances, 0.4);
        scene.crowd.cursors.write(gpu, &found)?;
        let job = pass.prepare(gpu, &scene.clips, &scene.crowd, &state)?;
        job.set(gpu, 0.4, 0.0)?;
        // The kernel reads 12 words and writes 6 per instance.
        let (lods, mut history) = (vec![Lod::FULL; count], vec![[0; 4]; count]);
        let name = format!("{count} instances");
        measure(bench, name, count, "instance", 18 * count, &|encoder| job.record(encoder), || {
            let (set, instances) = (&scene.set, &scene.instances);
            let played = PlayedCrowd { set, instances, layers: &[], lods: &lods, elapsed: 0.4, ahead: 0.0 };
            clip_clocks(&played, &mut history)
        })?;
    }
    Ok(())
}
