//! Benchmark cases of `terrain/normals`: slopes and unit normals.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_heights};
use crate::terrain::fields::Fields;
use crate::terrain::normals::NormalsPass;
use crate::terrain::normals::reference::normals;

/// Measures a batch of 64 patches: the kernel reads 4 bytes and writes 20 per point.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259_u32, 64);
    let host = some_heights((width * width * count) as usize);
    let windows = Fields::new(gpu, "windows", width, count)?;
    windows.heights.write(gpu, &host)?;
    let points = (width as usize - 2).pow(2) * count as usize;
    let (slopes, units) = (Buffer::new(gpu, "slopes", points)?, Buffer::new(gpu, "normals", 3 * points)?);
    let job = NormalsPass::new(gpu)?.prepare(gpu, 1.0, &windows, &slopes, &units)?;
    // A copy reads half of the bytes that it moves, and writes the other half.
    let copied = copy_of(gpu, 3 * points)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            for window in host.chunks_exact((width * width) as usize) {
                drop(std::hint::black_box(normals(window, width as usize, 1.0)));
            }
        }),
    ];
    bench.case("257x257 batch 64", (points, "point"), 24 * points as u64, contenders)
}
