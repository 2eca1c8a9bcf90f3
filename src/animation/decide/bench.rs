//! Benchmark cases of `animation/decide`: the decisions at the beginning of a frame.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::bench::{CROWDS, ELAPSED, Scene};
use crate::animation::compact::reference::compact;
use crate::animation::decide::DecidePass;
use crate::animation::decide::reference::Decider;
use crate::animation::gate::Frame;
use crate::animation::gate_state::GateState;
use crate::animation::lod::{Lod, OMEGA_ONE};
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures frames in which nothing is skipped, and in which everything is.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    for (skipped, omega) in [("nothing", OMEGA_ONE), ("everything", 0)] {
        for count in CROWDS {
            case(bench, &format!("{count} × 153, {skipped} skipped"), omega, count)?;
        }
    }
    Ok(())
}

fn case(bench: &mut Bench<'_>, name: &str, omega: u32, count: usize) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, count)?;
    let (order, gate) = (scene.order(), scene.uniform()?);
    let state = GateState::new(gpu, &scene.crowd)?;
    let active = Active::new(gpu, &order, &scene.crowd)?;
    let lods = vec![Lod { omega, ..Lod::FULL }; count];
    state.write_lods(gpu, &lods)?;
    let pass = DecidePass::new(gpu, &gate, &scene.crowd)?;
    let job = pass.prepare(gpu, &scene.clips, &scene.crowd, &state, &active)?;
    let frame = Frame { ticks: 100_000, frame_ticks: 1092, frame: 91, ahead: 0.0 };
    job.set(gpu, &frame, ELAPSED)?;
    let mut decider = Decider::new(&scene.set, &gate, count);
    // In the first frame no pose is stored, so nothing can be skipped.
    gpu.run("first", |encoder| job.record(encoder))?;
    let mut decide = || {
        let clip_clocks = decider.clip_clocks(&scene.instances, &[], &lods, ELAPSED, 0.0);
        compact(&order, &decider.bits(&frame, &lods, &clip_clocks))
    };
    decide();
    let chosen = decide().pairs.len();
    // For each instance the kernel reads 12 words and writes 6; it writes bits twice and reads them once, and
    // writes a pair and its slot.
    let words = (18 * count + 3 * active.updated_bones.bits().len() + 2 * chosen) / 2;
    let copied = copy_of(gpu, words)?;
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || drop(std::hint::black_box(decide()))),
    ];
    bench.case(name.to_owned(), (scene.pairs(), "bone"), 8 * words as u64, contenders)
}
