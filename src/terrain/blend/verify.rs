//! Parity cases of `kernels/terrain/blend.wgsl`, and with it of the zone weights.

use crate::Error;
use crate::harness::Cases;
use crate::harness::compare::levels;
use crate::harness::poison::Poisoned;
use crate::terrain::blend::reference::blend;
use crate::terrain::blend::{BlendPass, MAP_BOUND, MapZone, Shading, WeightMode};
use crate::terrain::fields::Fields;
use crate::terrain::verify::random_heights;

/// The cases cover one to 32 zones, overlapping and apart, both weight modes, heights beyond every zone.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = BlendPass::new(gpu)?;
    for weights in [WeightMode::Normalized, WeightMode::Additive] {
        for (zone_count, gap) in [(1, 0.0), (2, 50.0), (4, 0.0), (4, 9.0), (32, -1.0)] {
            for (width, count) in [(3, 1), (66, 3), (67, 2)] {
                let zones: Vec<_> = (0..zone_count).map(|zone| striped(zone, gap)).collect();
                let heights = random_heights(width, (width * width * count) as usize, 60 << 16);
                let windows = Fields::new(gpu, "windows", width, count)?;
                windows.heights.write(gpu, &heights)?;
                let output = Poisoned::new(gpu, (width - 2).pow(2) as usize * count as usize)?;
                let shading = Shading { weights, ..Shading::default() };
                let job = pass.prepare(gpu, 20.0, &zones, &shading, &windows, &output.buffer)?;
                gpu.run("verify", |encoder| job.record(encoder))?;
                let expected: Vec<u32> = (heights.chunks_exact((width * width) as usize))
                    .flat_map(|window| blend(window, width as usize, 20.0, &zones, &shading))
                    .collect();
                let name = format!("{width}×{width} × {count}, {zone_count} zones {gap} apart, {weights:?}");
                cases.add(name, output.check(gpu, |actual| levels(actual, &expected, MAP_BOUND))?);
            }
        }
    }
    Ok(())
}

fn striped(zone: u32, gap: f32) -> MapZone {
    let min = -20.0 + zone as f32 * (4.0 + gap);
    let channel = |shift: u32| ((zone * 37 + shift * 71) % 11) as f32 / 10.0;
    MapZone { color: [channel(0), channel(1), channel(2)], min, max: min + 4.0 }
}
