//! Parity and benchmark cases of `kernels/terrain/wrap.wgsl`.

use relievo::Error;
use relievo::ops::terrain::config::{Border, Offset, TerrainConfig};
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::fixed::FeatureMode;

use crate::cases::terrain::levels::{OFFSETS, check, measure_levels};
use crate::cases::terrain::scattered;
use crate::harness::{Bench, Cases};

/// The cases cover every size and distribution, equal and unequal corners, features.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for offset in OFFSETS {
        let most = if offset == Offset::Signed { 12 } else { 9 };
        for exponent in 1..=most {
            let corners = if exponent % 2 == 0 { [1.5, -20.25, 33.3, 1e-5] } else { [2.5; 4] };
            let config = TerrainConfig { offset, corners, ..wrapped((1 << exponent) + 1, "wrap")? };
            let patches: &[_] = if exponent < 10 { &[[0, 0], [-3, 7], [4, 4]] } else { &[[-1, 2]] };
            check(cases, &config, &Features::default(), patches, 0).await?;
        }
    }
    for mode in [FeatureMode::Keep, FeatureMode::Additive] {
        for (case, size) in (50..).zip([3, 5, 33, 65, 513]) {
            let config = wrapped(size, "wrap")?;
            let features = scattered(&config, [2, -3], mode, case)?;
            check(cases, &config, &features, &[[2, -3], [3, -2], [7, 7]], 0).await?;
        }
    }
    Ok(())
}

fn wrapped(size: u32, seed: &str) -> Result<TerrainConfig, Error> {
    Ok(TerrainConfig { border: Border::Wrap, ..TerrainConfig::new(size, 40.0, seed)? })
}

/// Measures a batch of 64 patches.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    measure_levels(bench, &wrapped(257, "bench")?, &Features::default(), 64)
}
