//! Benchmark cases of `terrain/thermal`: thermal erosion, by the iteration.

use crate::Error;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_windows};
use crate::terrain::fields::Fields;
use crate::terrain::thermal::reference::thermal;
use crate::terrain::thermal::{Thermal, ThermalBuffers, ThermalPass};

/// Measures one iteration of a batch of 64 patches, and fifty of one field of 513².
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    case(bench, "257x257 batch 64, 1 iteration", [259, 64], 1)?;
    case(bench, "513x513, 50 iterations", [613, 1], 50)
}

fn case(bench: &mut Bench<'_>, name: &str, [width, count]: [u32; 2], iterations: u32) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (host, windows) = some_windows(gpu, width, count)?;
    let other = Fields::new(gpu, "other", width, count)?;
    let params = Thermal { iterations, ..Thermal::default() };
    let job = ThermalPass::new(gpu)?.prepare(
        gpu,
        params,
        1.0,
        ThermalBuffers { windows: &windows, other: &other },
    )?;
    let points = (0..iterations).map(|i| ((width - 2 * i - 2).pow(2) * count) as usize).sum::<usize>();
    let copied = copy_of(gpu, points / iterations as usize)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::recorded(Backend::Copy, |encoder| (0..iterations).for_each(|_| copied.record(encoder))),
        Contender::host(Backend::Reference, || {
            for window in host.chunks_exact((width * width) as usize) {
                let mut field = window.to_vec();
                for iteration in 0..iterations {
                    field = thermal(&field, (width - 2 * iteration) as usize, params.fixed_threshold(1.0));
                }
                drop(std::hint::black_box(field));
            }
        }),
    ];
    bench.case(name, (points, "point"), 8 * points as u64, contenders)
}
