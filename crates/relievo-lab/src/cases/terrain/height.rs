//! Parity and benchmark cases of `kernels/terrain/height.wgsl`.
//!
//! The benchmark has the sizes of B table 5.2, one patch and batches of 64. `limit` draws and stores the same number of random
//! words; `copy` moves 4 bytes per point.

use rayon::prelude::*;
use relievo::Error;
use relievo::gpu::Buffer;
use relievo::terrain::config::{Config, Offset};
use relievo::terrain::features::{FeatureFile, Features};
use relievo::terrain::fixed::FeatureMode;
use relievo::terrain::height::reference::height;
use relievo::terrain::height::{Blocks, HeightBatch, HeightJob, HeightPass, HeightScratch};
use relievo::terrain::window::Window;
use serde_json::json;

use crate::baseline::words::WordsPass;
use crate::cases::terrain::{case_name, config, copy_of, scattered};
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover every size, distribution and number of coarse levels; windows of every
/// alignment; features; batches; block sizes.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for offset in ["signed", "positive", "gaussian"] {
        let code: Offset = serde_json::from_value(json!(offset)).unwrap_or_default();
        let pass = HeightPass::new(cases.gpu, code, None)?;
        for exponent in 1..=12 {
            // The largest sizes run with one distribution only, so that time goes into variety.
            let levels =
                if exponent <= 8 { 0..=8 } else { 0..=u32::from(offset == "signed" && exponent <= 10) };
            for coarse_levels in levels.filter(|_| exponent <= 11 || offset == "signed") {
                let config = config(&json!({
                    "patchSize": (1 << exponent) + 1, "scaleFactor": 40.0, "seed": format!("{offset}{exponent}"),
                    "offset": offset, "coarseLevels": coarse_levels, "roughness": 0.9,
                }))?;
                let odd = coarse_levels as i32 * 3 - 7;
                check(cases, &pass, &config, &Features::default(), &[[odd, 5 - odd]], 0).await?;
            }
        }
    }
    windows_and_batches(cases).await?;
    with_features(cases).await?;
    large(cases).await?;
    block_sizes(cases).await
}

/// Compares large patches under everything that small ones are tested with: coarse levels, aprons, neighbours,
/// features.
async fn large(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (size, coarse_levels, apron, offset, mode) in [
        (513, 8, 3, Offset::Gaussian, None),
        (1025, 4, 17, Offset::Positive, None),
        (1025, 8, 0, Offset::Signed, None),
        (513, 3, 1, Offset::Positive, Some(FeatureMode::Keep)),
        (1025, 1, 0, Offset::Signed, Some(FeatureMode::Additive)),
        (1025, 6, 5, Offset::Gaussian, Some(FeatureMode::Keep)),
        (2049, 0, 2, Offset::Signed, Some(FeatureMode::Keep)),
    ] {
        let pass = HeightPass::new(cases.gpu, offset, mode)?;
        let config = Config { coarse_levels, offset, ..Config::new(size, 40.0, "large")? };
        let features = match mode {
            Some(mode) => scattered(&config, [2, -3], mode, size + coarse_levels)?,
            None => Features::default(),
        };
        let patches = if size < 2000 { &[[2, -3], [3, -4]][..] } else { &[[3, -3]] };
        check(cases, &pass, &config, &features, patches, apron).await?;
    }
    Ok(())
}

async fn windows_and_batches(cases: &mut Cases<'_>) -> Result<(), Error> {
    let pass = HeightPass::new(cases.gpu, Offset::Signed, None)?;
    for (size, coarse_levels, apron) in
        [(3, 0, 1), (5, 1, 2), (17, 2, 3), (33, 3, 40), (65, 8, 7), (129, 0, 64), (257, 0, 1)]
    {
        let config = config(&json!({
            "patchSize": size, "scaleFactor": 12.5, "seed": "windows", "coarseLevels": coarse_levels,
        }))?;
        let patches: Vec<_> = (0..7).map(|i| [3 * i - 10, -i * i]).collect();
        check(cases, &pass, &config, &Features::default(), &patches, apron).await?;
    }
    // The last patches whose world coordinates fit `i32`.
    let config = config(&json!({"patchSize": 9, "scaleFactor": 40.0, "seed": "far"}))?;
    let far = [[524_285, -524_287], [-524_287, 524_285]];
    check(cases, &pass, &config, &Features::default(), &far, 0).await
}

async fn with_features(cases: &mut Cases<'_>) -> Result<(), Error> {
    for mode in [FeatureMode::Keep, FeatureMode::Additive] {
        let pass = HeightPass::new(cases.gpu, Offset::Signed, Some(mode))?;
        for (case, (size, coarse_levels, apron)) in
            [(3, 0, 0), (5, 0, 1), (17, 1, 0), (33, 0, 0), (33, 2, 5), (129, 0, 3), (257, 0, 0)]
                .into_iter()
                .enumerate()
        {
            let config = config(&json!({
                "patchSize": size, "scaleFactor": 40.0, "seed": "features", "coarseLevels": coarse_levels,
            }))?;
            let features = scattered(&config, [2, -3], mode, case as u32)?;
            let patches = [[2, -3], [3, -3], [2, -2], [1, -4], [9, 9]];
            check(cases, &pass, &config, &features, &patches, apron).await?;
        }
    }
    // Every point of a patch is injected, so that rows of windows end anywhere in a word.
    let pass = HeightPass::new(cases.gpu, Offset::Signed, Some(FeatureMode::Additive))?;
    for (size, apron) in [(17, 0), (33, 0), (33, 1), (65, 13)] {
        let config = config(&json!({"patchSize": size, "scaleFactor": 4.0, "seed": "dense"}))?;
        let points =
            (0..size * size).flat_map(|i| [f64::from(i % size), f64::from(i / size), f64::from(i % 7)]);
        let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights: points.collect() };
        let features = Features::new(&config, &[file], FeatureMode::Additive)?;
        check(cases, &pass, &config, &features, &[[0, 0], [1, 0], [-1, -1]], apron).await?;
    }
    Ok(())
}

