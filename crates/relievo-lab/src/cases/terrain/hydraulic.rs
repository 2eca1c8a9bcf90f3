//! Parity and benchmark cases of `kernels/terrain/hydraulic.wgsl`.
//!
//! The benchmark measures a cycle, which reads and writes 20 bytes a sample; `copy` moves as many.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::terrain::config::{Config, Interpolation};
use relievo::terrain::features::Features;
use relievo::terrain::field::generate;
use relievo::terrain::fields::Fields;
use relievo::terrain::hydraulic::pass::Shape;
use relievo::terrain::hydraulic::reference::{Flow, hydraulic};
use relievo::terrain::hydraulic::{Hydraulic, HydraulicBuffers, HydraulicPass};

use crate::cases::terrain::{LIMIT, copy_of, random_heights};
use crate::harness::compare::exact;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender};

/// Windows of one case.
struct Case {
    width: u32,
    count: u32,
    limit: i32,
    params: Hydraulic,
    terrain_scale: f64,
}

/// The cases cover sizes around workgroups and blocks of rows, odd and even numbers of cycles, rain that ends between two cycles
/// of a dispatch, parameters at both bounds, and heights at the limit. All four buffers are compared as a whole.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let shapes = [[1, 1], [1, 16], [2, 1], [2, 3]].map(|[cycles, rows]| Shape { cycles, rows });
    for shape in shapes.into_iter().chain([Shape::HARDWARE, Shape::SOFTWARE]) {
        let pass = HydraulicPass::with_shape(cases.gpu, shape)?;
        for (width, count) in [(3, 2), (23, 3), (66, 3), (67, 2), (130, 2)] {
            for iterations in [1, 2, 5, 6, 10].into_iter().filter(|iterations| 2 * iterations < width) {
                for (kind, params) in kinds().into_iter().enumerate() {
                    let (limit, terrain_scale) =
                        [(1 << 20, 1.0), (LIMIT, 1e6), (LIMIT, 1e-6), (1 << 24, 30.0)][kind];
                    let params = Hydraulic { iterations, ..params };
                    let case = Case { width, count, limit, params, terrain_scale };
                    let name =
                        format!("{width}×{width} × {count}, {iterations} cycles, kind {kind}, {shape:?}");
                    compare(cases, (&pass, shape), &name, &case).await?;
                }
            }
        }
    }
    Ok(())
}

/// Ordinary parameters, the largest and the smallest, and much rain that runs off.
fn kinds() -> [Hydraulic; 4] {
    let ordinary =
        Hydraulic { rain: 0.02, threshold: 1.0, erosion: 0.1, deposition: 0.1, ..Hydraulic::default() };
    let [capacity, rain] = [1024.0, 1.0];
    let largest = Hydraulic {
        rain,
        capacity,
        threshold: 0.0,
        erosion: 1.0,
        deposition: 1.0,
        evaporation: 0.0,
        talus: 0.0,
        creep: 0.0625,
        ..ordinary
    };
    let smallest = Hydraulic {
        rain: 0.0,
        capacity: 0.0,
        erosion: 0.0,
        deposition: 0.0,
        evaporation: 1.0,
        talus: 89.0,
        ..ordinary
    };
    [ordinary, largest, smallest, Hydraulic { rain: 0.9, capacity: 5.0, evaporation: 0.01, ..ordinary }]
}

async fn compare(
    cases: &mut Cases<'_>,
    (pass, shape): (&HydraulicPass, Shape),
    name: &str,
    case: &Case,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let Case { width, count, limit, params, terrain_scale } = *case;
    let host = random_heights(width, (width * width * count) as usize, limit);
    let inner = ((width - 2) * (width - 2) * count) as usize;
    let heights = [Poisoned::new(gpu, host.len())?, Poisoned::new(gpu, inner)?];
    let flows = [Poisoned::new(gpu, inner)?, Poisoned::new(gpu, inner)?];
    let [windows, other] = [0, 1].map(|i| Fields { heights: heights[i].buffer.clone(), width, count });
    windows.heights.write(gpu, &host)?;
    let buffers = HydraulicBuffers {
        windows: &windows,
        other: &other,
        flows: &flows[0].buffer,
        other_flows: &flows[1].buffer,
    };
    let job = pass.prepare(gpu, params, terrain_scale, buffers)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let (ground, flow) = expected(host, inner, case, shape.cycles);
    for (at, when) in [(0, "an even"), (1, "an odd")] {
        let comparison = heights[at].check(gpu, |actual| exact(actual, &ground[at])).await?;
        cases.add(format!("{name}, heights after {when} number of dispatches"), comparison);
        let words = flow[at].concat();
        let comparison = flows[at]
            .check(gpu, |actual: &[Flow]| exact(bytemuck::cast_slice(actual), words.as_slice()))
            .await?;
        cases.add(format!("{name}, flow after {when} number of dispatches"), comparison);
    }
    Ok(())
}

/// What dispatches of so many cycles leave in the first part of all buffers, over their previous contents.
fn expected(mut ground: Vec<i32>, inner: usize, case: &Case, cycles: u32) -> ([Vec<i32>; 2], [Vec<Flow>; 2]) {
    let poison = POISON as i32;
    let mut heights = [ground.clone(), vec![poison; inner]];
    let mut flows = [vec![[poison; 4]; inner], vec![[poison; 4]; inner]];
    let mut flow = vec![[poison; 4]; ground.len()];
    let mut width = case.width;
    for cycle in 0..case.params.iterations {
        let params = case.params.params(case.terrain_scale, cycle, width);
        let points = (width * width) as usize;
        let windows = ground.chunks_exact(points).zip(flow.chunks_exact(points));
        let made: Vec<_> = windows.map(|(ground, flow)| hydraulic(ground, flow, &params)).collect();
        (ground, flow) = (Vec::new(), Vec::new());
        for (window, flows) in made {
            ground.extend(window);
            flow.extend(flows);
        }
        width -= 2;
        if (cycle + 1) % cycles != 0 && cycle + 1 < case.params.iterations {
            continue;
        }
        let at = (cycle / cycles + 1) as usize % 2;
        heights[at][..ground.len()].copy_from_slice(&ground);
        flows[at][..flow.len()].copy_from_slice(&flow);
    }
    (heights, flows)
}

/// Measures ten cycles of a batch of 16 patches, and of one field of 1024² samples.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
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
