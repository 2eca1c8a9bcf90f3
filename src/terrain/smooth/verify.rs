//! Parity cases of `kernels/terrain/smooth.wgsl`.

use serde_json::json;

use crate::Error;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::terrain::blocks::Order;
use crate::terrain::config::{Config, Interpolation, Offset};
use crate::terrain::features::{FeatureFile, Features};
use crate::terrain::fixed::FeatureMode;
use crate::terrain::height::HeightJob;
use crate::terrain::smooth::SmoothPass;
use crate::terrain::smooth::reference::smooth;
use crate::terrain::verify::{case_name, config, scattered};
use crate::terrain::window::Window;

/// The cases cover every size, distribution and number of coarse levels; windows of every alignment; features, also of other
/// patches; batches; block sizes; and heights that are clamped.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
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
                check(cases, &pass, &config, &Features::default(), &[[odd, 5 - odd]], 0)?;
            }
        }
    }
    windows_and_batches(cases)?;
    with_features(cases)?;
    clamped(cases)?;
    block_sizes(cases)
}

fn plain(size: u32, seed: &str, coarse_levels: u32) -> Result<Config, Error> {
    let config = Config::new(size, 40.0, seed)?;
    Ok(Config { coarse_levels, interpolation: Interpolation::Smooth, ..config })
}

fn windows_and_batches(cases: &mut Cases<'_>) -> Result<(), Error> {
    let pass = SmoothPass::new(cases.gpu, Offset::Signed, None)?;
    for (size, coarse_levels, apron) in
        [(3, 0, 1), (5, 1, 2), (17, 2, 3), (33, 3, 40), (65, 8, 7), (129, 0, 64), (257, 0, 1), (513, 5, 17)]
    {
        let patches: Vec<_> = (0..7).map(|i| [3 * i - 10, -i * i]).collect();
        check(cases, &pass, &plain(size, "windows", coarse_levels)?, &Features::default(), &patches, apron)?;
    }
    Ok(())
}

fn with_features(cases: &mut Cases<'_>) -> Result<(), Error> {
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
            check(cases, &pass, &config, &features, &patches, apron)?;
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
        check(cases, &pass, &config, &features, &[[0, 0], [1, 0], [-1, -1], [0, -1], [2, 2]], apron)?;
    }
    Ok(())
}

/// Heights that reach the largest there are.
fn clamped(cases: &mut Cases<'_>) -> Result<(), Error> {
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
        check(cases, &pass, &steep, &features, &[[0, 0], [-1, 0]], 2)?;
    }
    Ok(())
}

fn block_sizes(cases: &mut Cases<'_>) -> Result<(), Error> {
    let orders = [1, 2, 3, 4, 8, 16, 64]
        .into_iter()
        .flat_map(|rows| [false, true].map(|downwards| Order { rows, downwards }));
    for order in orders {
        let pass = SmoothPass::with_order(cases.gpu, Offset::Signed, None, order)?;
        for size in [3, 9, 33, 129] {
            let config = plain(size, &format!("{order:?}"), 0)?;
            check(cases, &pass, &config, &Features::default(), &[[0, 0], [-1, 4]], 1)?;
        }
    }
    Ok(())
}

fn check(
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
    gpu.run("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> =
        patches.iter().flat_map(|&patch| smooth(config, features, Window { patch, apron })).collect();
    let name = case_name(config, features, patches, apron);
    cases.add(name, output.check(gpu, |actual| exact(actual, &expected))?);
    Ok(())
}
