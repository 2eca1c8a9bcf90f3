//! Parity cases of `kernels/terrain/thermal.wgsl`.

use crate::Error;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::POISON;
use crate::harness::poison::Poisoned;
use crate::terrain::blocks::Columns;
use crate::terrain::fields::Fields;
use crate::terrain::thermal::reference::thermal;
use crate::terrain::thermal::{Thermal, ThermalBuffers, ThermalPass};
use crate::terrain::verify::{LIMIT, random_heights};

/// The cases cover odd and even numbers of iterations, angles from 0 up, and heights at the limit.
/// Both buffers are compared as a whole.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    Columns::ALL.into_iter().try_for_each(|columns| with_columns(cases, columns))
}

fn with_columns(cases: &mut Cases<'_>, columns: Columns) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = ThermalPass::with_columns(gpu, columns)?;
    for (width, count) in [(3, 2), (23, 3), (66, 5), (130, 2)] {
        for iterations in [1, 2, 5, 10].into_iter().filter(|iterations| 2 * iterations < width) {
            for (talus, limit) in [(0.0, LIMIT / 2), (35.0, 1 << 20), (89.0, LIMIT / 2)] {
                let params = Thermal { iterations, talus };
                let mut fields = random_heights(width, (width * width * count) as usize, limit);
                let outputs = [Poisoned::new(gpu, fields.len())?, Poisoned::new(gpu, fields.len())?];
                let [windows, other] =
                    [0, 1].map(|i| Fields { heights: outputs[i].buffer.clone(), width, count });
                windows.heights.write(gpu, &fields)?;
                let job =
                    pass.prepare(gpu, params, 1.0, ThermalBuffers { windows: &windows, other: &other })?;
                gpu.run("verify", |encoder| job.record(encoder))?;
                // What the iterations leave in the first part of either buffer, over its previous contents.
                let mut expected = [fields.clone(), vec![POISON as i32; fields.len()]];
                let mut edge = width as usize;
                for iteration in 1..=iterations as usize {
                    let windows = fields.chunks_exact(edge * edge);
                    fields = windows
                        .flat_map(|window| thermal(window, edge, params.fixed_threshold(1.0)))
                        .collect();
                    edge -= 2;
                    expected[iteration % 2][..fields.len()].copy_from_slice(&fields);
                }
                let wide = 4 * columns.quads;
                let name = format!(
                    "{width}×{width} × {count}, {iterations} iterations, talus {talus}°, {wide} wide"
                );
                let result = iterations as usize % 2;
                for (what, at) in [("", result), (", before the last", 1 - result)] {
                    let comparison = outputs[at].check(gpu, |actual| exact(actual, &expected[at]))?;
                    cases.add(format!("{name}{what}"), comparison);
                }
            }
        }
    }
    Ok(())
}
