//! Where instances stand in their clips.

use super::{CROWDS, Scene};
use crate::Error;
use crate::animation::place::PlacePass;
use crate::bench::terrain::copy_of;
use crate::bench::{Backend, Bench, Contender};
use crate::reference::animation::place::places;

/// One timeline an instance: all tracks share it.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = PlacePass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let job = pass.prepare(gpu, &scene.clips, &scene.crowd)?;
        job.set(gpu, 0.4)?;
        // An instance and four times in, a place out: 10 words.
        let copied = copy_of(gpu, 5 * count)?;
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Twin, || {
                drop(std::hint::black_box(places(&scene.set, &scene.instances, 0.4)));
            }),
        ];
        bench.case(format!("{count} instances"), (count, "instance"), 40 * count as u64, contenders)?;
    }
    Ok(())
}
