//! Parity cases of `kernels/terrain/pad.wgsl`.

use serde_json::json;

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::terrain::blocks::Order;
use crate::terrain::fields::Fields;
use crate::terrain::pad::reference::pad;
use crate::terrain::pad::{PadPass, surrounds};
use crate::terrain::verify::{LIMIT, config, random_heights};

/// The cases cover wrapping patches, whole grids and grids with holes, every apron up to the patch's edge, and
/// patches in one buffer and in several.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    [Order::SOFTWARE, Order::HARDWARE].into_iter().try_for_each(|order| in_order(cases, order))
}

fn in_order(cases: &mut Cases<'_>, order: Order) -> Result<(), Error> {
    let pass = PadPass::with_order(cases.gpu, order)?;
    let grid: Vec<[i32; 2]> = (0..9).map(|i| [i % 3, i / 3 - 2]).collect();
    let holes = vec![[0, 0], [1, 0], [2, 1], [0, 2], [1, 1]];
    for border in [json!("wrap"), json!({"blend": 1})] {
        for (patches, most) in [(&grid, 9), (&grid, 2), (&holes, 5), (&holes, 2)] {
            for shape in [[3, 0], [3, 2], [5, 4], [33, 1], [33, 32], [65, 9]] {
                case(cases, (&pass, order), &border, (patches, most), shape)?;
            }
        }
    }
    Ok(())
}

/// Compares patches that are stored with at most `most` to a buffer.
fn case(
    cases: &mut Cases<'_>,
    (pass, order): (&PadPass, Order),
    border: &serde_json::Value,
    (patches, most): (&[[i32; 2]], usize),
    [size, apron]: [u32; 2],
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let config = config(&json!({"patchSize": size, "scaleFactor": 1.0, "seed": "", "border": border}))?;
    let points = (size * size) as usize;
    let heights = random_heights(size + apron, points * patches.len(), LIMIT);
    let around = surrounds(&config, patches);
    let mut parts = Vec::new();
    for part in heights.chunks(most * points) {
        let count = (part.len() / points) as u32;
        parts.push(Fields { heights: Buffer::from_slice(gpu, "patches", part)?, width: size, count });
    }
    let output = Poisoned::new(gpu, patches.len() * ((size + 2 * apron) as usize).pow(2))?;
    let job = pass.prepare(gpu, apron, &around, &parts, &output.buffer)?;
    gpu.run("verify", |encoder| job.record(encoder))?;
    let field = |index: usize| &heights[index * points..(index + 1) * points];
    let expected: Vec<i32> = (around.iter())
        .flat_map(|around| pad(size as usize, apron as usize, around.map(|tile| tile.map(field))))
        .collect();
    let mut name =
        format!("{size}×{size} × {} patches, {border}, apron {apron}, {} rows", patches.len(), order.rows);
    if parts.len() > 1 {
        name += &format!(", {} buffers", parts.len());
    }
    cases.add(name, output.check(gpu, |actual| exact(actual, &expected))?);
    Ok(())
}
