//! Benchmark cases of `animation/clip_clock`: clip clocks of crowds.

use crate::Error;
use crate::animation::bench::{CROWDS, Scene};
use crate::animation::clip_clock::ClipClockPass;
use crate::animation::clip_clock::reference::clip_clocks;
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::GateTable;
use crate::animation::keyframe_cursor::reference::cursors;
use crate::animation::lod::Lod;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures every instance of a crowd.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = ClipClockPass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let table = GateTable::of_animated_bones(&scene.order(), &scene.set, &[&scene.clip])?;
        let gate_state = GateState::new(gpu, &table, &scene.crowd)?;
        let found = cursors(&scene.set, &scene.instances, 0.4);
        scene.crowd.cursors.write(gpu, &found)?;
        let job = pass.prepare(gpu, &scene.clips, &scene.crowd, &gate_state)?;
        job.set(gpu, 0.4, 0.0)?;
        // The kernel reads 12 words and writes 6 per instance.
        let copied = copy_of(gpu, 9 * count)?;
        let (lods, mut history) = (vec![Lod::FULL; count], vec![[0; 4]; count]);
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let found = clip_clocks(&scene.set, &scene.instances, &[], &lods, 0.4, 0.0, &mut history);
                drop(std::hint::black_box(found));
            }),
        ];
        bench.case(format!("{count} instances"), (count, "instance"), 72 * count as u64, contenders)?;
    }
    Ok(())
}
