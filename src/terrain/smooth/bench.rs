//! Benchmark cases of `terrain/smooth`: batches of 64 patches. `limit` is `terrain/height`, which makes as many heights from
//! means of four; `copy` moves 4 bytes per point.

use rayon::prelude::*;

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;
use crate::terrain::config::{Config, Interpolation, Offset};
use crate::terrain::features::Features;
use crate::terrain::height::{HeightJob, HeightPass, HeightScratch};
use crate::terrain::smooth::SmoothPass;
use crate::terrain::smooth::reference::smooth;
use crate::terrain::window::Window;

/// Measures sizes 129 to 1025.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    for (size, count) in [(129, 64), (257, 64), (513, 16), (1025, 4)] {
        case(bench, size, count)?;
    }
    Ok(())
}

fn case(bench: &mut Bench<'_>, size: u32, count: u32) -> Result<(), Error> {
    let gpu = bench.gpu;
    let linear = Config::new(size, 40.0, "bench")?;
    let config = Config { interpolation: Interpolation::Smooth, ..linear.clone() };
    let patches: Vec<_> = (0..count as i32).map(|i| [i % 8, i / 8]).collect();
    let features = Features::default();
    let points = HeightJob::output_points(&config, count, 0);
    let output = Buffer::new(gpu, "heights", points)?;
    let pass = SmoothPass::new(gpu, Offset::Signed, None)?;
    let scratch = pass.scratch(gpu, &config, [count, 0])?;
    let job = pass.prepare(gpu, &config, [count, 0], 0, &output, &scratch)?;
    job.set(gpu, &patches, &features)?;
    let means = HeightPass::new(gpu, Offset::Signed, None)?;
    let scratch = HeightScratch::new(gpu, &means, &linear, count, 0)?;
    let limit = means.prepare(gpu, &linear, [count, 0], 0, &output, &scratch)?;
    limit.set(gpu, &patches, &features)?;
    let copied = copy_of(gpu, points)?;
    let reference = |patch: &[i32; 2]| smooth(&config, &features, Window { patch: *patch, apron: 0 });
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::recorded(Backend::Limit, |encoder| limit.record(encoder)),
        Contender::recorded(Backend::Copy, |encoder| copied.record(encoder)),
        Contender::host(Backend::Reference, || {
            patches.iter().for_each(|patch| drop(std::hint::black_box(reference(patch))))
        }),
        Contender::host(Backend::ReferenceParallel, || {
            patches.par_iter().for_each(|patch| drop(std::hint::black_box(reference(patch))));
        }),
    ];
    bench.case(format!("{size}x{size} batch {count}"), (points, "point"), 4 * points as u64, contenders)
}
