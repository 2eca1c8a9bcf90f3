//! Benchmark cases of `terrain/hydraulic`: hydraulic erosion, by the cycle. A cycle reads and writes 20 bytes a sample, and
//! `copy` moves as many.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;
use crate::terrain::config::{Config, Interpolation};
use crate::terrain::features::Features;
use crate::terrain::field::generate;
use crate::terrain::fields::Fields;
use crate::terrain::hydraulic::reference::hydraulic;
use crate::terrain::hydraulic::{Hydraulic, HydraulicBuffers, HydraulicPass};

/// Measures ten cycles of a batch of 16 patches, and of one field of 1024² samples.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    case(bench, "257x257 batch 16, 10 cycles", [257, 16], 10)?;
    case(bench, "1024x1024, 10 cycles", [1025, 1], 10)
}

fn case(bench: &mut Bench<'_>, name: &str, [size, count]: [u32; 2], iterations: u32) -> Result<(), Error> {
    let gpu = bench.gpu;
    let config = Config { interpolation: Interpolation::Smooth, ..Config::new(size, 40.0, "bench")? };
    let patches: Vec<_> = (0..count as i32).map(|column| [column, 0]).collect();
    let host = generate(&config, &Features::default(), &patches, iterations);
    let width = size + 2 * iterations;
    let windows = Fields::new(gpu, "windows", width, count)?;
    windows.heights.write(gpu, &host.concat())?;
    let other = Fields::new(gpu, "other", width - 2, count)?;
    let points = HydraulicPass::flow_points(&windows);
    let [flows, other_flows] = [Buffer::new(gpu, "flows", points)?, Buffer::new(gpu, "other flows", points)?];
    let params = Hydraulic { iterations, ..Hydraulic::default() };
    let buffers =
        HydraulicBuffers { windows: &windows, other: &other, flows: &flows, other_flows: &other_flows };
    let job = HydraulicPass::new(gpu)?.prepare(gpu, params, 1.0, buffers)?;
    let points = (1..=iterations).map(|cycle| windows.cropped(cycle).points(0)).sum::<usize>();
    let copied = copy_of(gpu, 5 * points / iterations as usize)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::recorded(Backend::Copy, |encoder| (0..iterations).for_each(|_| copied.record(encoder))),
        Contender::host(Backend::Reference, || {
            for window in &host {
                let (mut ground, mut flow) = (window.clone(), vec![[0; 4]; window.len()]);
                for cycle in 0..iterations {
                    let params = params.params(1.0, cycle, width - 2 * cycle);
                    (ground, flow) = hydraulic(&ground, &flow, &params);
                }
                drop(std::hint::black_box((ground, flow)));
            }
        }),
    ];
    bench.case(name, (points, "point"), 40 * points as u64, contenders)
}
