//! Benchmark cases of `kernels/animation/drive.wgsl`.

use super::reference::drive;
use super::{DrivePass, driven_words};
use crate::Error;
use crate::animation::active::Active;
use crate::animation::bench::{CROWDS, Scene};
use crate::animation::gate_state::GateState;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures crowds of which each instance has a driven limb of eight bones.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = DrivePass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let order = scene.order();
        let active = Active::new(gpu, &order, &scene.crowd)?;
        let state = GateState::new(gpu, &scene.crowd)?;
        let limb: Vec<u32> = (40..48).collect();
        let driven = driven_words(&order, (0..count as u32).map(|instance| (instance, &limb[..])));
        let job = pass.prepare(gpu, &driven, &scene.crowd, &state, &active)?;
        // The kernel reads a word of driven bones, the flags of an instance, and reads and writes two words of bits.
        let words = 4 * driven.len();
        let copied = copy_of(gpu, words)?;
        let hidden = vec![false; count];
        let mut bits = vec![0; count * order.words()];
        let mut ahead = bits.clone();
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                drive(&driven, order.words(), &hidden, [&mut bits, &mut ahead]);
                std::hint::black_box(&mut bits);
            }),
        ];
        bench.case(format!("{count} × 153"), (8 * count, "bone"), 8 * words as u64, contenders)?;
    }
    Ok(())
}
