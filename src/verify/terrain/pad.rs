//! Parity of `kernels/terrain/pad.wgsl`.

use serde_json::json;

use super::{LIMIT, config, random_heights};
use crate::Error;
use crate::gpu::Buffer;
use crate::reference::terrain::pad::pad;
use crate::terrain::pad::{PadPass, surrounds};
use crate::verify::{Cases, compare::exact, poison::Poisoned};

/// Wrapping patches, whole grids and grids with holes, every reach up to the patch's edge.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = PadPass::new(gpu)?;
    let grid: Vec<[i32; 2]> = (0..9).map(|i| [i % 3, i / 3 - 2]).collect();
    let holes = vec![[0, 0], [1, 0], [2, 1], [0, 2], [1, 1]];
    for border in [json!("wrap"), json!({"blend": 1})] {
        for patches in [&grid, &holes] {
            for (size, reach) in [(3, 0), (3, 2), (5, 4), (33, 1), (33, 32), (65, 9)] {
                let config =
                    config(&json!({"patchSize": size, "scaleFactor": 1.0, "seed": "", "border": border}))?;
                let points = (size * size) as usize;
                let heights = random_heights(size + reach, points * patches.len(), LIMIT);
                let around = surrounds(&config, patches);
                let input = Buffer::from_slice(gpu, "patches", &heights)?;
                let output = Poisoned::new(gpu, patches.len() * ((size + 2 * reach) as usize).pow(2))?;
                let job = pass.prepare(gpu, [size, reach], &around, &input, &output.buffer)?;
                gpu.run("verify", |encoder| job.record(encoder))?;
                let field = |index: usize| &heights[index * points..(index + 1) * points];
                let expected: Vec<i32> = (around.iter())
                    .flat_map(|around| pad(size as usize, reach as usize, around.map(|tile| tile.map(field))))
                    .collect();
                let name = format!("{size}×{size} × {} patches, {border}, reach {reach}", patches.len());
                cases.add(name, output.check(gpu, |actual| exact(actual, &expected))?);
            }
        }
    }
    Ok(())
}
