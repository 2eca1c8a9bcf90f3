//! Parity and benchmark cases of `kernels/terrain/thermal.wgsl`.

use relievo::Error;
use relievo::terrain::blocks::Columns;
use relievo::terrain::fields::Fields;
use relievo::terrain::thermal::reference::thermal;
use relievo::terrain::thermal::{Thermal, ThermalBuffers, ThermalPass};

use crate::cases::terrain::{LIMIT, copy_of, random_heights, some_windows};
use crate::harness::compare::exact;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover odd and even numbers of iterations, angles from 0 up, and heights at the limit.
/// Both buffers are compared as a whole.
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
    let pass = ThermalPass::with_columns(gpu, columns)?;
    for (width, count) in [(3, 2), (23, 3), (66, 5), (130, 2)] {
        for iterations in [1, 2, 5, 10].into_iter().filter(|iterations| 2 * iterations < width) {
            for (talus, limit) in [(0.0, LIMIT / 2), (35.0, 1 << 20), (89.0, LIMIT / 2)] {
                let params = Thermal { iterations, talus };
                let mut fields = random_heights(width, (width * width * count) as usize, limit);
                let outputs = [Poisoned::new(gpu, fields.len())?, Poisoned::new(gpu, fields.len())?];
                let [windows, other] =
                    [0, 1].map(|i| Fields { heights: outputs[i].buffer.clone(), width, count });
                windows.heights.write(gpu, &fields)?;
                let job =
                    pass.prepare(gpu, params, 1.0, ThermalBuffers { windows: &windows, other: &other })?;
                gpu.submit("verify", |encoder| job.record(encoder))?;
                // What the iterations leave in the first part of either buffer, over its previous contents.
                let mut expected = [fields.clone(), vec![POISON as i32; fields.len()]];
                let mut edge = width as usize;
                for iteration in 1..=iterations as usize {
                    let windows = fields.chunks_exact(edge * edge);
                    fields = windows
                        .flat_map(|window| thermal(window, edge, params.fixed_threshold(1.0)))
                        .collect();
                    edge -= 2;
                    expected[iteration % 2][..fields.len()].copy_from_slice(&fields);
                }
                let wide = 4 * columns.quads;
                let name = format!(
                    "{width}×{width} × {count}, {iterations} iterations, talus {talus}°, {wide} wide"
                );
                let result = iterations as usize % 2;
                for (what, at) in [("", result), (", before the last", 1 - result)] {
                    let comparison = outputs[at].check(gpu, |actual| exact(actual, &expected[at])).await?;
                    cases.add(format!("{name}{what}"), comparison);
                }
            }
        }
    }
    Ok(())
}

/// Measures one iteration of a batch of 64 patches, and fifty of one field of 513².
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
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
