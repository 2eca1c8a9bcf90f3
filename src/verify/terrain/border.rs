//! Parity of `kernels/terrain/border.wgsl`.

use super::{LIMIT, random_heights};
use crate::Error;
use crate::reference::terrain::border::border;
use crate::terrain::border::{BorderPass, neighbours};
use crate::verify::{Cases, compare::exact, poison::Poisoned};

/// Widths up to overlapping ones, orders with up to four neighbours, heights at the limit.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = BorderPass::new(gpu)?;
    let grid: Vec<[i32; 2]> = (0..9).map(|i| [i % 3 - 1, i / 3]).collect();
    let surrounded = vec![[1, 0], [0, 1], [2, 1], [1, 2], [1, 1]];
    for patches in [grid, surrounded, vec![[5, 5]]] {
        for (size, width) in [(3, 1), (5, 4), (33, 1), (33, 16), (33, 20), (65, 7), (129, 64)] {
            let points = (size * size) as usize;
            let around = neighbours(&patches);
            let mut expected = random_heights(size + width, points * patches.len(), LIMIT);
            let output = Poisoned::new(gpu, expected.len())?;
            output.buffer.write(gpu, &expected)?;
            let job = pass.prepare(gpu, size, width, &around, &output.buffer)?;
            gpu.run("verify", |encoder| job.record(encoder))?;
            for (index, around) in around.iter().enumerate() {
                let (earlier, rest) = expected.split_at_mut(index * points);
                let around = around.map(|at| at.map(|at| &earlier[at * points..(at + 1) * points]));
                border(&mut rest[..points], size as usize, width, around);
            }
            let name = format!("{size}×{size} × {} patches, {width} samples", patches.len());
            cases.add(name, output.check(gpu, |actual| exact(actual, &expected))?);
        }
    }
    Ok(())
}
