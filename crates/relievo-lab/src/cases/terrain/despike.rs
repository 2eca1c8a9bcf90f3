//! Parity and benchmark cases of `kernels/terrain/despike.wgsl`.

use relievo::Error;
use relievo::terrain::blocks::Columns;
use relievo::terrain::despike::reference::despike;
use relievo::terrain::despike::{Despike, DespikeBuffers, DespikePass};
use relievo::terrain::features::FeatureIndex;
use relievo::terrain::fields::Fields;

use crate::cases::terrain::{LIMIT, copy_of, random_heights, random_words, some_windows};
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover thresholds from 0 up, widths around workgroup boundaries, with and without features.
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
    for with_features in [false, true] {
        let pass = DespikePass::with_columns(cases.gpu, with_features, columns)?;
        for (case, (width, count)) in
            [(3, 1), (5, 3), (34, 2), (65, 5), (66, 4), (67, 3), (131, 2)].into_iter().enumerate()
        {
            for threshold in [0.0, 0.5, 300.0, 16383.0] {
                check(
                    cases,
                    (&pass, columns),
                    with_features.then_some(case as u32),
                    Despike { threshold },
                    [width, count],
                )
                .await?;
            }
        }
    }
    Ok(())
}

async fn check(
    cases: &mut Cases<'_>,
    (pass, columns): (&DespikePass, Columns),
    features: Option<u32>,
    params: Despike,
    [width, count]: [u32; 2],
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let (edge, points) = (width as usize, (width * width) as usize);
    let limit = if params.threshold > 1.0 { LIMIT } else { 1 << 17 };
    let heights = random_heights(width, points * count as usize, limit);
    let windows = Fields::new(gpu, "windows", width, count)?;
    windows.heights.write(gpu, &heights)?;
    let output = Poisoned::new(gpu, (edge - 2).pow(2) * count as usize)?;
    let cropped = Fields { heights: output.buffer.clone(), width: width - 2, count };
    // A third of all points are features, those of the outermost ring included.
    let marks: Vec<Vec<bool>> = (0..count)
        .map(|window| {
            let words = features.map_or(vec![1; points], |case| random_words(case ^ window, points));
            words.into_iter().map(|word| word.is_multiple_of(3)).collect()
        })
        .collect();
    let index = FeatureIndex::new(gpu, &[width], count, features.map_or(0, |_| points * count as usize))?;
    index.write(gpu, count, |_, window| {
        let marked = marks[window as usize].iter().enumerate().filter(|(_, marked)| **marked);
        marked.map(|(at, _)| (at as u32 % width + 1, at as u32 / width + 1, 7)).collect()
    })?;
    let buffers = DespikeBuffers { windows: &windows, features: &index, cropped: &cropped };
    let job = pass.prepare(gpu, params, buffers)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> = (heights.chunks_exact(points).zip(&marks))
        .flat_map(|(window, marks)| {
            despike(window, edge, params.fixed_threshold(), |x, y| marks[y * edge + x])
        })
        .collect();
    let name = format!(
        "{width}×{width} × {count}, threshold {}, {} wide{}",
        params.threshold,
        4 * columns.quads,
        features.map_or("", |_| ", a third injected")
    );
    cases.add(name, output.check(gpu, |actual| exact(actual, &expected)).await?);
    Ok(())
}

/// Measures a batch of 64 patches.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259_u32, 64);
    let (host, windows) = some_windows(gpu, width, count)?;
    let cropped = Fields::new(gpu, "cropped", width - 2, count)?;
    let features = FeatureIndex::new(gpu, &[width], count, 0)?;
    let params = Despike { threshold: 1.0 };
    let buffers = DespikeBuffers { windows: &windows, features: &features, cropped: &cropped };
    let job = DespikePass::new(gpu, false)?.prepare(gpu, params, buffers)?;
    let copied = copy_of(gpu, cropped.heights.len())?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            for window in host.chunks_exact((width * width) as usize) {
                let field = despike(window, width as usize, params.fixed_threshold(), |_, _| false);
                drop(std::hint::black_box(field));
            }
        }),
    ];
    let points = cropped.heights.len();
    bench.case("257x257 batch 64", (points, "point"), 8 * points as u64, contenders)
}
