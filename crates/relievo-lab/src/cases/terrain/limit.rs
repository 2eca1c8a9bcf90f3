//! Parity and benchmark cases of `kernels/terrain/limit.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::terrain::limit::reference::{ErodedAt, limit};
use relievo::ops::terrain::limit::{ErosionLimit, LimitBuffers, LimitPass, LimitShape};

use crate::cases::terrain::{LIMIT, measure, random_heights};
use crate::harness::compare::exact;
use crate::harness::{Bench, Cases};

/// Heights before erosion, eroded heights, and the corners of regions among these: at both ends, and in between.
struct Case {
    shape: LimitShape,
    origins: Vec<i32>,
    eroded: Vec<i32>,
    corners: Vec<u32>,
}

impl Case {
    fn new(shape: LimitShape) -> Self {
        let LimitShape { count, width, eroded_width } = shape;
        let origins = random_heights(width, (count * width * width) as usize, LIMIT);
        // Rows enough for all regions, each below the last and further to the right.
        let rows = width + 2 * (count - 1);
        let eroded = random_heights(width + 1, (rows * eroded_width) as usize, LIMIT);
        let room = eroded_width - width;
        let corners = (0..count).map(|at| 2 * at * eroded_width + room * at / (count - 1).max(1)).collect();
        Self { shape, origins, eroded, corners }
    }

    /// The reference's heights of all regions.
    fn expected(&self, erosion: ErosionLimit) -> Vec<i32> {
        let regions = self.origins.chunks_exact((self.shape.width as usize).pow(2)).zip(&self.corners);
        let width = self.shape.eroded_width as usize;
        let heights = |(origins, corner): (&[i32], &u32)| {
            let eroded = ErodedAt { heights: &self.eroded, width, corner: *corner as usize };
            limit(origins, eroded, erosion.fixed_depth())
        };
        regions.flat_map(heights).collect()
    }
}

/// Small and large limits, regions around workgroup boundaries, as wide as the eroded heights and narrower, and fewer heights than
/// the buffers hold.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = LimitPass::new(gpu)?;
    for (count, width, eroded_width) in [(1, 1, 1), (2, 63, 63), (1, 64, 90), (3, 65, 131)] {
        let case = Case::new(LimitShape { count, width, eroded_width });
        let [origins, eroded] = [("origins", &case.origins), ("eroded", &case.eroded)]
            .map(|(label, heights)| Buffer::from_slice(gpu, label, heights));
        let (origins, eroded) = (origins?, eroded?);
        let corners = Buffer::from_slice(gpu, "corners", &case.corners)?;
        for depth in [0.001, 3.5, 1000.0] {
            let erosion = ErosionLimit { depth };
            let mut expected = case.expected(erosion);
            expected.resize(expected.len() + 3, 7);
            let heights = Buffer::from_slice(gpu, "heights", &vec![7; expected.len()])?;
            let buffers =
                LimitBuffers { origins: &origins, eroded: &eroded, corners: &corners, heights: &heights };
            let job = pass.prepare(gpu, erosion, case.shape, buffers)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let found = heights.read(gpu).await?;
            let name = format!("{count} regions of {width}² in rows of {eroded_width} within {depth}");
            cases.add(name, exact(&found, &expected));
        }
    }
    Ok(())
}

/// Measures four regions of 273 × 273 heights in rows of 545.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu: &Gpu = bench.gpu;
    let shape = LimitShape { count: 4, width: 273, eroded_width: 545 };
    let (case, erosion) = (Case::new(shape), ErosionLimit { depth: 4.0 });
    let origins = Buffer::from_slice(gpu, "origins", &case.origins)?;
    let eroded = Buffer::from_slice(gpu, "eroded", &case.eroded)?;
    let corners = Buffer::from_slice(gpu, "corners", &case.corners)?;
    let heights = Buffer::new(gpu, "heights", case.origins.len())?;
    let buffers = LimitBuffers { origins: &origins, eroded: &eroded, corners: &corners, heights: &heights };
    let job = LimitPass::new(gpu)?.prepare(gpu, erosion, shape, buffers)?;
    measure(
        bench,
        "273x273 batch 4",
        case.origins.len(),
        4,
        |encoder| job.record(encoder),
        || {
            black_box(case.expected(erosion));
        },
    )
}
