//! Benchmark cases of `surface/tangent`: tangent frames.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::surface::tangent::reference::tangents;
use crate::surface::tangent::verify::torus;
use crate::surface::tangent::{TangentBuffers, TangentPass};
use crate::terrain::bench::copy_of;

/// Measures a torus of half a million triangles. Per vertex the kernel reads 32 bytes, two triangles (24), and
/// the six corners that meet there (24, and an offset of 4); it writes a tangent of 16 bytes.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let torus = torus(512, 512);
    let vertices = torus.positions.len();
    let mesh = TangentBuffers::new(gpu, &torus.mesh())?;
    let output = Buffer::new(gpu, "tangents", vertices)?;
    let job = TangentPass::new(gpu)?.prepare(gpu, &mesh, &output)?;
    let copied = copy_of(gpu, vertices * 100 / 8)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || drop(std::hint::black_box(tangents(&torus.mesh())))),
    ];
    bench.case("512x512 torus", (vertices, "vertex"), 100 * vertices as u64, contenders)
}
