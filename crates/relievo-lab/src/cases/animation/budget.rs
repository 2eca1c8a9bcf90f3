//! Parity and benchmark cases of `kernels/animation/budget.wgsl`.

use relievo::Error;
use relievo::asset::keyframe::RotationPath;
use relievo::gpu::Buffer;
use relievo::ops::animation::Gate;
use relievo::ops::animation::active::Active;
use relievo::ops::animation::budget::BudgetPass;
use relievo::ops::animation::budget::reference::budget;
use relievo::ops::animation::clip_clock::{ClipClock, UpdateReason};
use relievo::ops::animation::crowd::Crowd;
use relievo::ops::animation::gate_state::GateState;
use relievo::ops::animation::gate_table::ExpectationTable;
use relievo::ops::animation::lod::Lod;
use relievo::ops::animation::order::Order;

use crate::cases::animation::gate::random_state;
use crate::cases::animation::scene::{CROWDS, Scene};
use crate::cases::animation::{Draw, SIZES, random_clips, tiered_crowd};
use crate::cases::measure;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// The cases cover sequences of frames, budgets from 0 to more than all bones, and weights of every size, also
/// equal ones, which give many bones the same rank. The integer results must be equal to the bit.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    for (case, [bones, count]) in SIZES.into_iter().chain([[5, 1000]]).enumerate() {
        let case = case as u32;
        let (skeleton, set, instances) = tiered_crowd(case, bones, count)?;
        let clips = random_clips(case, &skeleton, 3)?;
        let clips: Vec<_> = clips.iter().collect();
        let crowd = Crowd::new(gpu, &set, &instances)?;
        let bone_radii = vec![0.5; bones];
        let order = Order::new(&skeleton);
        let table = ExpectationTable::new(&skeleton, &set, &clips, &bone_radii, RotationPath::Slerp)?;
        let mut gate = Gate::Budget { table, bones: u32::MAX };
        if case % 3 == 1 {
            gate.never_skip(&order, &(0..bones).map(|bone| bone % 4 == 1).collect::<Vec<_>>())?;
        }
        let Gate::Budget { table, .. } = gate else { continue };
        let mut state = GateState::new(gpu, &crowd)?;
        let mut active = Active::new(gpu, &order, &crowd)?;
        let output = Poisoned::<u32>::new(gpu, 2 * count * order.words())?;
        active.bits = output.buffer.clone();
        let sums = Poisoned::<u32>::new(gpu, bones * count)?;
        state.sampled = sums.buffer.clone();
        let mut sampled = vec![0; bones * count];
        sums.buffer.write(gpu, &sampled)?;
        let job = BudgetPass::new(gpu, &table, u32::MAX)?.prepare(gpu, &crowd, &state, &active)?;
        let mut draw = Draw::new(case ^ 0xb0d6);
        let pairs = (bones * count) as u32;
        for (frame, most) in [pairs, pairs / 2, 0, pairs / 3 + 1, pairs - 1, u32::MAX].into_iter().enumerate()
        {
            let (mut lods, clip_clocks) = random_state(&mut draw, &set, &order, count, frame == 0);
            let weight = |draw: &mut Draw| draw.word() >> (16 + draw.word() % 17).min(31);
            lods.iter_mut()
                .for_each(|lod| lod.weight = if frame % 2 == 0 { 65535 } else { weight(&mut draw) });
            state.write_lods(gpu, &lods)?;
            state.clip_clocks.write(gpu, &clip_clocks)?;
            job.set(gpu, most)?;
            output.poison(gpu)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let mut expected = budget(&table, most, &lods, &clip_clocks, &mut sampled);
            // No bone is sampled ahead.
            expected.resize(2 * count * order.words(), 0);
            let name = format!("{most} of {bones} bones × {count}, frame {frame}");
            cases.exact(name, &output, &expected).await?;
        }
        let name = format!("{bones} bones × {count}, sums of motion");
        cases.exact(name, &sums, &sampled).await?;
    }
    Ok(())
}

/// Measures a budget of half of the bones.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let (bones, pairs) = (scene.skeleton.len(), scene.pairs());
        let table = ExpectationTable::new(
            &scene.skeleton,
            &scene.set,
            &[&scene.clip],
            &vec![0.1; bones],
            RotationPath::Slerp,
        )?;
        let state = GateState::new(gpu, &scene.crowd)?;
        let active = Active::new(gpu, &scene.order(), &scene.crowd)?;
        let lods = vec![Lod::FULL; count];
        let rows = scene.set.rows(&scene.set.clips()[0]) - 1;
        let clip_clock =
            |instance: u32| ClipClock::new(instance % rows, instance % 65536, UpdateReason::Free, 0);
        let clip_clocks: Vec<ClipClock> = (0..count as u32).map(clip_clock).collect();
        state.clip_clocks.write(gpu, &clip_clocks)?;
        let most = pairs as u32 / 2;
        let job = BudgetPass::new(gpu, &table, most)?.prepare(gpu, &scene.crowd, &state, &active)?;
        // For each bone, the kernel reads four words, writes and reads half a word of ranks, and writes a word.
        // Every bone has missed motion each time.
        let (before, mut sampled) = (Buffer::from_slice(gpu, "before", &vec![0_u32; pairs])?, vec![0; pairs]);
        let name = format!("{count} × 153, half");
        let record = |encoder: &mut wgpu::CommandEncoder| {
            encoder.copy_buffer_to_buffer(before.raw(), 0, state.sampled.raw(), 0, before.bytes());
            job.record(encoder);
        };
        measure(bench, name, pairs, "bone", 6 * pairs, &record, || {
            sampled.fill(0);
            budget(&table, most, &lods, &clip_clocks, &mut sampled)
        })?;
    }
    Ok(())
}
