//! Benchmark cases of `terrain/pad`: windows around patches.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_heights};
use crate::terrain::config::{Border, Config};
use crate::terrain::fields::Fields;
use crate::terrain::pad::reference::pad;
use crate::terrain::pad::{PadPass, surrounds};

/// Measures a grid of 8 × 8 patches.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
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
