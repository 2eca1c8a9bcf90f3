//! Parity and benchmark cases of `kernels/terrain/hydraulic.wgsl`.
//!
//! The benchmark measures a cycle, which reads and writes 20 bytes a sample; `copy` moves as many.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::terrain::config::{HeightInterpolation, TerrainConfig};
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::generate;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::hydraulic::reference::{Flow, hydraulic};
use relievo::ops::terrain::hydraulic::{Hydraulic, HydraulicBuffers, HydraulicPass};

use crate::cases::terrain::{LIMIT, check_exact, copy_of, random_heights, uploaded};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover sizes around workgroups, odd and even numbers of cycles, parameters at both bounds, and heights at the limit.
/// All four buffers are compared as a whole.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (width, count) in [(3, 2), (23, 3), (66, 3), (67, 2), (130, 2)] {
        for iterations in [1, 2, 5, 6, 10].into_iter().filter(|iterations| 2 * iterations < width) {
            for (kind, params) in kinds().into_iter().enumerate() {
                let (limit, terrain_scale) =
                    [(1 << 20, 1.0), (LIMIT, 1e6), (LIMIT, 1e-6), (1 << 24, 30.0)][kind];
                let ground = random_heights(width, (width * width * count) as usize, limit);
                let name = format!("{width}×{width} × {count}, {iterations} cycles, kind {kind}");
                compare(
                    cases,
                    &name,
                    Hydraulic { iterations, ..params },
                    terrain_scale,
                    [width, count],
                    ground,
                )
                .await?;
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
    name: &str,
    params: Hydraulic,
    terrain_scale: f64,
    [width, count]: [u32; 2],
    ground: Vec<i32>,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let inner = ((width - 2) * (width - 2) * count) as usize;
    let heights = [Poisoned::new(gpu, ground.len())?, Poisoned::new(gpu, inner)?];
    let flows = [Poisoned::new(gpu, inner)?, Poisoned::new(gpu, inner)?];
    let [windows, other] = [0, 1].map(|i| Fields { heights: heights[i].buffer.clone(), width, count });
    windows.heights.write(gpu, &ground)?;
    let [flows_buffer, other_flows] = [&flows[0].buffer, &flows[1].buffer];
    let buffers = HydraulicBuffers { windows: &windows, other: &other, flows: flows_buffer, other_flows };
    let job = HydraulicPass::new(gpu)?.prepare(gpu, params, terrain_scale, buffers)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    // What the cycles leave in the first part of all buffers, over their previous contents.
    let poison = POISON as i32;
    let mut expected = [ground.clone(), vec![poison; inner]];
    let mut expected_flows = [vec![[poison; 4]; inner], vec![[poison; 4]; inner]];
    let mut state = (ground, Vec::new());
    for cycle in 0..params.iterations {
        state = cycled(&state, &params, terrain_scale, cycle, width - 2 * cycle);
        let at = (cycle as usize + 1) % 2;
        expected[at][..state.0.len()].copy_from_slice(&state.0);
        expected_flows[at][..state.1.len()].copy_from_slice(&state.1);
    }
    for (at, when) in ["an even", "an odd"].into_iter().enumerate() {
        let name = format!("{name}, after {when} number of cycles");
        check_exact(cases, format!("{name}: heights"), &heights[at], &expected[at]).await?;
        check_exact(cases, format!("{name}: flow"), &flows[at], &expected_flows[at]).await?;
    }
    Ok(())
}

/// Ground and flow of windows of `width`² samples.
type State = (Vec<i32>, Vec<Flow>);

/// The state after one more cycle. Before the first there is no flow.
fn cycled((ground, flow): &State, params: &Hydraulic, terrain_scale: f64, cycle: u32, width: u32) -> State {
    let params = params.params(terrain_scale, cycle, width);
    let points = (width * width) as usize;
    let mut made = State::default();
    for (window, ground) in ground.chunks_exact(points).enumerate() {
        let flow = flow.get(window * points..(window + 1) * points).unwrap_or_default();
        let (ground, flow) = hydraulic(ground, flow, &params);
        made.0.extend(ground);
        made.1.extend(flow);
    }
    made
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
    let config = TerrainConfig {
        interpolation: HeightInterpolation::Smooth,
        ..TerrainConfig::new(size, 40.0, "bench")?
    };
    let patches: Vec<_> = (0..count as i32).map(|column| [column, 0]).collect();
    let host = generate(&config, &Features::default(), &patches, iterations).concat();
    let width = size + 2 * iterations;
    let windows = uploaded(gpu, width, &host)?;
    let other = Fields::new(gpu, "other", width - 2, count)?;
    let points = HydraulicPass::flow_points(&windows);
    let [flows, other_flows] = [Buffer::new(gpu, "flows", points)?, Buffer::new(gpu, "other flows", points)?];
    let params = Hydraulic { iterations, ..Hydraulic::default() };
    let buffers =
        HydraulicBuffers { windows: &windows, other: &other, flows: &flows, other_flows: &other_flows };
    let job = HydraulicPass::new(gpu)?.prepare(gpu, params, 1.0, buffers)?;
    let points = (1..=iterations).map(|cycle| windows.points(cycle)).sum::<usize>();
    let copied = copy_of(gpu, 5 * points / iterations as usize)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::recorded(Backend::Copy, |encoder| (0..iterations).for_each(|_| copied.record(encoder))),
        Contender::host(Backend::Reference, || {
            let next = |state, cycle| cycled(&state, &params, 1.0, cycle, width - 2 * cycle);
            drop(std::hint::black_box((0..iterations).fold((host.clone(), Vec::new()), next)));
        }),
    ];
    bench.case(name, points, "point", 40 * points as u64, contenders)
}
