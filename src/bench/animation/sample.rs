//! Sampling of crowds.

use super::{CROWDS, Scene};
use crate::Error;
use crate::animation::crowd::Crowd;
use crate::animation::layers::{Layer, all_instances};
use crate::animation::place::Instance;
use crate::animation::sample::{ActivePairs, RotationPath, SamplePass};
use crate::bench::terrain::copy_of;
use crate::bench::{Backend, Bench, Contender};
use crate::reference::animation::place::places;
use crate::reference::animation::sample::{sample_layers, sample_set};

/// All bones, a list of every fourth, and two clips blended.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SamplePass::new(gpu, RotationPath::Slerp)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let found = places(&scene.set, &scene.instances, 0.4);
        scene.crowd.places.write(gpu, &found)?;
        let pairs = scene.pairs();
        let job = pass.prepare(gpu, &scene.clips, &scene.crowd)?;
        // Two keys of 10 words in, 10 words out: one and a half copies of 10.
        let copied = copy_of(gpu, 15 * pairs)?;
        let twin = || {
            drop(std::hint::black_box(sample_set(&scene.set, &scene.instances, &found, RotationPath::Slerp)));
        };
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Twin, twin),
        ];
        bench.case(format!("{count} × 153, 60 keys"), (pairs, "bone"), 120 * pairs as u64, contenders)?;
    }
    quarter(bench, &pass)?;
    blended(bench)
}

fn quarter(bench: &mut Bench<'_>, pass: &SamplePass) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, CROWDS[1])?;
    let found = places(&scene.set, &scene.instances, 0.4);
    scene.crowd.places.write(gpu, &found)?;
    let active = ActivePairs::new(gpu, &scene.crowd)?;
    let chosen: Vec<u32> = (0..scene.pairs() as u32).step_by(4).collect();
    active.write(gpu, &chosen)?;
    let job = pass.prepare_active(gpu, &scene.clips, &scene.crowd, &active)?;
    let copied = copy_of(gpu, 15 * chosen.len())?;
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Twin, || {
            let quarter = &scene.instances[..scene.instances.len() / 4];
            drop(std::hint::black_box(sample_set(&scene.set, quarter, &found, RotationPath::Slerp)));
        }),
    ];
    let bytes = 120 * chosen.len() as u64;
    bench.case("a quarter of 1000 × 153", (chosen.len(), "bone"), bytes, contenders)
}

/// Two layers on all bones, the upper 0.3 s later and at half the weight.
fn blended(bench: &mut Bench<'_>) -> Result<(), Error> {
    let (gpu, count) = (bench.gpu, CROWDS[1]);
    let scene = Scene::new(gpu, count)?;
    let later = |instance: &Instance| Instance { start: instance.start + 0.3, ..*instance };
    let layers = [Layer::new(scene.instances.iter().map(later).collect(), vec![0.5; count])];
    let found = places(&scene.set, &all_instances(&scene.instances, &layers), 0.4);
    let crowd = Crowd::layered(gpu, &scene.set, &scene.instances, &layers)?;
    crowd.places.write(gpu, &found)?;
    let pairs = crowd.pairs();
    let job = SamplePass::layered(gpu, RotationPath::Slerp)?.prepare(gpu, &scene.clips, &crowd)?;
    // Four keys of 10 words in, 10 words out.
    let copied = copy_of(gpu, 25 * pairs)?;
    let twin = || {
        let (set, base) = (&scene.set, &scene.instances);
        drop(std::hint::black_box(sample_layers(set, base, &layers, &found, RotationPath::Slerp)));
    };
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Twin, twin),
    ];
    bench.case("two clips blended, 1000 × 153", (pairs, "bone"), 200 * pairs as u64, contenders)
}
