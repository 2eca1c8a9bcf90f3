//! Benchmark cases of `baseline/loads`: how fast texels are loaded.

use crate::Error;
use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::baseline::loads::LoadsPass;
use crate::baseline::loads::reference::loads;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::surface::map::Address;
use crate::surface::relief::Method;
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::verify::{Shape, random_map};

/// Measures 16 loads per thread, one thread per texel of a megatexel.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let map = random_map(1, [1024, 1024], Shape::Noise)?;
    let textures = SurfaceTextures::new(gpu, &map, Method::Plain, Address::Wrap)?;
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
    bench.case("16 by 1024 × 1024", (16 << 20, "load"), 64 << 20, contenders)
}
