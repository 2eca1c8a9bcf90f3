//! Benchmark cases of `animation/local_to_model`: concatenation of crowds, whole frames, and the host's part.

use std::hint::black_box;

use crate::Error;
use crate::animation::bench::frame::{DeviceFrame, PlainFrame, ReferenceFrame};
use crate::animation::bench::plain_soa::PlainSoa;
use crate::animation::bench::{CROWDS, Scene, host};
use crate::animation::crowd::packed;
use crate::animation::local_to_model::reference::local_to_model_into;
use crate::animation::local_to_model::{LocalToModelPass, Walk};
use crate::animation::sample::reference::sample_set;
use crate::asset::keyframe::RotationPath;
use crate::asset::transform::AFFINE_IDENTITY;
use crate::harness::{Backend, Bench, Contender};

/// Measures concatenation of all bones of all instances, then whole frames, then the parts of a frame by the
/// host's clock.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    for count in CROWDS {
        let scene = Scene::new(bench.gpu, count)?;
        alone(bench, &scene)?;
        both(bench, &scene)?;
    }
    host::cases(bench, &Scene::new(bench.gpu, CROWDS[1])?)
}

fn alone(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (pairs, bones) = (scene.pairs(), scene.skeleton.len());
    let locals = sample_set(&scene.set, &scene.instances, &scene.cursors, RotationPath::Slerp);
    scene.crowd.locals.write(gpu, &locals.iter().map(packed).collect::<Vec<_>>())?;
    let job = LocalToModelPass::new(gpu, Walk::of(gpu))?.prepare(gpu, &scene.skeleton, &scene.crowd)?;
    let copied = scene.copied(gpu)?;
    let plain = PlainSoa::new(&scene.skeleton, &scene.set)?;
    let soa = scene.cursors.iter().map(|cursor| {
        let mut locals = plain.locals();
        plain.sample(*cursor, &mut locals);
        locals
    });
    let soa: Vec<_> = soa.collect();
    let mut model_matrices = [vec![AFFINE_IDENTITY; pairs], vec![AFFINE_IDENTITY; pairs]];
    let [of_reference, of_plain] = &mut model_matrices;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            local_to_model_into(&scene.skeleton, &locals, black_box(of_reference))
        }),
        Contender::host(Backend::PlainSoa, || {
            for (locals, model_matrices) in soa.iter().zip(black_box(&mut *of_plain).chunks_mut(bones)) {
                plain.local_to_model(locals, model_matrices);
            }
        }),
    ];
    bench.case(format!("{} × 153", scene.instances.len()), (pairs, "bone"), 88 * pairs as u64, contenders)
}

/// A frame: cursors, sampling and concatenation in one submission. On the host, one instance after another.
fn both(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let frame = DeviceFrame::new(bench.gpu, scene)?;
    let (mut reference, mut plain) = (ReferenceFrame::new(scene), PlainFrame::new(scene)?);
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| frame.record(encoder)),
        Contender::recorded(Backend::Copy, |encoder| frame.record_copies(encoder)),
        Contender::host(Backend::Reference, || reference.compute(scene)),
        Contender::host(Backend::PlainSoa, || plain.compute(scene)),
    ];
    let (case, pairs) = (format!("{} × 153, both with sampling", scene.instances.len()), scene.pairs());
    bench.case(case, (pairs, "bone"), 216 * pairs as u64, contenders)
}
