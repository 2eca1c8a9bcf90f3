//! Parity cases of `kernels/terrain/border.wgsl`.

use crate::Error;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::terrain::border::reference::border;
use crate::terrain::border::{BorderPass, neighbours};
use crate::terrain::fields::Fields;
use crate::terrain::verify::{LIMIT, random_heights};

/// The cases cover widths up to overlapping transitions, orders of generation with up to four neighbours,
/// heights at the limit, and batches in one buffer and in several.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let pass = BorderPass::new(cases.gpu)?;
    let grid: Vec<[i32; 2]> = (0..9).map(|i| [i % 3 - 1, i / 3]).collect();
    let surrounded = vec![[1, 0], [0, 1], [2, 1], [1, 2], [1, 1]];
    for (patches, most) in [(&grid, 9), (&grid, 4), (&surrounded, 5), (&surrounded, 2), (&vec![[5, 5]], 1)] {
        for (size, width) in [(3, 1), (5, 4), (33, 1), (33, 16), (33, 20), (65, 7), (129, 64)] {
            case(cases, &pass, patches, most, [size, width])?;
        }
    }
    Ok(())
}

/// Compares `patches`, stored with at most `most` to a buffer.
fn case(
    cases: &mut Cases<'_>,
    pass: &BorderPass,
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
    let job = pass.prepare(gpu, width, &around, &parts)?;
    gpu.run("verify", |encoder| job.record(encoder))?;
    for (index, around) in around.iter().enumerate() {
        let (earlier, rest) = expected.split_at_mut(index * points);
        let around = around.map(|at| at.map(|at| &earlier[at * points..(at + 1) * points]));
        border(&mut rest[..points], size as usize, width, around);
    }
    for (part, (output, expected)) in outputs.iter().zip(expected.chunks(most * points)).enumerate() {
        let mut name = format!("{size}×{size} × {} patches, {width} samples", patches.len());
        if outputs.len() > 1 {
            name += &format!(", buffer {part}");
        }
        cases.add(name, output.check(gpu, |actual| exact(actual, expected))?);
    }
    Ok(())
}
