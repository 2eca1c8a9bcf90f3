//! Parity and benchmark cases of `kernels/terrain/replace.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::terrain::replace::reference::replace;
use relievo::ops::terrain::replace::{NOT_GIVEN, ReplaceBuffers, ReplacePass};

use crate::cases::terrain::{LIMIT, measure, random_heights};
use crate::harness::compare::exact;
use crate::harness::{Bench, Cases};

/// Heights of which none, some and all are given, in regions around workgroup boundaries.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = ReplacePass::new(gpu)?;
    for (width, count) in [(1, 1), (63, 2), (64, 1), (65, 3)] {
        for every in [0, 1, 3] {
            let points = (count * width * width) as usize;
            let mut expected = random_heights(width, points, LIMIT);
            let given = given(width + 1, points, every);
            let heights = Buffer::from_slice(gpu, "heights", &expected)?;
            let given_heights = Buffer::from_slice(gpu, "given", &given)?;
            let buffers = ReplaceBuffers { given: &given_heights, heights: &heights };
            let job = pass.prepare(gpu, width, count, buffers)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            replace(&mut expected, &given);
            let found = heights.read(gpu).await?;
            cases
                .add(format!("{count} regions of {width}², every {every}th given"), exact(&found, &expected));
        }
    }
    Ok(())
}

/// Random heights of which every `every`th is given; 0: none.
fn given(seed: u32, points: usize, every: usize) -> Vec<i32> {
    let is_given = |at: usize| every > 0 && at.is_multiple_of(every);
    let heights = random_heights(seed, points, LIMIT).into_iter().enumerate();
    heights.map(|(at, height)| if is_given(at) { height } else { NOT_GIVEN }).collect()
}

/// Measures four regions of 273 × 273 heights, of which every second is given.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu: &Gpu = bench.gpu;
    let (width, count) = (273_u32, 4);
    let points = (count * width * width) as usize;
    let mut own = random_heights(1, points, LIMIT);
    let some = given(2, points, 2);
    let heights = Buffer::from_slice(gpu, "heights", &own)?;
    let given = Buffer::from_slice(gpu, "given", &some)?;
    let buffers = ReplaceBuffers { given: &given, heights: &heights };
    let job = ReplacePass::new(gpu)?.prepare(gpu, width, count, buffers)?;
    measure(
        bench,
        "273x273 batch 4",
        points,
        count as usize,
        |encoder| job.record(encoder),
        || {
            replace(&mut own, &some);
            black_box(&own);
        },
    )
}
