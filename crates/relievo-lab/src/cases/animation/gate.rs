//! Parity and benchmark cases of `kernels/animation/gate.wgsl`.

use relievo::Error;
use relievo::asset::clip::Clip;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::skeleton::Skeleton;
use relievo::gpu::Buffer;
use relievo::ops::animation::active::Active;
use relievo::ops::animation::clip_clock::{ClipClock, UpdateReason};
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::crowd::Crowd;
use relievo::ops::animation::gate::reference::gate;
use relievo::ops::animation::gate::{Frame, Gate, GatePass};
use relievo::ops::animation::gate_state::GateState;
use relievo::ops::animation::gate_table::{AnimatedBones, BoundTable, PriorityTable};
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::lod::{Lod, OMEGA_ONE};
use relievo::ops::animation::order::Order;
use relievo::ops::animation::priority::{Priorities, USER_DEFAULT, Weights};

use crate::cases::animation::scene::{CROWDS, Scene};
use crate::cases::animation::{Draw, SIZES, random_clips, tiered_crowd};
use crate::cases::measure;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// The cases cover every gate over sequences of frames, with integers of every size: Ω from 0 to 1, clip clocks
/// at both ends of rows, ticks before and after they wrap, and all update reasons. The integer results must be
/// equal to the bit.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let case = case as u32;
        let (skeleton, set, instances) = tiered_crowd(case, bones, count)?;
        let clips = random_clips(case, &skeleton, 3)?;
        let crowd = Crowd::new(cases.gpu, &set, &instances)?;
        let order = Order::new(&skeleton);
        for mut gate in gates(&skeleton, &set, &clips.iter().collect::<Vec<_>>())? {
            if case % 3 == 1 {
                gate.never_skip(&order, &(0..bones).map(|bone| bone % 4 == 1).collect::<Vec<_>>())?;
            }
            add(cases, case, &gate, &order, &set, &crowd).await?;
        }
    }
    Ok(())
}

/// Every gate but a budget, of clips.
pub(crate) fn gates(skeleton: &Skeleton, set: &ClipSet, clips: &[&Clip]) -> Result<[Gate; 5], Error> {
    let order = Order::new(skeleton);
    let weights = Weights::default();
    let user = vec![USER_DEFAULT; skeleton.len()];
    let of = |clip: &&Clip| Priorities::new(skeleton, clip, Wrap::Loop, &weights, &user);
    let priorities = clips.iter().map(of).collect::<Result<Vec<_>, _>>()?;
    let bones = AnimatedBones::new(&order, set, clips)?;
    let bone_radii = vec![0.5; skeleton.len()];
    Ok([
        Gate::Off(bones.clone()),
        Gate::SkipPeriod { table: PriorityTable::new(&order, set, clips, &priorities)?, period: 65536 },
        Gate::Uniform(bones.clone()),
        Gate::Random(bones),
        Gate::Bounded(BoundTable::new(skeleton, set, clips, &bone_radii, RotationPath::Slerp)?),
    ])
}

