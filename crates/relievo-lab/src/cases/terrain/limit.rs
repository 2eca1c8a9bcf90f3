//! Parity and benchmark cases of `kernels/terrain/limit.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::terrain::limit::reference::limit;
use relievo::ops::terrain::limit::{ErosionLimit, LimitBuffers, LimitPass};

use crate::cases::terrain::{LIMIT, measure, random_heights};
use crate::harness::compare::exact;
use crate::harness::{Bench, Cases};

/// Small and large limits, numbers of heights around workgroup boundaries, and fewer heights than the buffers hold.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = LimitPass::new(gpu)?;
    for points in [1_usize, 63, 64, 65, 4097] {
        for depth in [0.001, 3.5, 1000.0] {
            let erosion = ErosionLimit { depth };
            let (origins, mut expected) =
                (random_heights(1, points + 3, LIMIT), random_heights(2, points + 3, LIMIT));
            let own = Buffer::from_slice(gpu, "origins", &origins)?;
            let heights = Buffer::from_slice(gpu, "heights", &expected)?;
            let buffers = LimitBuffers { origins: &own, heights: &heights };
            let job = pass.prepare(gpu, erosion, points, buffers)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            limit(&origins[..points], &mut expected[..points], erosion.fixed_depth());
            let found = heights.read(gpu).await?;
            cases.add(format!("{points} heights within {depth}"), exact(&found, &expected));
        }
    }
    Ok(())
}

/// Measures four regions of 545 × 545 heights.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu: &Gpu = bench.gpu;
    let (points, erosion) = (4 * 545 * 545, ErosionLimit { depth: 4.0 });
    let (origins, mut own) = (random_heights(1, points, LIMIT), random_heights(2, points, LIMIT));
    let before = Buffer::from_slice(gpu, "origins", &origins)?;
    let heights = Buffer::from_slice(gpu, "heights", &own)?;
    let buffers = LimitBuffers { origins: &before, heights: &heights };
    let job = LimitPass::new(gpu)?.prepare(gpu, erosion, points, buffers)?;
    measure(
        bench,
        "545x545 batch 4",
        (points, 4),
        |encoder| job.record(encoder),
        || {
            limit(&origins, &mut own, erosion.fixed_depth());
            black_box(&own);
        },
    )
}
