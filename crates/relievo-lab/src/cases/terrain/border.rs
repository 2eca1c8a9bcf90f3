//! Parity and benchmark cases of `kernels/terrain/border.wgsl`.

use relievo::Error;
use relievo::ops::terrain::border::reference::border;
use relievo::ops::terrain::border::{BorderPass, Neighbours, neighbours};
use relievo::ops::terrain::fields::Fields;

use crate::cases::terrain::{
    LIMIT, check_exact, measure, random_heights, some_heights, some_patches, uploaded,
};
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// The cases cover widths up to overlapping transitions, orders of generation with up to four neighbours,
/// heights at the limit, and batches in one buffer and in several.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let grid: Vec<[i32; 2]> = (0..9).map(|i| [i % 3 - 1, i / 3]).collect();
    let surrounded = vec![[1, 0], [0, 1], [2, 1], [1, 2], [1, 1]];
    for (patches, most) in [(&grid, 9), (&grid, 4), (&surrounded, 5), (&surrounded, 2), (&vec![[5, 5]], 1)] {
        for (size, width) in [(3, 1), (5, 4), (33, 1), (33, 16), (33, 20), (65, 7), (129, 64)] {
            case(cases, patches, most, [size, width]).await?;
        }
    }
    Ok(())
}

/// Compares `patches`, stored with at most `most` to a buffer.
async fn case(
    cases: &mut Cases<'_>,
    patches: &[[i32; 2]],
    most: usize,
    [size, width]: [u32; 2],
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let points = (size * size) as usize;
    let around = neighbours(patches);
    let mut expected = random_heights(size + width, points * patches.len(), LIMIT);
    let (mut outputs, mut parts) = (Vec::new(), Vec::new());
    for heights in expected.chunks(most * points) {
        let output = Poisoned::new(gpu, heights.len())?;
        output.buffer.write(gpu, heights)?;
        let count = (heights.len() / points) as u32;
        parts.push(Fields { heights: output.buffer.clone(), width: size, count });
        outputs.push(output);
    }
    let job = BorderPass::new(gpu)?.prepare(gpu, width, &around, &parts)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    moved(&mut expected, size, width, &around);
    for (part, (output, expected)) in outputs.iter().zip(expected.chunks(most * points)).enumerate() {
        let mut name = format!("{size}×{size} × {} patches, {width} samples", patches.len());
        if outputs.len() > 1 {
            name += &format!(", buffer {part}");
        }
        check_exact(cases, name, output, expected).await?;
    }
    Ok(())
}

/// Moves a batch of patches of `size`² heights, one after the other.
fn moved(heights: &mut [i32], size: u32, width: u32, around: &[Neighbours]) {
    let points = (size * size) as usize;
    for (index, around) in around.iter().enumerate() {
        let (earlier, rest) = heights.split_at_mut(index * points);
        let around = around.map(|at| at.map(|at| &earlier[at * points..(at + 1) * points]));
        border(&mut rest[..points], size as usize, width, around);
    }
}

/// Measures a grid of 8 × 8 patches. `copy` moves whole patches, though a kernel must only touch the strips along borders that
/// have a neighbour: a tenth of the samples here, in 15 dispatches, one after the other.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (size, width, count) = (257, 16, 64);
    let around = neighbours(&some_patches(count));
    let mut host = some_heights((size * size * count) as usize);
    let job = BorderPass::new(gpu)?.prepare(gpu, width, &around, &[uploaded(gpu, size, &host)?])?;
    measure(
        bench,
        "257x257 batch 64, 16 samples",
        host.len(),
        8,
        |encoder| job.record(encoder),
        || {
            moved(&mut host, size, width, &around);
        },
    )
}
