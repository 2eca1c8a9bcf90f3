//! Parity and benchmark cases of `kernels/terrain/pad.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::terrain::config::{Border, TerrainConfig};
use relievo::ops::terrain::pad::reference::pad;
use relievo::ops::terrain::pad::{PadPass, Surround, surrounds};

use crate::cases::terrain::{
    LIMIT, check_exact, measure, random_heights, some_heights, some_patches, uploaded,
};
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// The cases cover wrapping patches, whole grids and grids with holes, every apron up to the patch's edge, and
/// patches in one buffer and in several.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let grid: Vec<[i32; 2]> = (0..9).map(|i| [i % 3, i / 3 - 2]).collect();
    let holes = vec![[0, 0], [1, 0], [2, 1], [0, 2], [1, 1]];
    for border in [Border::Wrap, Border::Blend(1)] {
        for (patches, most) in [(&grid, 9), (&grid, 2), (&holes, 5), (&holes, 2)] {
            for (size, apron) in [(3, 0), (3, 2), (5, 4), (33, 1), (33, 32), (65, 9)] {
                let config = TerrainConfig { border, ..TerrainConfig::new(size, 1.0, "")? };
                case(cases, &config, apron, patches, most).await?;
            }
        }
    }
    Ok(())
}

/// Compares patches that are stored with at most `most` to a buffer.
async fn case(
    cases: &mut Cases<'_>,
    config: &TerrainConfig,
    apron: u32,
    patches: &[[i32; 2]],
    most: usize,
) -> Result<(), Error> {
    let (gpu, size) = (cases.gpu, config.patch_size);
    let points = (size * size) as usize;
    let heights = random_heights(size + apron, points * patches.len(), LIMIT);
    let around = surrounds(config, patches);
    let parts = heights.chunks(most * points).map(|part| uploaded(gpu, size, part));
    let parts = parts.collect::<Result<Vec<_>, _>>()?;
    let output = Poisoned::new(gpu, patches.len() * ((size + 2 * apron) as usize).pow(2))?;
    let job = PadPass::new(gpu)?.prepare(gpu, apron, &around, &parts, &output.buffer)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> =
        around.iter().flat_map(|around| padded(&heights, size, apron, *around)).collect();
    let (border, count) = (config.border, patches.len());
    let mut name = format!("{size}×{size} × {count} patches, {border:?}, apron {apron}");
    if parts.len() > 1 {
        name += &format!(", {} buffers", parts.len());
    }
    check_exact(cases, name, &output, &expected).await
}

/// The window around a patch of a batch of `size`² heights each.
fn padded(heights: &[i32], size: u32, apron: u32, around: Surround) -> Vec<i32> {
    let points = (size * size) as usize;
    let field = |index: usize| &heights[index * points..(index + 1) * points];
    pad(size as usize, apron as usize, around.map(|tile| tile.map(field)))
}

/// Measures a grid of 8 × 8 patches.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (size, apron, count) = (257, 8, 64);
    let config = TerrainConfig { border: Border::Blend(8), ..TerrainConfig::new(size, 1.0, "")? };
    let around = surrounds(&config, &some_patches(count));
    let heights = some_heights((size * size * count) as usize);
    let total = around.len() * ((size + 2 * apron) as usize).pow(2);
    let output = Buffer::new(gpu, "windows", total)?;
    let parts = [uploaded(gpu, size, &heights)?];
    let job = PadPass::new(gpu)?.prepare(gpu, apron, &around, &parts, &output)?;
    measure(
        bench,
        &format!("{size}x{size} batch {count}, apron {apron}"),
        total,
        8,
        |encoder| job.record(encoder),
        || {
            around.iter().for_each(|around| drop(black_box(padded(&heights, size, apron, *around))));
        },
    )
}
