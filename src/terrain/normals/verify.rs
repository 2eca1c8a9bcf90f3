//! Parity cases of `kernels/terrain/normals.wgsl`.

use crate::Error;
use crate::harness::poison::Poisoned;
use crate::harness::{Cases, compare};
use crate::terrain::blocks::Columns;
use crate::terrain::fields::Fields;
use crate::terrain::normals::reference::normals;
use crate::terrain::normals::{NORMAL_BOUND, NormalsPass};
use crate::terrain::verify::{LIMIT, random_heights};

/// The cases cover slopes from flat to the limit, spacings from small to large.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    Columns::ALL.into_iter().try_for_each(|columns| with_columns(cases, columns))
}

fn with_columns(cases: &mut Cases<'_>, columns: Columns) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = NormalsPass::with_columns(gpu, columns)?;
    for (width, count) in [(3, 1), (65, 3), (66, 2), (67, 2), (131, 4)] {
        for (limit, terrain_scale) in
            [(0, 1.0), (1 << 16, 1.0), (LIMIT, 0.001), (LIMIT, 1e5), (1 << 22, 0.37)]
        {
            let heights = random_heights(width, (width * width * count) as usize, limit);
            let windows = Fields::new(gpu, "windows", width, count)?;
            windows.heights.write(gpu, &heights)?;
            let points = (width - 2).pow(2) as usize * count as usize;
            let (slopes, units) = (Poisoned::new(gpu, points)?, Poisoned::new(gpu, 3 * points)?);
            let job = pass.prepare(gpu, terrain_scale, &windows, &slopes.buffer, &units.buffer)?;
            gpu.run("verify", |encoder| job.record(encoder))?;
            let (mut expected_slopes, mut expected_units) = (Vec::new(), Vec::new());
            for window in heights.chunks_exact((width * width) as usize) {
                let (slopes, units) = normals(window, width as usize, terrain_scale);
                expected_slopes.extend(slopes);
                expected_units.extend(units.into_iter().flatten());
            }
            let wide = 4 * columns.quads;
            let name = format!(
                "{width}×{width} × {count}, heights to {limit}, spacing {terrain_scale}, {wide} wide"
            );
            cases.add(
                format!("{name}: gradients"),
                slopes.check(gpu, |actual| compare::exact(actual, &expected_slopes))?,
            );
            let comparison =
                units.check(gpu, |actual| compare::absolute(actual, &expected_units, NORMAL_BOUND))?;
            cases.add(format!("{name}: unit normals"), comparison);
        }
    }
    Ok(())
}
