//! Benchmark cases of `terrain/morph`: a blend of two fields.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_heights};
use crate::terrain::morph::reference::morph;
use crate::terrain::morph::{Morph, MorphBuffers, MorphPass};

/// Measures as many points as a batch of 64 patches of 257² has.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let points = 64 * 257 * 257;
    let (from, to) = (some_heights(points), some_heights(points));
    let buffers = [Buffer::from_slice(gpu, "from", &from)?, Buffer::from_slice(gpu, "to", &to)?];
    let heights = Buffer::new(gpu, "heights", points)?;
    let buffers = MorphBuffers { from: &buffers[0], to: &buffers[1], heights: &heights };
    let job = MorphPass::new(gpu)?.prepare(gpu, buffers)?;
    let params = Morph { time: 0.3 };
    job.set(gpu, params)?;
    // The kernel reads two words and writes one per point, which is one and a half copies.
    let copied = copy_of(gpu, points * 3 / 2)?;
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            drop(std::hint::black_box(morph(&from, &to, params.fixed_time())))
        }),
    ];
    bench.case("257x257 batch 64", (points, "point"), 12 * points as u64, contenders)
}
