//! Benchmark cases of `terrain/wrap`: generation of patches by themselves. `limit` draws and stores the same number of random
//! words; `copy` moves 4 bytes per point.

use rayon::prelude::*;

use crate::Error;
use crate::baseline::words::WordsPass;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;
use crate::terrain::config::{Border, Config, Offset};
use crate::terrain::features::Features;
use crate::terrain::wrap::reference::wrap;
use crate::terrain::wrap::{WrapBuffers, WrapJob, WrapPass};

/// Measures a batch of 64 patches.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (size, count) = (257_u32, 64_u32);
    let config = Config { border: Border::Wrap, ..Config::new(size, 40.0, "bench")? };
    let patches: Vec<_> = (0..count as i32).map(|i| [i % 8, i / 8]).collect();
    let points = (count * size * size) as usize;
    let output = Buffer::new(gpu, "heights", points)?;
    let scratch = Buffer::new(gpu, "scratch", WrapJob::scratch_points(&config, count))?;
    let buffers = WrapBuffers { output: &output, scratch: &scratch };
    let job = WrapPass::new(gpu, Offset::Signed, None)?.prepare(gpu, &config, count, 0, buffers)?;
    let features = Features::default();
    job.set(gpu, &patches, &features)?;
    let copied = copy_of(gpu, points)?;
    let words = Buffer::new(gpu, "words", points.next_multiple_of(1024))?;
    let rows = words.len() as u32 / 1024;
    let drawn = WordsPass::new(gpu)?.prepare(gpu, config.key(), [1024, rows], &words)?;
    let reference = |patch: &[i32; 2]| drop(std::hint::black_box(wrap(&config, &features, *patch)));
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Limit, &drawn),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || patches.iter().for_each(reference)),
        Contender::host(Backend::ReferenceParallel, || patches.par_iter().for_each(reference)),
    ];
    bench.case(format!("{size}x{size} batch {count}"), (points, "point"), 4 * points as u64, contenders)
}
