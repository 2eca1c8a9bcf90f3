//! Benchmark cases of `animation/budget`: decisions for crowds within a budget.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::bench::{CROWDS, Scene};
use crate::animation::budget::BudgetPass;
use crate::animation::budget::reference::budget;
use crate::animation::clip_clock::{ClipClock, UpdateReason};
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::GateTable;
use crate::animation::lod::Lod;
use crate::asset::keyframe::RotationPath;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures a budget of half of the bones.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = BudgetPass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let (bones, pairs) = (scene.skeleton.len(), scene.pairs());
        let table = GateTable::of_expectations(
            &scene.skeleton,
            &scene.set,
            &[&scene.clip],
            &vec![0.1; bones],
            RotationPath::Slerp,
        )?;
        let gate_state = GateState::new(gpu, &table, &scene.crowd)?;
        let active = Active::new(gpu, &scene.order(), &scene.crowd)?;
        let lods = vec![Lod::FULL; count];
        let rows = scene.set.rows(&scene.set.clips()[0]) - 1;
        let clip_clock =
            |instance: u32| ClipClock::new(instance % rows, instance % 65536, UpdateReason::Free, 0);
        let clip_clocks: Vec<ClipClock> = (0..count as u32).map(clip_clock).collect();
        gate_state.clip_clocks.write(gpu, &clip_clocks)?;
        let job = pass.prepare(gpu, &scene.crowd, &gate_state, &active)?;
        let most = pairs as u32 / 2;
        job.set(gpu, most)?;
        // For each bone, the kernel reads four words, writes and reads half a word of ranks, and writes a word.
        let copied = copy_of(gpu, 3 * pairs)?;
        // Every bone has missed motion each time.
        let (before, mut sampled) = (Buffer::from_slice(gpu, "before", &vec![0_u32; pairs])?, vec![0; pairs]);
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| {
                encoder.copy_buffer_to_buffer(before.raw(), 0, gate_state.sampled.raw(), 0, before.bytes());
                job.record(encoder);
            }),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                sampled.fill(0);
                drop(std::hint::black_box(budget(&table, most, &lods, &clip_clocks, &mut sampled)));
            }),
        ];
        bench.case(format!("{count} × 153, half"), (pairs, "bone"), 24 * pairs as u64, contenders)?;
    }
    Ok(())
}
