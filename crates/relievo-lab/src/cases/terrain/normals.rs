//! Parity and benchmark cases of `kernels/terrain/normals.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::terrain::normals::reference::normals;
use relievo::ops::terrain::normals::{NORMAL_BOUND, NormalsPass};

use crate::cases::terrain::{LIMIT, check_exact, measure, random_windows, some_windows};
use crate::harness::compare::absolute;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// The cases cover slopes from flat to the limit, spacings from small to large.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = NormalsPass::new(gpu)?;
    for (width, count) in [(3, 1), (65, 3), (66, 2), (67, 2), (131, 4)] {
        for (limit, terrain_scale) in
            [(0, 1.0), (1 << 16, 1.0), (LIMIT, 0.001), (LIMIT, 1e5), (1 << 22, 0.37)]
        {
            let (heights, windows) = random_windows(gpu, [width, count], limit)?;
            let points = windows.points(1);
            let (slopes, units) = (Poisoned::new(gpu, points)?, Poisoned::new(gpu, 3 * points)?);
            let job = pass.prepare(gpu, terrain_scale, &windows, &slopes.buffer, &units.buffer)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let (mut expected_slopes, mut expected_units) = (Vec::new(), Vec::new());
            for window in heights.chunks_exact((width * width) as usize) {
                let (slopes, units) = normals(window, width as usize, terrain_scale);
                expected_slopes.extend(slopes);
                expected_units.extend(units.into_iter().flatten());
            }
            let name = format!("{width}×{width} × {count}, heights to {limit}, spacing {terrain_scale}");
            check_exact(cases, format!("{name}: gradients"), &slopes, &expected_slopes).await?;
            let comparison =
                units.check(gpu, |actual| absolute(actual, &expected_units, NORMAL_BOUND)).await?;
            cases.add(format!("{name}: unit normals"), comparison);
        }
    }
    Ok(())
}

/// Measures a batch of 64 patches: the kernel reads 4 bytes and writes 20 per point.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259, 64);
    let (host, windows) = some_windows(gpu, width, count)?;
    let points = windows.points(1);
    let (slopes, units) = (Buffer::new(gpu, "slopes", points)?, Buffer::new(gpu, "normals", 3 * points)?);
    let job = NormalsPass::new(gpu)?.prepare(gpu, 1.0, &windows, &slopes, &units)?;
    measure(
        bench,
        "257x257 batch 64",
        points,
        24,
        |encoder| job.record(encoder),
        || {
            for window in host.chunks_exact((width * width) as usize) {
                drop(black_box(normals(window, width as usize, 1.0)));
            }
        },
    )
}