async fn add(
    cases: &mut Cases<'_>,
    case: u32,
    mode: &Gate,
    order: &Order,
    set: &ClipSet,
    crowd: &Crowd,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let count = crowd.len();
    let mut state = GateState::new(gpu, crowd)?;
    let mut active = Active::new(gpu, order, crowd)?;
    let output = Poisoned::<u32>::new(gpu, 2 * count * order.words())?;
    active.bits = output.buffer.clone();
    let sums = Poisoned::<u32>::new(gpu, crowd.pairs())?;
    state.sampled = sums.buffer.clone();
    let pass = GatePass::new(gpu, mode)?;
    let job = pass.prepare(gpu, crowd, &state, &active)?;
    let mut draw = Draw::new(case ^ 0x9a7e);
    let mut sampled = vec![0; crowd.pairs()];
    sums.buffer.write(gpu, &sampled)?;
    for (number, ticks) in [0, 70_000, u32::MAX - 1000, 800].into_iter().enumerate() {
        let (lods, clip_clocks) = random_state(&mut draw, set, order, count, number == 0);
        state.write_lods(gpu, &lods)?;
        state.clip_clocks.write(gpu, &clip_clocks)?;
        let frame = Frame {
            ticks,
            frame_ticks: 1092,
            frame: u32::MAX - 1 + number as u32 * u32::from(number < 2),
            ahead: 0.0,
        };
        job.set(gpu, &frame)?;
        output.poison(gpu)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let expected = gate(mode, &frame, &lods, &clip_clocks, &mut sampled).words();
        let name = format!("{} bones × {count}, {}, frame {number}", crowd.bones, mode.name());
        cases.exact(name, &output, &expected).await?;
    }
    let name = format!("{} bones × {count}, {}, sums of motion", crowd.bones, mode.name());
    cases.exact(name, &sums, &sampled).await?;
    Ok(())
}

/// Random levels of detail and clip clocks of a frame, for a crowd with these clips and this order of bones. In the first frame all
/// are forced.
pub(crate) fn random_state(
    draw: &mut Draw,
    set: &ClipSet,
    order: &Order,
    count: usize,
    is_first: bool,
) -> (Vec<Lod>, Vec<ClipClock>) {
    let lod = |draw: &mut Draw| Lod {
        omega: [0, draw.word() % OMEGA_ONE, OMEGA_ONE - 1, OMEGA_ONE][draw.word() as usize % 4],
        allowed: draw.word() >> (draw.word() % 32),
        tier: order.tiers[draw.word() as usize % order.tiers.len()],
        ..Lod::FULL
    };
    let clip_clock = |draw: &mut Draw| {
        let clip = draw.word() % set.clips().len() as u32;
        let entry = &set.clips()[clip as usize];
        let row = entry.first_row + draw.word() % (set.rows(entry) - 1);
        let fraction = [0, draw.word() % 65536, 65535, 65536][draw.word() as usize % 4];
        let reason = match draw.word() % 8 {
            _ if is_first => UpdateReason::Forced,
            0 => UpdateReason::Hidden,
            1 => UpdateReason::Forced,
            2 => UpdateReason::Blended,
            _ => UpdateReason::Free,
        };
        let clip_clock = ClipClock::new(row, fraction, reason, clip);
        let ahead_row = entry.first_row + draw.word() % (set.rows(entry) - 1);
        match draw.word() % 3 {
            0 => clip_clock,
            // Slightly ahead, or anywhere.
            1 => ClipClock { ahead_fraction: (fraction + draw.word() % 64).min(65536), ..clip_clock },
            _ => ClipClock { ahead_row, ahead_fraction: draw.word() % 65537, ..clip_clock },
        }
    };
    (0..count).map(|_| (lod(draw), clip_clock(draw))).unzip()
}

/// Measures each gate at half detail, where it examines every bone.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    for count in CROWDS {
        let scene = Scene::new(bench.gpu, count)?;
        for mode in &gates(&scene.skeleton, &scene.set, &[&scene.clip])?[1..] {
            case(bench, &scene, mode)?;
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
    // At each time every bone has missed some motion.
    let (before, mut sampled) = (Buffer::from_slice(gpu, "before", &vec![0_u32; pairs])?, vec![0; pairs]);
    let name = format!("{count} × 153, {}", mode.name());
    let record = |encoder: &mut wgpu::CommandEncoder| {
        if matches!(mode, Gate::Bounded(_)) {
            encoder.copy_buffer_to_buffer(before.raw(), 0, state.sampled.raw(), 0, before.bytes());
        }
        job.record(encoder);
    };
    measure(bench, name, pairs, "bone", 2 * words.max(1), &record, || {
        sampled.fill(0);
        gate(mode, &frame, &lods, &clip_clocks, &mut sampled)
    })
}