async fn block_sizes(cases: &mut Cases<'_>) -> Result<(), Error> {
    let one = [1, 2, 3, 4, 8, 16, 64].map(|cell_rows| Blocks { cell_rows, levels: 1 });
    let two = [1, 3, 17].map(|cell_rows| Blocks { cell_rows, levels: 2 });
    for blocks in one.into_iter().chain(two) {
        if blocks.levels == 2 && !cases.gpu.tuning().compiles_long_shaders() {
            cases.skip(format!("{blocks:?}"), "SwiftShader's compiler takes gigabytes for two levels");
            continue;
        }
        let pass = HeightPass::with_blocks(cases.gpu, Offset::Signed, None, blocks)?;
        for size in [3, 9, 33, 129] {
            let config =
                config(&json!({"patchSize": size, "scaleFactor": 1.0, "seed": format!("{blocks:?}")}))?;
            check(cases, &pass, &config, &Features::default(), &[[0, 0], [-1, 4]], 1).await?;
        }
    }
    Ok(())
}

async fn check(
    cases: &mut Cases<'_>,
    pass: &HeightPass,
    config: &Config,
    features: &Features,
    patches: &[[i32; 2]],
    apron: u32,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let count = patches.len() as u32;
    let output = Poisoned::new(gpu, HeightJob::output_points(config, count, apron))?;
    let scratch = HeightScratch::new(gpu, pass, config, count, apron)?;
    let capacity = features.len() * patches.len();
    let job = pass.prepare(gpu, config, [count, apron], capacity, &output.buffer, &scratch)?;
    job.set(gpu, patches, features)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> =
        patches.iter().flat_map(|&patch| height(config, features, Window { patch, apron })).collect();
    let name = case_name(config, features, patches, apron);
    cases.add(name, output.check(gpu, |actual| exact(actual, &expected)).await?);
    Ok(())
}

/// Measures sizes 129 to 1025, and a batch with features.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    for size in [129, 257, 513, 1025] {
        for count in [1, 64] {
            case(bench, size, count, false)?;
        }
    }
    case(bench, 257, 64, true)
}

fn case(bench: &mut Bench<'_>, size: u32, count: u32, with_features: bool) -> Result<(), Error> {
    let gpu = bench.gpu;
    let config = Config::new(size, 40.0, "bench")?;
    let patches: Vec<_> = (0..count as i32).map(|i| [i % 8, i / 8]).collect();
    let features = if with_features { valleys(&config, &patches)? } else { Features::default() };
    let pass = HeightPass::new(gpu, Offset::Signed, features.injection())?;
    // Patches share edges and halos, so that a point may count in several windows.
    let batch = HeightBatch::new(gpu, &pass, &config, [count, 0], 2 * features.len())?;
    batch.set(gpu, &patches, &features)?;
    let points = (count * size * size) as usize;
    let part = points.div_ceil(batch.fields().len());
    let copied = copy_of(gpu, part)?;
    let words = Buffer::new(gpu, "words", part.next_multiple_of(1024))?;
    let rows = words.len() as u32 / 1024;
    let drawn = WordsPass::new(gpu)?.prepare(gpu, config.key(), [1024, rows], &words)?;
    let parts = batch.fields().len();
    let reference = |patch: &[i32; 2]| height(&config, &features, Window { patch: *patch, apron: 0 });
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| batch.record(encoder)),
        Contender::recorded(Backend::Limit, |encoder| (0..parts).for_each(|_| drawn.record(encoder))),
        Contender::recorded(Backend::Copy, |encoder| (0..parts).for_each(|_| copied.record(encoder))),
        Contender::host(Backend::Reference, || {
            patches.iter().for_each(|patch| drop(std::hint::black_box(reference(patch))))
        }),
        Contender::host(Backend::ReferenceParallel, || {
            patches.par_iter().for_each(|patch| drop(std::hint::black_box(reference(patch))));
        }),
    ];
    let name = format!("{size}x{size} batch {count}{}", if with_features { " valleys" } else { "" });
    bench.case(name, (points, "point"), 4 * points as u64, contenders)
}

/// A valley in the middle of every patch: every fourth sample of the patch's middle half is a feature.
fn valleys(config: &Config, patches: &[[i32; 2]]) -> Result<Features, Error> {
    let quarter = config.patch_size / 4;
    let lines = || (quarter..3 * quarter).step_by(4);
    let heights: Vec<f64> =
        lines().flat_map(|y| lines().flat_map(move |x| [f64::from(x), f64::from(y), -20.0])).collect();
    let files: Vec<_> = (patches.iter())
        .map(|patch| FeatureFile { patch_coordinates: *patch, precomputed_heights: heights.clone() })
        .collect();
    Ok(Features::new(config, &files, FeatureMode::Keep)?)
}
