//! Benchmark cases of `terrain/despike`: removal of spikes.

use crate::Error;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_windows};
use crate::terrain::despike::reference::despike;
use crate::terrain::despike::{Despike, DespikeBuffers, DespikePass};
use crate::terrain::features::FeatureIndex;
use crate::terrain::fields::Fields;

/// Measures a batch of 64 patches.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
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
