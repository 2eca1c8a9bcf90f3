//! Parity and benchmark cases of `kernels/terrain/noise.wgsl`, and of regions by every generator.

use relievo::Error;
use relievo::ops::terrain::config::{HeightGenerator, HeightInterpolation, TerrainConfig};
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::region;
use relievo::ops::terrain::regions::{HeightBuffers, HeightScratch, RegionPass};
use relievo::ops::terrain::window::{Region, Regions};

use crate::cases::terrain::check_exact;
use crate::cases::terrain::levels::{check, measure_levels};
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

const NOISE: [HeightGenerator; 3] = [HeightGenerator::Fbm, HeightGenerator::Ridged, HeightGenerator::Simplex];

/// The cases cover every size and number of coarse levels; windows of every alignment; the ends of the world; the largest
/// heights; batches; regions at every resolution.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let none = Features::default();
    let seven: Vec<_> = (0..7).map(|i| [3 * i - 10, -i * i]).collect();
    // The last patches whose world coordinates fit `i32`.
    let far = [[524_285, -524_287], [-524_287, 524_285]];
    for generator in NOISE {
        let config = |size: u32, coarse_levels: u32, seed: &str| -> Result<_, Error> {
            let config = TerrainConfig::new(size, 40.0, &format!("{seed} {generator:?}"))?;
            Ok(TerrainConfig { generator, coarse_levels, roughness: 0.9, ..config })
        };
        for exponent in 1..=9 {
            for coarse_levels in if exponent <= 6 { 0..=8 } else { 0..=1 } {
                let odd = coarse_levels as i32 * 3 - 7;
                let config = config((1 << exponent) + 1, coarse_levels, "size")?;
                check(cases, &config, &none, &[[odd, 5 - odd]], 0).await?;
            }
        }
        check(cases, &config(4097, 8, "largest")?, &none, &[[-1, 0]], 0).await?;
        for (size, coarse_levels, apron) in
            [(3, 0, 1), (5, 1, 2), (17, 2, 3), (33, 3, 40), (65, 8, 7), (129, 0, 64)]
        {
            check(cases, &config(size, coarse_levels, "windows")?, &none, &seven, apron).await?;
        }
        check(cases, &config(9, 0, "far")?, &none, &far, 0).await?;
        for (scale_factor, roughness) in [(5400.0, 1.0), (800.0, 0.0), (8000.0, 40.0), (0.0, 1.0)] {
            let config = TerrainConfig { scale_factor, roughness, ..config(65, 3, "tall")? };
            check(cases, &config, &none, &[[3, -9]], 1).await?;
        }
        for coarser in 0..=7 {
            check_regions(cases, &config(33, 2, "regions")?, coarser).await?;
        }
    }
    for interpolation in [HeightInterpolation::Linear, HeightInterpolation::Smooth] {
        let config = TerrainConfig::new(33, 40.0, "regions")?;
        let config = TerrainConfig { interpolation, coarse_levels: 2, ..config };
        for coarser in 0..config.levels() {
            check_regions(cases, &config, coarser).await?;
        }
    }
    Ok(())
}

/// Compares regions around the origin and far from it.
async fn check_regions(cases: &mut Cases<'_>, config: &TerrainConfig, coarser: u32) -> Result<(), Error> {
    let gpu = cases.gpu;
    let firsts = [[0, 0], [-7, 3], [-1_000_001 >> coarser, 999_998 >> coarser]];
    let regions = Regions { count: 3, width: 21, coarser };
    let output = Poisoned::new(gpu, 3 * 21 * 21)?;
    let scratch = HeightScratch::for_regions(gpu, config, regions)?;
    let buffers = HeightBuffers { output: &output.buffer, scratch: &scratch };
    let pass = RegionPass::new(gpu, config, None)?;
    let job = pass.prepare_regions(gpu, config, regions, 0, buffers, None)?;
    let none = Features::default();
    job.set_regions(&mut &*gpu, &firsts, &none)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> = firsts
        .iter()
        .flat_map(|&first| region(config, &none, Region { first, width: 21, coarser }))
        .collect();
    let (generator, interpolation) = (config.generator, config.interpolation);
    let name = format!("regions {generator:?} {interpolation:?} {coarser} levels coarser");
    check_exact(cases, name, &output, &expected).await
}

/// Measures 257² and 1025² with each generator of noise, and with diamond-square for comparison.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    for (size, count) in [(257, 16), (1025, 1)] {
        for generator in [NOISE.as_slice(), &[HeightGenerator::DiamondSquare]].concat() {
            let config = TerrainConfig { generator, ..TerrainConfig::new(size, 40.0, "bench")? };
            measure_levels(bench, &config, &Features::default(), count)?;
        }
    }
    Ok(())
}
