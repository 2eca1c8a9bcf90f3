//! Parity and benchmark cases of `kernels/terrain/smooth.wgsl`.

use relievo::Error;
use relievo::ops::terrain::config::{HeightInterpolation, Offset, TerrainConfig};
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::fixed::FeatureMode;

use crate::cases::terrain::levels::{OFFSETS, check, check_dense, measure_levels};
use crate::cases::terrain::scattered;
use crate::harness::{Bench, Cases};

/// The cases cover every size, distribution and number of coarse levels; windows of every alignment; features, also of other
/// patches; batches; and heights that are clamped.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let none = Features::default();
    for offset in OFFSETS {
        let most = if offset == Offset::Signed { 11 } else { 8 };
        for exponent in 1..=most {
            let levels = if exponent <= 7 { 0..=8 } else { 0..=u32::from(exponent <= 9) };
            for coarse_levels in levels {
                let config = plain((1 << exponent) + 1, &format!("{offset:?}{exponent}"), coarse_levels)?;
                let config = TerrainConfig { offset, roughness: 0.9, ..config };
                let odd = coarse_levels as i32 * 3 - 7;
                check(cases, &config, &none, &[[odd, 5 - odd]], 0).await?;
            }
        }
    }
    let seven: Vec<_> = (0..7).map(|i| [3 * i - 10, -i * i]).collect();
    for (size, coarse_levels, apron) in
        [(3, 0, 1), (5, 1, 2), (17, 2, 3), (33, 3, 40), (65, 8, 7), (129, 0, 64), (257, 0, 1), (513, 5, 17)]
    {
        check(cases, &plain(size, "windows", coarse_levels)?, &none, &seven, apron).await?;
    }
    with_features(cases).await?;
    clamped(cases).await
}

fn plain(size: u32, seed: &str, coarse_levels: u32) -> Result<TerrainConfig, Error> {
    let config = TerrainConfig::new(size, 40.0, seed)?;
    Ok(TerrainConfig { coarse_levels, interpolation: HeightInterpolation::Smooth, ..config })
}

async fn with_features(cases: &mut Cases<'_>) -> Result<(), Error> {
    let shapes =
        [(3, 0, 0), (5, 0, 1), (17, 1, 0), (33, 0, 0), (33, 2, 5), (129, 0, 3), (257, 0, 0), (513, 3, 1)];
    for mode in [FeatureMode::Keep, FeatureMode::Additive] {
        for (case, (size, coarse_levels, apron)) in (0..).zip(shapes) {
            let config = plain(size, "features", coarse_levels)?;
            let features = scattered(&config, [2, -3], mode, case)?;
            // The last ones see features through the halo of their halo alone, or none.
            let patches = [[2, -3], [3, -3], [2, -2], [1, -4], [5, -1], [8, -3], [2, -9], [30, 9]];
            check(cases, &config, &features, &patches, apron).await?;
        }
    }
    for (size, apron) in [(17, 0), (33, 0), (33, 1), (65, 13)] {
        let patches = [[0, 0], [1, 0], [-1, -1], [0, -1], [2, 2]];
        check_dense(cases, &plain(size, "dense", 0)?, &patches, apron).await?;
    }
    Ok(())
}

/// Heights that reach the largest there are.
async fn clamped(cases: &mut Cases<'_>) -> Result<(), Error> {
    let steep = TerrainConfig {
        scale_factor: 8192.0,
        roughness: 0.0,
        offset: Offset::Positive,
        ..plain(65, "high", 0)?
    };
    let heights = [12.0, 12.0, 8192.0, 40.0, 20.0, -8192.0, 64.0, 64.0, 8192.0].to_vec();
    let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights: heights };
    let injected = Features::new(&steep, &[file], FeatureMode::Additive)?;
    for features in [Features::default(), injected] {
        check(cases, &steep, &features, &[[0, 0], [-1, 0]], 2).await?;
    }
    Ok(())
}

/// Measures sizes 129 to 1025.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    for (size, count) in [(129, 64), (257, 64), (513, 16), (1025, 4)] {
        measure_levels(bench, &plain(size, "bench", 0)?, &Features::default(), count)?;
    }
    Ok(())
}
