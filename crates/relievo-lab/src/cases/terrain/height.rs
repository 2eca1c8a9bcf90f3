//! Parity and benchmark cases of `kernels/terrain/height.wgsl`. The benchmark has the sizes of B table 5.2, one patch and
//! batches of 64 (16 of 1025²).

use relievo::Error;
use relievo::ops::terrain::config::{Offset, TerrainConfig};
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::fixed::FeatureMode;

use crate::cases::terrain::levels::{OFFSETS, check, check_dense, measure_levels};
use crate::cases::terrain::scattered;
use crate::harness::{Bench, Cases};

/// The cases cover every size, distribution and number of coarse levels; windows of every
/// alignment; features; batches.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let none = Features::default();
    for offset in OFFSETS {
        let most = if offset == Offset::Signed { 12 } else { 11 };
        for exponent in 1..=most {
            // The largest sizes run with one distribution only, so that time goes into variety.
            let levels =
                if exponent <= 8 { 0..=8 } else { 0..=u32::from(offset == Offset::Signed && exponent <= 10) };
            for coarse_levels in levels {
                let config = TerrainConfig::new((1 << exponent) + 1, 40.0, &format!("{offset:?}{exponent}"))?;
                let config = TerrainConfig { offset, coarse_levels, roughness: 0.9, ..config };
                let odd = coarse_levels as i32 * 3 - 7;
                check(cases, &config, &none, &[[odd, 5 - odd]], 0).await?;
            }
        }
    }
    let seven: Vec<_> = (0..7).map(|i| [3 * i - 10, -i * i]).collect();
    for (size, coarse_levels, apron) in
        [(3, 0, 1), (5, 1, 2), (17, 2, 3), (33, 3, 40), (65, 8, 7), (129, 0, 64), (257, 0, 1)]
    {
        let config = TerrainConfig { coarse_levels, ..TerrainConfig::new(size, 12.5, "windows")? };
        check(cases, &config, &none, &seven, apron).await?;
    }
    // The last patches whose world coordinates fit `i32`.
    let far = [[524_285, -524_287], [-524_287, 524_285]];
    check(cases, &TerrainConfig::new(9, 40.0, "far")?, &none, &far, 0).await?;
    with_features(cases).await?;
    large(cases).await
}

async fn with_features(cases: &mut Cases<'_>) -> Result<(), Error> {
    for mode in [FeatureMode::Keep, FeatureMode::Additive] {
        for (case, (size, coarse_levels, apron)) in
            (0..).zip([(3, 0, 0), (5, 0, 1), (17, 1, 0), (33, 0, 0), (33, 2, 5), (129, 0, 3), (257, 0, 0)])
        {
            let config = TerrainConfig { coarse_levels, ..TerrainConfig::new(size, 40.0, "features")? };
            let features = scattered(&config, [2, -3], mode, case)?;
            let patches = [[2, -3], [3, -3], [2, -2], [1, -4], [9, 9]];
            check(cases, &config, &features, &patches, apron).await?;
        }
    }
    for (size, apron) in [(17, 0), (33, 0), (33, 1), (65, 13)] {
        let config = TerrainConfig::new(size, 4.0, "dense")?;
        check_dense(cases, &config, &[[0, 0], [1, 0], [-1, -1]], apron).await?;
    }
    Ok(())
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
        let config = TerrainConfig { coarse_levels, offset, ..TerrainConfig::new(size, 40.0, "large")? };
        let features = match mode {
            Some(mode) => scattered(&config, [2, -3], mode, size + coarse_levels)?,
            None => Features::default(),
        };
        let patches = if size < 2000 { &[[2, -3], [3, -4]][..] } else { &[[3, -3]] };
        check(cases, &config, &features, patches, apron).await?;
    }
    Ok(())
}

/// Measures sizes 129 to 1025, and a batch with features.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    for (size, most) in [(129, 64), (257, 64), (513, 64), (1025, 16)] {
        for count in [1, most] {
            measure_levels(bench, &TerrainConfig::new(size, 40.0, "bench")?, &Features::default(), count)?;
        }
    }
    let config = TerrainConfig::new(257, 40.0, "bench")?;
    let valleys = valleys(&config, 64)?;
    measure_levels(bench, &config, &valleys, 64)
}

/// A valley in the middle of every patch: every fourth sample of the patch's middle half is a feature.
fn valleys(config: &TerrainConfig, count: u32) -> Result<Features, Error> {
    let quarter = config.patch_size / 4;
    let lines = || (quarter..3 * quarter).step_by(4);
    let heights: Vec<f64> =
        lines().flat_map(|y| lines().flat_map(move |x| [f64::from(x), f64::from(y), -20.0])).collect();
    let file = |patch| FeatureFile { patch_coordinates: patch, precomputed_heights: heights.clone() };
    let files: Vec<_> = super::some_patches(count).into_iter().map(file).collect();
    Ok(Features::new(config, &files, FeatureMode::Keep)?)
}
