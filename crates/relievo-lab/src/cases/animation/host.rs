//! Benchmarks of the host's part of a frame, by its own clock: upload, dispatch and readback, each submitted
//! and waited for.

use std::hint::black_box;

use relievo::Error;
use relievo::asset::transform::AFFINE_IDENTITY;

use crate::cases::animation::frame::{DeviceFrame, PlainFrame, ReferenceFrame};
use crate::cases::animation::scene::Scene;
use crate::cases::terrain::copy_of;
use crate::harness::{Backend, Bench, Contender};

/// Each is measured beside a kernel that moves the same bytes, and beside the same work on the host alone: a
/// copy of memory, or a frame.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    upload(bench, scene)?;
    dispatch(bench, scene)?;
    readback(bench, scene)
}

fn upload(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let gpu = bench.gpu;
    let count = scene.instances.len();
    let copied = copy_of(gpu, 4 * count)?;
    let mut there = scene.instances.clone();
    let contenders = vec![
        Contender::both(Backend::Gpu, || {
            scene.crowd.instances.write(gpu, &scene.instances)?;
            Ok(gpu.run("upload", |_| ())?)
        }),
        Contender::both(Backend::Copy, || Ok(gpu.run("copy", |encoder| copied.record(encoder))?)),
        Contender::host(Backend::Reference, || black_box(&mut there).copy_from_slice(&scene.instances)),
    ];
    let case = format!("{count} × 153, upload of instances");
    bench.case(case, count, "instance", 32 * count as u64, contenders)
}

fn dispatch(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pairs = scene.pairs();
    let frame = DeviceFrame::new(gpu, scene)?;
    let (mut reference, mut plain) = (ReferenceFrame::new(scene), PlainFrame::new(scene)?);
    let contenders = vec![
        Contender::both(Backend::Gpu, || {
            frame.set(gpu)?;
            Ok(gpu.run("frame", |encoder| frame.record(encoder))?)
        }),
        Contender::both(Backend::Copy, || Ok(gpu.run("copies", |encoder| frame.record_copies(encoder))?)),
        Contender::host(Backend::Reference, || reference.compute(scene)),
        Contender::host(Backend::PlainSoa, || plain.compute(scene)),
    ];
    let case = format!("{} × 153, dispatch of a frame", scene.instances.len());
    bench.case(case, pairs, "bone", 216 * pairs as u64, contenders)
}

fn readback(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pairs = scene.pairs();
    let copied = copy_of(gpu, 12 * pairs)?;
    let (here, mut there) = (vec![AFFINE_IDENTITY; pairs], vec![AFFINE_IDENTITY; pairs]);
    let contenders = vec![
        Contender::both(Backend::Gpu, || {
            drop(black_box(scene.crowd.model_matrices.read_blocking(gpu)?));
            Ok(())
        }),
        Contender::both(Backend::Copy, || Ok(gpu.run("copy", |encoder| copied.record(encoder))?)),
        Contender::host(Backend::Reference, || black_box(&mut there).copy_from_slice(black_box(&here))),
    ];
    let case = format!("{} × 153, readback of model matrices", scene.instances.len());
    bench.case(case, pairs, "bone", 96 * pairs as u64, contenders)
}
