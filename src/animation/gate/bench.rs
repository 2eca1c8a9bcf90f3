//! Benchmark cases of `animation/gate`: decisions for crowds.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::bench::{CROWDS, Scene};
use crate::animation::clip_clock::{ClipClock, UpdateReason};
use crate::animation::gate::reference::gate;
use crate::animation::gate::{Frame, Gate, GatePass};
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::GateTable;
use crate::animation::lod::{Lod, OMEGA_ONE};
use crate::asset::keyframe::RotationPath;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures each gate at half detail, where it examines every bone.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    for mode in [Gate::Uniform, Gate::Random, Gate::SkipPeriod { period: 65536 }, Gate::Bounded] {
        for count in CROWDS {
            case(bench, mode, count)?;
        }
    }
    Ok(())
}

fn case(bench: &mut Bench<'_>, mode: Gate, count: usize) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, count)?;
    let table = scene.table(mode)?;
    let gate_state = GateState::new(gpu, &table, &scene.crowd)?;
    let active = Active::new(gpu, &scene.order(), &scene.crowd)?;
    let lods = vec![Lod { omega: OMEGA_ONE / 2, allowed: 1 << 16, ..Lod::FULL }; count];
    let rows = scene.set.rows(&scene.set.clips()[0]) - 1;
    let clip_clock = |instance: u32| ClipClock::new(instance % rows, instance % 65536, UpdateReason::Free, 0);
    let clip_clocks: Vec<ClipClock> = (0..count as u32).map(clip_clock).collect();
    gate_state.lods.write(gpu, &lods)?;
    gate_state.clip_clocks.write(gpu, &clip_clocks)?;
    let job = GatePass::new(gpu, mode)?.prepare(gpu, &scene.crowd, &gate_state, &active)?;
    let frame = Frame { ticks: 100_000, frame_ticks: 1092, frame: 91, ahead: 0.0 };
    job.set(gpu, &frame)?;
    // The kernel writes the bits, and for each bone reads half a word of priorities, or reads four words of
    // motion and writes one.
    let pairs = scene.pairs();
    let words = match mode {
        Gate::Bounded => 5 * pairs / 2,
        Gate::SkipPeriod { .. } => pairs / 4,
        _ => 4 * count,
    };
    let copied = copy_of(gpu, words.max(1))?;
    // Every bone has missed motion each time.
    let (before, mut sampled) = (Buffer::from_slice(gpu, "before", &vec![0_u32; pairs])?, vec![0; pairs]);
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| {
            if mode == Gate::Bounded {
                encoder.copy_buffer_to_buffer(before.raw(), 0, gate_state.sampled.raw(), 0, before.bytes());
            }
            job.record(encoder);
        }),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            sampled.fill(0);
            drop(std::hint::black_box(gate(&table, mode, &frame, &lods, &clip_clocks, &mut sampled)));
        }),
    ];
    bench.case(format!("{count} × 153, {}", mode.name()), (pairs, "bone"), 8 * words as u64, contenders)
}

impl Scene {
    /// The table of the scene's clip for a gate.
    pub(crate) fn table(&self, mode: Gate) -> Result<GateTable, Error> {
        let (order, clips) = (self.order(), [&self.clip]);
        Ok(match mode {
            Gate::SkipPeriod { .. } => {
                GateTable::of_priorities(&order, &self.set, &clips, &[self.priorities()?])?
            }
            Gate::Bounded => {
                let bone_radii = vec![0.1; self.skeleton.len()];
                GateTable::of_bounds(&self.skeleton, &self.set, &clips, &bone_radii, RotationPath::Slerp)?
            }
            _ => GateTable::of_animated_bones(&order, &self.set, &clips)?,
        })
    }
}
