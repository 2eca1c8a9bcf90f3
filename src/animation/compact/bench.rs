//! Benchmark cases of `animation/compact`: lists of the active bones of crowds.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::bench::{CROWDS, Scene};
use crate::animation::compact::CompactPass;
use crate::animation::compact::reference::compact;
use crate::animation::gate::reference::Chosen;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures crowds with all bones active, and with a quarter.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = CompactPass::new(gpu)?;
    for (fraction, pattern) in [("all", u32::MAX), ("a quarter", 0x1111_1111)] {
        for count in CROWDS {
            let scene = Scene::new(gpu, count)?;
            let order = scene.order();
            let active = Active::new(gpu, &order, &scene.crowd)?;
            let mut bits = vec![pattern; count * order.words()];
            let unused = order.words() * 32 - scene.skeleton.len();
            bits.iter_mut()
                .skip(order.words() - 1)
                .step_by(order.words())
                .for_each(|word| *word &= u32::MAX >> unused);
            active.bits.write(gpu, &bits)?;
            let bits = Chosen { ahead: vec![0; bits.len()], bits };
            let job = pass.prepare(gpu, &scene.crowd, &active)?;
            let chosen: u32 = bits.bits.iter().map(|word| word.count_ones()).sum();
            // The kernel reads bits twice and writes them once, and writes a pair and its slot.
            let words = (3 * bits.bits.len() + 2 * chosen as usize) / 2;
            let copied = copy_of(gpu, words)?;
            let contenders = vec![
                Contender::job(Backend::Gpu, &job.job),
                Contender::job(Backend::Copy, &copied),
                Contender::host(Backend::Reference, || drop(std::hint::black_box(compact(&order, &bits)))),
            ];
            let name = format!("{count} × 153, {fraction}");
            bench.case(name, (scene.pairs(), "bone"), 8 * words as u64, contenders)?;
        }
    }
    Ok(())
}
