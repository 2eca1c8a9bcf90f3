//! Benchmark cases of `animation/keyframe_cursor`: cursors of crowds.

use std::hint::black_box;

use crate::Error;
use crate::animation::bench::{CROWDS, ELAPSED, Scene};
use crate::animation::keyframe_cursor::KeyframeCursorPass;
use crate::animation::keyframe_cursor::reference::cursors_into;
use crate::asset::keyframe::KeyframeCursor;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures one timeline per instance, which all tracks share.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = KeyframeCursorPass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let job = pass.prepare(gpu, &scene.clips, &scene.crowd)?;
        job.set(gpu, ELAPSED)?;
        // The kernel reads an instance and four times, and writes a cursor: 10 words.
        let copied = copy_of(gpu, 5 * count)?;
        let mut cursors = vec![KeyframeCursor::default(); count];
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                cursors_into(&scene.set, &scene.instances, ELAPSED, black_box(&mut cursors));
            }),
        ];
        bench.case(format!("{count} instances"), (count, "instance"), 40 * count as u64, contenders)?;
    }
    Ok(())
}
