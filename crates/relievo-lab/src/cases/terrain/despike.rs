//! Parity and benchmark cases of `kernels/terrain/despike.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::ops::terrain::despike::reference::despike;
use relievo::ops::terrain::despike::{Despike, DespikeBuffers, DespikePass};
use relievo::ops::terrain::features::FeatureIndex;
use relievo::ops::terrain::fields::Fields;

use crate::cases::terrain::{LIMIT, check_exact, measure, random_windows, random_words, some_windows};
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// The cases cover thresholds from 0 up, widths around workgroup boundaries, with and without features.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let sizes = [(3, 1), (5, 3), (34, 2), (65, 5), (66, 4), (67, 3), (131, 2)];
    for with_features in [false, true] {
        for (case, (width, count)) in (0..).zip(sizes) {
            for threshold in [0.0, 0.5, 300.0, 16383.0] {
                let features = with_features.then_some(case);
                check(cases, features, Despike { threshold }, [width, count]).await?;
            }
        }
    }
    Ok(())
}

async fn check(
    cases: &mut Cases<'_>,
    features: Option<u32>,
    params: Despike,
    [width, count]: [u32; 2],
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let (edge, points) = (width as usize, (width * width) as usize);
    let limit = if params.threshold > 1.0 { LIMIT } else { 1 << 17 };
    let (heights, windows) = random_windows(gpu, [width, count], limit)?;
    let output = Poisoned::new(gpu, windows.points(1))?;
    let cropped = Fields { heights: output.buffer.clone(), width: width - 2, count };
    // A third of all points are features, those of the outermost ring included.
    let marks: Vec<Vec<bool>> = (0..count)
        .map(|window| {
            let words = features.map_or(vec![1; points], |case| random_words(case ^ window, points));
            words.into_iter().map(|word| word.is_multiple_of(3)).collect()
        })
        .collect();
    let index = FeatureIndex::new(gpu, &[width], count, features.map_or(0, |_| heights.len()))?;
    index.write(&mut &*gpu, count, |_, window| {
        let marked = marks[window as usize].iter().enumerate().filter(|(_, marked)| **marked);
        marked.map(|(at, _)| (at as u32 % width + 1, at as u32 / width + 1, 7)).collect()
    })?;
    let buffers = DespikeBuffers { windows: &windows, features: &index, cropped: &cropped };
    let pass = match features {
        Some(_) => DespikePass::with_features(gpu)?,
        None => DespikePass::new(gpu)?,
    };
    let job = pass.prepare(gpu, params, buffers)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> = (heights.chunks_exact(points).zip(&marks))
        .flat_map(|(window, marks)| {
            despike(window, edge, params.fixed_threshold(), |x, y| marks[y * edge + x])
        })
        .collect();
    let injected = features.map_or("", |_| ", a third injected");
    let name = format!("{width}×{width} × {count}, threshold {}{injected}", params.threshold);
    check_exact(cases, name, &output, &expected).await
}

/// Measures a batch of 64 patches.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259, 64);
    let (host, windows) = some_windows(gpu, width, count)?;
    let cropped = Fields::new(gpu, "cropped", width - 2, count)?;
    let features = FeatureIndex::new(gpu, &[width], count, 0)?;
    let params = Despike { threshold: 1.0 };
    let buffers = DespikeBuffers { windows: &windows, features: &features, cropped: &cropped };
    let job = DespikePass::new(gpu)?.prepare(gpu, params, buffers)?;
    measure(
        bench,
        "257x257 batch 64",
        windows.points(1),
        8,
        |encoder| job.record(encoder),
        || {
            for window in host.chunks_exact((width * width) as usize) {
                drop(black_box(despike(window, width as usize, params.fixed_threshold(), |_, _| false)));
            }
        },
    )
}
