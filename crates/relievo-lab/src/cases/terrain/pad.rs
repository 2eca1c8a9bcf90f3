//! Parity and benchmark cases of `kernels/terrain/pad.wgsl`.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::terrain::blocks::Order;
use relievo::terrain::config::{Border, Config};
use relievo::terrain::fields::Fields;
use relievo::terrain::pad::reference::pad;
use relievo::terrain::pad::{PadPass, surrounds};
use serde_json::json;

use crate::cases::terrain::{LIMIT, config, copy_of, random_heights, some_heights};
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover wrapping patches, whole grids and grids with holes, every apron up to the patch's edge, and
/// patches in one buffer and in several.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for order in [Order::SOFTWARE, Order::HARDWARE] {
        in_order(cases, order).await?;
    }
    Ok(())
}

async fn in_order(cases: &mut Cases<'_>, order: Order) -> Result<(), Error> {
    let pass = PadPass::with_order(cases.gpu, order)?;
    let grid: Vec<[i32; 2]> = (0..9).map(|i| [i % 3, i / 3 - 2]).collect();
    let holes = vec![[0, 0], [1, 0], [2, 1], [0, 2], [1, 1]];
    for border in [json!("wrap"), json!({"blend": 1})] {
        for (patches, most) in [(&grid, 9), (&grid, 2), (&holes, 5), (&holes, 2)] {
            for shape in [[3, 0], [3, 2], [5, 4], [33, 1], [33, 32], [65, 9]] {
                case(cases, (&pass, order), &border, (patches, most), shape).await?;
            }
        }
    }
    Ok(())
}

/// Compares patches that are stored with at most `most` to a buffer.
async fn case(
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
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let field = |index: usize| &heights[index * points..(index + 1) * points];
    let expected: Vec<i32> = (around.iter())
        .flat_map(|around| pad(size as usize, apron as usize, around.map(|tile| tile.map(field))))
        .collect();
    let mut name =
        format!("{size}×{size} × {} patches, {border}, apron {apron}, {} rows", patches.len(), order.rows);
    if parts.len() > 1 {
        name += &format!(", {} buffers", parts.len());
    }
    cases.add(name, output.check(gpu, |actual| exact(actual, &expected)).await?);
    Ok(())
}

/// Measures a grid of 8 × 8 patches.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (size, apron) = (257_u32, 8);
    let config = Config { border: Border::Blend(8), ..Config::new(size, 1.0, "")? };
    let patches: Vec<_> = (0..64).map(|i| [i % 8, i / 8]).collect();
    let around = surrounds(&config, &patches);
    let points = (size * size) as usize;
    let heights = some_heights(points * patches.len());
    let total = patches.len() * ((size + 2 * apron) as usize).pow(2);
    let input = Fields { heights: Buffer::from_slice(gpu, "patches", &heights)?, width: size, count: 64 };
    let output = Buffer::new(gpu, "windows", total)?;
    let job = PadPass::new(gpu)?.prepare(gpu, apron, &around, &[input], &output)?;
    let copied = copy_of(gpu, total)?;
    let field = |index: usize| &heights[index * points..(index + 1) * points];
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            for around in &around {
                let around = around.map(|tile| tile.map(field));
                drop(std::hint::black_box(pad(size as usize, apron as usize, around)));
            }
        }),
    ];
    bench.case(
        format!("{size}x{size} batch 64, apron {apron}"),
        (total, "point"),
        8 * total as u64,
        contenders,
    )
}
