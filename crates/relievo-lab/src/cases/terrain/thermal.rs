//! Parity and benchmark cases of `kernels/terrain/thermal.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::thermal::reference::thermal;
use relievo::ops::terrain::thermal::{Thermal, ThermalBuffers, ThermalPass};

use crate::cases::terrain::{LIMIT, check_exact, measure, random_heights, some_windows};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases};

/// The cases cover odd and even numbers of iterations, angles from 0 up, and heights at the limit.
/// Both buffers are compared as a whole.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = ThermalPass::new(gpu)?;
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
                for iteration in 1..=iterations {
                    fields = iterated(&fields, width + 2 - 2 * iteration, params);
                    expected[iteration as usize % 2][..fields.len()].copy_from_slice(&fields);
                }
                for (at, output) in outputs.iter().enumerate() {
                    let last = if at == iterations as usize % 2 { "" } else { ", before the last" };
                    let name =
                        format!("{width}×{width} × {count}, {iterations} iterations, talus {talus}°{last}");
                    check_exact(cases, name, output, &expected[at]).await?;
                }
            }
        }
    }
    Ok(())
}

/// Windows of `width`² samples after an iteration.
fn iterated(windows: &[i32], width: u32, params: Thermal) -> Vec<i32> {
    let windows = windows.chunks_exact((width * width) as usize);
    windows.flat_map(|window| thermal(window, width as usize, params.fixed_threshold(1.0))).collect()
}

/// Measures one iteration of a batch of 64 patches, and fifty of one field of 513².
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    for (name, [width, count], iterations) in
        [("257x257 batch 64, 1 iteration", [259, 64], 1), ("513x513, 50 iterations", [613, 1], 50)]
    {
        let gpu = bench.gpu;
        let (host, windows) = some_windows(gpu, width, count)?;
        let other = Fields::new(gpu, "other", width, count)?;
        let params = Thermal { iterations, ..Thermal::default() };
        let buffers = ThermalBuffers { windows: &windows, other: &other };
        let job = ThermalPass::new(gpu)?.prepare(gpu, params, 1.0, buffers)?;
        let points = (1..=iterations).map(|iteration| windows.points(iteration)).sum::<usize>();
        measure(
            bench,
            name,
            points,
            8,
            |encoder| job.record(encoder),
            || {
                let last = |fields: Vec<i32>, iteration| iterated(&fields, width - 2 * iteration, params);
                drop(black_box((0..iterations).fold(host.clone(), last)));
            },
        )?;
    }
    Ok(())
}
