//! Benchmark cases of `animation/gate`: decisions for crowds.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::bench::{CROWDS, Scene};
use crate::animation::clip_clock::{ClipClock, UpdateReason};
use crate::animation::gate::reference::gate;
use crate::animation::gate::{Frame, Gate, GatePass};
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::{AnimatedBones, BoundTable, PriorityTable};
use crate::animation::lod::{Lod, OMEGA_ONE};
use crate::asset::keyframe::RotationPath;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures each gate at half detail, where it examines every bone.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let makers = [Scene::uniform, Scene::random, Scene::skip_period, Scene::bounded];
    for maker in makers {
        for count in CROWDS {
            let scene = Scene::new(bench.gpu, count)?;
            case(bench, &scene, &maker(&scene)?)?;
        }
    }
    Ok(())
}

fn case(bench: &mut Bench<'_>, scene: &Scene, mode: &Gate) -> Result<(), Error> {
    let (gpu, count) = (bench.gpu, scene.instances.len());
    let state = GateState::new(gpu, &scene.crowd)?;
    let active = Active::new(gpu, &scene.order(), &scene.crowd)?;
    let lods = vec![Lod { omega: OMEGA_ONE / 2, allowed: 1 << 16, ..Lod::FULL }; count];
    let rows = scene.set.rows(&scene.set.clips()[0]) - 1;
    let clip_clock = |instance: u32| ClipClock::new(instance % rows, instance % 65536, UpdateReason::Free, 0);
    let clip_clocks: Vec<ClipClock> = (0..count as u32).map(clip_clock).collect();
    state.write_lods(gpu, &lods)?;
    state.clip_clocks.write(gpu, &clip_clocks)?;
    let job = GatePass::new(gpu, mode)?.prepare(gpu, &scene.crowd, &state, &active)?;
    let frame = Frame { ticks: 100_000, frame_ticks: 1092, frame: 91, ahead: 0.0 };
    job.set(gpu, &frame)?;
    // The kernel writes the bits, and for each bone reads half a word of priorities, or reads four words of
    // motion and writes one.
    let pairs = scene.pairs();
    let words = match mode {
        Gate::Bounded(_) => 5 * pairs / 2,
        Gate::SkipPeriod { .. } => pairs / 4,
        _ => 4 * count,
    };
    let copied = copy_of(gpu, words.max(1))?;
    // At each time every bone has missed some motion.
    let (before, mut sampled) = (Buffer::from_slice(gpu, "before", &vec![0_u32; pairs])?, vec![0; pairs]);
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| {
            if matches!(mode, Gate::Bounded(_)) {
                encoder.copy_buffer_to_buffer(before.raw(), 0, state.sampled.raw(), 0, before.bytes());
            }
            job.record(encoder);
        }),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            sampled.fill(0);
            drop(std::hint::black_box(gate(mode, &frame, &lods, &clip_clocks, &mut sampled)));
        }),
    ];
    bench.case(format!("{count} × 153, {}", mode.name()), (pairs, "bone"), 8 * words as u64, contenders)
}

impl Scene {
    fn animated_bones(&self) -> Result<AnimatedBones, Error> {
        Ok(AnimatedBones::new(&self.order(), &self.set, &[&self.clip])?)
    }

    /// The uniform gate, which samples all bones of an instance together.
    pub(crate) fn uniform(&self) -> Result<Gate, Error> {
        Ok(Gate::Uniform(self.animated_bones()?))
    }

    fn random(&self) -> Result<Gate, Error> {
        Ok(Gate::Random(self.animated_bones()?))
    }

    fn skip_period(&self) -> Result<Gate, Error> {
        let priorities = [self.priorities()?];
        let table = PriorityTable::new(&self.order(), &self.set, &[&self.clip], &priorities)?;
        Ok(Gate::SkipPeriod { table, period: 65536 })
    }

    fn bounded(&self) -> Result<Gate, Error> {
        let (clips, bone_radii) = ([&self.clip], vec![0.1; self.skeleton.len()]);
        let path = RotationPath::Slerp;
        Ok(Gate::Bounded(BoundTable::new(&self.skeleton, &self.set, &clips, &bone_radii, path)?))
    }
}
