//! Parity and benchmark cases of `kernels/terrain/smooth.wgsl`.
//!
//! In the benchmark, `limit` is `terrain/height`, which makes as many heights from means of four; `copy` moves 4 bytes per
//! point.

use rayon::prelude::*;
use relievo::Error;
use relievo::gpu::Buffer;
use relievo::terrain::blocks::Order;
use relievo::terrain::config::{Config, Interpolation, Offset};
use relievo::terrain::features::{FeatureFile, Features};
use relievo::terrain::fixed::FeatureMode;
use relievo::terrain::height::{HeightJob, HeightPass, HeightScratch};
use relievo::terrain::smooth::SmoothPass;
use relievo::terrain::smooth::reference::smooth;
use relievo::terrain::window::Window;
use serde_json::json;

use crate::cases::terrain::{case_name, config, copy_of, scattered};
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover every size, distribution and number of coarse levels; windows of every alignment; features, also of other
/// patches; batches; block sizes; and heights that are clamped.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for offset in ["signed", "positive", "gaussian"] {
        let code: Offset = serde_json::from_value(json!(offset)).unwrap_or_default();
        let pass = SmoothPass::new(cases.gpu, code, None)?;
        for exponent in 1..=11 {
            let levels = if exponent <= 7 { 0..=8 } else { 0..=u32::from(exponent <= 9) };
            for coarse_levels in levels.filter(|_| exponent <= 8 || offset == "signed") {
                let config = config(&json!({
                    "patchSize": (1 << exponent) + 1, "scaleFactor": 40.0, "seed": format!("{offset}{exponent}"),
                    "offset": offset, "coarseLevels": coarse_levels, "roughness": 0.9, "interpolation": "smooth",
                }))?;
                let odd = coarse_levels as i32 * 3 - 7;
                check(cases, &pass, &config, &Features::default(), &[[odd, 5 - odd]], 0).await?;
            }
        }
    }
    windows_and_batches(cases).await?;
    with_features(cases).await?;
    clamped(cases).await?;
    block_sizes(cases).await
}

fn plain(size: u32, seed: &str, coarse_levels: u32) -> Result<Config, Error> {
    let config = Config::new(size, 40.0, seed)?;
    Ok(Config { coarse_levels, interpolation: Interpolation::Smooth, ..config })
}

async fn windows_and_batches(cases: &mut Cases<'_>) -> Result<(), Error> {
    let pass = SmoothPass::new(cases.gpu, Offset::Signed, None)?;
    for (size, coarse_levels, apron) in
        [(3, 0, 1), (5, 1, 2), (17, 2, 3), (33, 3, 40), (65, 8, 7), (129, 0, 64), (257, 0, 1), (513, 5, 17)]
    {
        let patches: Vec<_> = (0..7).map(|i| [3 * i - 10, -i * i]).collect();
        check(cases, &pass, &plain(size, "windows", coarse_levels)?, &Features::default(), &patches, apron)
            .await?;
    }
    Ok(())
}

async fn with_features(cases: &mut Cases<'_>) -> Result<(), Error> {
    for mode in [FeatureMode::Keep, FeatureMode::Additive] {
        let pass = SmoothPass::new(cases.gpu, Offset::Signed, Some(mode))?;
        for (case, (size, coarse_levels, apron)) in
            [(3, 0, 0), (5, 0, 1), (17, 1, 0), (33, 0, 0), (33, 2, 5), (129, 0, 3), (257, 0, 0), (513, 3, 1)]
                .into_iter()
                .enumerate()
        {
            let config = plain(size, "features", coarse_levels)?;
            let features = scattered(&config, [2, -3], mode, case as u32)?;
            // The last ones see features through the halo of their halo alone, or none.
            let patches = [[2, -3], [3, -3], [2, -2], [1, -4], [5, -1], [8, -3], [2, -9], [30, 9]];
            check(cases, &pass, &config, &features, &patches, apron).await?;
        }
    }
    // Every point of a patch is injected, so that rows of windows end anywhere in a word, and centers outside of windows see
    // features.
    let pass = SmoothPass::new(cases.gpu, Offset::Signed, Some(FeatureMode::Additive))?;
    for (size, apron) in [(17, 0), (33, 0), (33, 1), (65, 13)] {
        let config = plain(size, "dense", 0)?;
        let points =
            (0..size * size).flat_map(|i| [f64::from(i % size), f64::from(i / size), f64::from(i % 7)]);
        let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights: points.collect() };
        let features = Features::new(&config, &[file], FeatureMode::Additive)?;
        check(cases, &pass, &config, &features, &[[0, 0], [1, 0], [-1, -1], [0, -1], [2, 2]], apron).await?;
    }
    Ok(())
}

/// Heights that reach the largest there are.
async fn clamped(cases: &mut Cases<'_>) -> Result<(), Error> {
    for mode in [None, Some(FeatureMode::Additive)] {
        let pass = SmoothPass::new(cases.gpu, Offset::Positive, mode)?;
        let steep = config(&json!({
            "patchSize": 65, "scaleFactor": 8192.0, "seed": "high", "roughness": 0.0,
            "offset": "positive", "interpolation": "smooth",
        }))?;
        let heights = [12.0, 12.0, 8192.0, 40.0, 20.0, -8192.0, 64.0, 64.0, 8192.0].to_vec();
        let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights: heights };
        let features = match mode {
            Some(mode) => Features::new(&steep, &[file], mode)?,
            None => Features::default(),
        };
        check(cases, &pass, &steep, &features, &[[0, 0], [-1, 0]], 2).await?;
    }
    Ok(())
}

async fn block_sizes(cases: &mut Cases<'_>) -> Result<(), Error> {
    let orders = [1, 2, 3, 4, 8, 16, 64]
        .into_iter()
        .flat_map(|rows| [false, true].map(|downwards| Order { rows, downwards }));
    for order in orders {
        let pass = SmoothPass::with_order(cases.gpu, Offset::Signed, None, order)?;
        for size in [3, 9, 33, 129] {
            let config = plain(size, &format!("{order:?}"), 0)?;
            check(cases, &pass, &config, &Features::default(), &[[0, 0], [-1, 4]], 1).await?;
        }
    }
    Ok(())
}

async fn check(
    cases: &mut Cases<'_>,
    pass: &SmoothPass,
    config: &Config,
    features: &Features,
    patches: &[[i32; 2]],
    apron: u32,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let count = patches.len() as u32;
    let output = Poisoned::new(gpu, HeightJob::output_points(config, count, apron))?;
    let scratch = pass.scratch(gpu, config, [count, apron])?;
    let capacity = features.len() * patches.len();
    let job = pass.prepare(gpu, config, [count, apron], capacity, &output.buffer, &scratch)?;
    job.set(gpu, patches, features)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> =
        patches.iter().flat_map(|&patch| smooth(config, features, Window { patch, apron })).collect();
    let name = case_name(config, features, patches, apron);
    cases.add(name, output.check(gpu, |actual| exact(actual, &expected)).await?);
    Ok(())
}

/// Measures sizes 129 to 1025.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
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
