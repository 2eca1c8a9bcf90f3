//! Benchmark cases of `animation/sample`: sampling of crowds.

use std::hint::black_box;

use crate::Error;
use crate::animation::active::ActivePairs;
use crate::animation::bench::plain_soa::PlainSoa;
use crate::animation::bench::{CROWDS, KEYS, Scene};
use crate::animation::crowd::Crowd;
use crate::animation::instance::Instance;
use crate::animation::keyframe_cursor::reference::cursors;
use crate::animation::layers::{Layer, all_instances};
use crate::animation::sample::SamplePass;
use crate::animation::sample::reference::{sample_layers, sample_set_into};
use crate::asset::keyframe::KeyframeCursor;
use crate::asset::keyframe::RotationPath;
use crate::asset::transform::Transform;
use crate::baseline::gather::Reads;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures all bones, a list of every fourth, and two blended clips. `copy` reads and writes the same words;
/// `limit` reads the same keys without looking tracks up.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SamplePass::new(gpu, RotationPath::Slerp)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let pairs = scene.pairs();
        let job = pass.prepare(gpu, &scene.clips, &scene.crowd)?;
        let copied = scene.gathered(gpu, Reads::Everything)?;
        let keys = scene.gathered(gpu, Reads::Keys(KEYS as u32))?;
        let plain = PlainSoa::new(&scene.skeleton, &scene.set)?;
        let mut soa = vec![plain.locals(); count];
        let mut locals = vec![Transform::IDENTITY; pairs];
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::job(Backend::Limit, &keys),
            Contender::host(Backend::Reference, || reference(&scene, &scene.cursors, black_box(&mut locals))),
            Contender::host(Backend::PlainSoa, || {
                for (cursor, soa) in scene.cursors.iter().zip(black_box(&mut soa)) {
                    plain.sample(*cursor, soa);
                }
            }),
        ];
        bench.case(format!("{count} × 153, 60 keys"), (pairs, "bone"), 128 * pairs as u64, contenders)?;
    }
    quarter(bench, &pass)?;
    blended(bench)
}

fn reference(scene: &Scene, cursors: &[KeyframeCursor], locals: &mut [Transform]) {
    sample_set_into(&scene.set, &scene.instances[..cursors.len()], cursors, RotationPath::Slerp, locals);
}

fn quarter(bench: &mut Bench<'_>, pass: &SamplePass) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, CROWDS[1])?;
    let active = ActivePairs::new(gpu, &scene.crowd)?;
    let chosen: Vec<u32> = (0..scene.pairs() as u32).step_by(4).collect();
    active.write(gpu, &chosen)?;
    let job = pass.prepare_active(gpu, &scene.clips, &scene.crowd, &active)?;
    let copied = copy_of(gpu, 16 * chosen.len())?;
    let cursors = &scene.cursors[..scene.cursors.len() / 4];
    let mut locals = vec![Transform::IDENTITY; cursors.len() * scene.set.bones()];
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || reference(&scene, cursors, black_box(&mut locals))),
    ];
    let bytes = 128 * chosen.len() as u64;
    bench.case("a quarter of 1000 × 153", (chosen.len(), "bone"), bytes, contenders)
}

/// Two layers on all bones; the upper one is 0.3 s later and has half the weight.
fn blended(bench: &mut Bench<'_>) -> Result<(), Error> {
    let (gpu, count) = (bench.gpu, CROWDS[1]);
    let scene = Scene::new(gpu, count)?;
    let later = |instance: &Instance| Instance { start: instance.start + 0.3, ..*instance };
    let layers = [Layer::new(scene.instances.iter().map(later).collect(), vec![0.5; count])];
    let found = cursors(&scene.set, &all_instances(&scene.instances, &layers), 0.4);
    let crowd = Crowd::layered(gpu, &scene.set, &scene.instances, &layers)?;
    crowd.cursors.write(gpu, &found)?;
    let pairs = crowd.pairs();
    let job = SamplePass::layered(gpu, RotationPath::Slerp)?.prepare(gpu, &scene.clips, &crowd)?;
    // The kernel reads four keys of 10 words and writes 10 words.
    let copied = copy_of(gpu, 25 * pairs)?;
    let reference = || {
        let (set, base) = (&scene.set, &scene.instances);
        drop(std::hint::black_box(sample_layers(set, base, &layers, &found, RotationPath::Slerp)));
    };
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, reference),
    ];
    bench.case("two clips blended, 1000 × 153", (pairs, "bone"), 200 * pairs as u64, contenders)
}
