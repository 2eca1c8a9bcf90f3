//! Parity and benchmark cases of `kernels/terrain/normals.wgsl`.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::terrain::blocks::Columns;
use relievo::terrain::fields::Fields;
use relievo::terrain::normals::reference::normals;
use relievo::terrain::normals::{NORMAL_BOUND, NormalsPass};

use crate::cases::terrain::{LIMIT, copy_of, random_heights, some_windows};
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender, compare};

/// The cases cover slopes from flat to the limit, spacings from small to large.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for columns in Columns::ALL {
        with_columns(cases, columns).await?;
    }
    Ok(())
}

async fn with_columns(cases: &mut Cases<'_>, columns: Columns) -> Result<(), Error> {
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
            gpu.submit("verify", |encoder| job.record(encoder))?;
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
                slopes.check(gpu, |actual| compare::exact(actual, &expected_slopes)).await?,
            );
            let comparison =
                units.check(gpu, |actual| compare::absolute(actual, &expected_units, NORMAL_BOUND)).await?;
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
    let (width, count) = (259_u32, 64);
    let (host, windows) = some_windows(gpu, width, count)?;
    let points = (width as usize - 2).pow(2) * count as usize;
    let (slopes, units) = (Buffer::new(gpu, "slopes", points)?, Buffer::new(gpu, "normals", 3 * points)?);
    let job = NormalsPass::new(gpu)?.prepare(gpu, 1.0, &windows, &slopes, &units)?;
    // A copy reads half of the bytes that it moves, and writes the other half.
    let copied = copy_of(gpu, 3 * points)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            for window in host.chunks_exact((width * width) as usize) {
                drop(std::hint::black_box(normals(window, width as usize, 1.0)));
            }
        }),
    ];
    bench.case("257x257 batch 64", (points, "point"), 24 * points as u64, contenders)
}
