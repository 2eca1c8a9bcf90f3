//! Concatenation of crowds.

use super::{CROWDS, Scene};
use crate::Error;
use crate::animation::concat::{ConcatPass, Walk};
use crate::animation::crowd::packed;
use crate::animation::sample::RotationPath;
use crate::bench::terrain::copy_of;
use crate::bench::{Backend, Bench, Contender};
use crate::reference::animation::concat::concat;
use crate::reference::animation::place::places;
use crate::reference::animation::sample::sample_set;

/// All bones of all instances.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = ConcatPass::new(gpu, Walk::of(gpu))?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let found = places(&scene.set, &scene.instances, 0.4);
        let locals = sample_set(&scene.set, &scene.instances, &found, RotationPath::Slerp);
        scene.crowd.locals.write(gpu, &locals.iter().map(packed).collect::<Vec<_>>())?;
        let pairs = scene.pairs();
        let job = pass.prepare(gpu, &scene.skeleton, &scene.crowd)?;
        // 10 words in, 12 out.
        let copied = copy_of(gpu, 11 * pairs)?;
        let twin = || {
            for locals in locals.chunks(scene.skeleton.len()) {
                drop(std::hint::black_box(concat(&scene.skeleton, locals)));
            }
        };
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Twin, twin),
        ];
        bench.case(format!("{count} × 153"), (pairs, "bone"), 88 * pairs as u64, contenders)?;
    }
    Ok(())
}
