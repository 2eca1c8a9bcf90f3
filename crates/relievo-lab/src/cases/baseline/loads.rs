//! Parity and benchmark cases of `kernels/baseline/loads.wgsl`.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::surface::map::Address;
use relievo::ops::surface::relief::ReliefMethod;
use relievo::ops::surface::relief::textures::SurfaceTextures;

use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::baseline::loads::LoadsPass;
use crate::baseline::loads::reference::loads;
use crate::cases::surface::{Shape, random_map};
use crate::harness::compare::absolute;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover sizes around the workgroup's, more threads than texels, and no loads at all.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = LoadsPass::new(gpu)?;
    for (case, (size, threads, count)) in
        [([5, 3], [9, 7], 0), ([5, 3], [8, 8], 11), ([64, 64], [65, 63], 40)].into_iter().enumerate()
    {
        let map = random_map(case as u32, size, Shape::Noise)?;
        let textures = SurfaceTextures::new(gpu, &map, ReliefMethod::Plain, Address::Wrap)?;
        let output = Poisoned::new(gpu, (threads[0] * threads[1]) as usize)?;
        let job = pass.prepare(gpu, &textures.heights, threads, count, &output.buffer)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let expected = loads(&map, threads, count);
        // Each addition rounds by at most 2⁻²³ of a sum that is at most `count`.
        let bound = (count * count) as f32 * f32::EPSILON;
        let comparison = output.check(gpu, |actual| absolute(actual, &expected, bound)).await?;
        cases.add(format!("{count} loads by {threads:?} of {size:?}"), comparison);
    }
    Ok(())
}

/// Measures 16 loads per thread, one thread per texel of a megatexel.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let map = random_map(1, [1024, 1024], Shape::Noise)?;
    let textures = SurfaceTextures::new(gpu, &map, ReliefMethod::Plain, Address::Wrap)?;
    let sums = Buffer::new(gpu, "sums", 1 << 20)?;
    let job = LoadsPass::new(gpu)?.prepare(gpu, &textures.heights, [1024, 1024], 16, &sums)?;
    let (source, destination) =
        (Buffer::new(gpu, "source", 8 << 20)?, Buffer::new(gpu, "destination", 8 << 20)?);
    // A copy reads half of the bytes that it moves, and writes the other half.
    let buffers = CopyBuffers { source: &source, destination: &destination };
    let copied = CopyPass::new(gpu)?.prepare(gpu, 8 << 20, buffers)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            drop(std::hint::black_box(loads(&map, [1024, 1024], 16)));
        }),
    ];
    bench.case("16 by 1024 × 1024", 16 << 20, "load", 64 << 20, contenders)
}
