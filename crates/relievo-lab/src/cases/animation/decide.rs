//! Parity and benchmark cases of `kernels/animation/decide.wgsl`, and of the separate kernels that it replaces.

use relievo::Error;
use relievo::animation::active::Active;
use relievo::animation::clip_clock::ClipClock;
use relievo::animation::clip_set::ClipSet;
use relievo::animation::compact::reference::{accumulated, compact, compact as lists};
use relievo::animation::crowd::{ClipBuffers, Crowd};
use relievo::animation::decide::reference::Decider;
use relievo::animation::decide::{DecidePass, Dispatches};
use relievo::animation::gate::{Frame, Gate};
use relievo::animation::gate_state::GateState;
use relievo::animation::instance::Instance;
use relievo::animation::layers::Layer;
use relievo::animation::lod::{Lod, OMEGA_ONE, Sampling};
use relievo::animation::order::Order;
use relievo::animation::updated_bones::UpdatedBones;
use relievo::gpu::GpuError;

use crate::cases::animation::gate::gates;
use crate::cases::animation::scene::{CROWDS, ELAPSED, Scene};
use crate::cases::animation::{Draw, SIZES, clip_clock, compact, random_clips, random_crowd};
use crate::cases::terrain::copy_of;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover every gate over sequences of frames, in one dispatch if the device permits it and in
/// several: levels of detail of every size, hidden and refreshed instances, layers above every third crowd.
/// Times are multiples of 1/64 s, so that devices agree on every key; a fraction may be off by 1. What follows
/// is compared, to the bit, with the references' results for the device's own clip clocks.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (case, [bones, count]) in SIZES.into_iter().chain([[5, 400]]).enumerate() {
        let case = case as u32;
        let (skeleton, set, instances) = random_crowd(case, bones, count)?;
        let clips = random_clips(case, &skeleton, 3)?;
        let order = Order::new(&skeleton);
        for gate in gates(&skeleton, &set, &clips.iter().collect::<Vec<_>>())? {
            for dispatches in [Dispatches::One, Dispatches::Each] {
                let name = format!("{bones} bones × {count}, {}, {dispatches:?}", gate.name());
                let pass = match DecidePass::with_dispatches(cases.gpu, &gate, dispatches) {
                    Err(error @ GpuError::Limit { .. }) => {
                        cases.skip(name, error.to_string());
                        continue;
                    }
                    pass => pass?,
                };
                let play = Play { case, name, order: &order, set: &set, gate: &gate, instances: &instances };
                play.add(cases, &pass).await?;
            }
        }
    }
    Ok(())
}

/// What the crowd plays.
struct Play<'a> {
    case: u32,
    name: String,
    order: &'a Order,
    set: &'a ClipSet,
    gate: &'a Gate,
    instances: &'a [Instance],
}

/// The buffers that the kernels write.
struct Outputs {
    clip_clocks: Poisoned<ClipClock>,
    bits: Poisoned<u32>,
    updated_bones: Poisoned<u32>,
    pairs: Poisoned<u32>,
    instances: Poisoned<u32>,
}

impl Play<'_> {
    async fn add(&self, cases: &mut Cases<'_>, pass: &DecidePass) -> Result<(), Error> {
        let (gpu, count) = (cases.gpu, self.instances.len());
        let mut draw = Draw::new(self.case ^ 0xdec1);
        let mut instances = self.instances.to_vec();
        let weights = (0..count).map(|_| (draw.word() % 3) as f32 / 2.0).collect();
        let layers: Vec<Layer> = match self.case % 3 {
            0 => vec![Layer::new(instances.clone(), weights)],
            _ => Vec::new(),
        };
        let crowd = Crowd::layered(gpu, self.set, &instances, &layers)?;
        let clips = ClipBuffers::new(gpu, self.set)?;
        let mut state = GateState::new(gpu, &crowd)?;
        let mut active = Active::new(gpu, self.order, &crowd)?;
        let outputs = self.poison(cases, &crowd, &mut state, &mut active)?;
        let mut updated_bones = vec![0x0101_8000; count * self.order.words()];
        outputs.updated_bones.buffer.write(gpu, &updated_bones)?;
        let mut decider = Decider::new(self.set, self.gate, count);
        let job = pass.prepare(gpu, &clips, &crowd, &state, &active)?;
        for (number, elapsed) in [0.0, 0.25, 0.5, 300.0].into_iter().enumerate() {
            let lods = random_lods(&mut draw, count, number == 0);
            state.write_lods(gpu, &lods)?;
            for instance in &mut instances {
                instance.start = (draw.word() % 4096) as f32 / 64.0 - 32.0;
                instance.rate = [1.0, -1.0, 0.5][draw.word() as usize % 3];
            }
            crowd.instances.write_at(gpu, 0, &instances)?;
            let ahead = [0.0, 0.25, -0.5, 0.125][number];
            let frame =
                Frame { ticks: 70_000 * number as u32, frame_ticks: 1092, frame: number as u32, ahead };
            job.set(gpu, &frame, elapsed)?;
            outputs.poison(gpu)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let expected = decider.clip_clocks(&instances, &layers, &lods, elapsed, self.gate.ahead(&frame));
            let name = |what| format!("{}, frame {number}: {what}", self.name);
            let same = |actual: &[ClipClock]| exact(&clip_clock::settled(actual, &expected), &expected);
            cases.add(name("clip_clocks"), outputs.clip_clocks.check(gpu, same).await?);
            let actual = state.clip_clocks.read(gpu).await?;
            let chosen = decider.bits(&frame, &lods, &actual[..count]);
            let work = lists(self.order, &chosen);
            let bits = [chosen.words(), work.updated_bones.clone()].concat();
            cases.add(name("bits"), outputs.bits.check(gpu, |actual| exact(actual, &bits)).await?);
            let pairs = compact::padded(&work.pairs, crowd.pairs());
            let listed = compact::padded(&work.instances, count);
            cases.add(name("pairs"), outputs.pairs.check(gpu, |actual| exact(actual, &pairs)).await?);
            cases
                .add(name("instances"), outputs.instances.check(gpu, |actual| exact(actual, &listed)).await?);
            // They are cleared after two frames.
            updated_bones = accumulated(&updated_bones, &work.updated_bones);
            cases.add(
                name("updated_bones"),
                outputs.updated_bones.check(gpu, |actual| exact(actual, &updated_bones)).await?,
            );
            if number == 1 {
                updated_bones.fill(0);
                outputs.updated_bones.buffer.write(gpu, &updated_bones)?;
            }
            cases
                .add(name("dispatches"), compact::dispatches(gpu, self.order, &crowd, &active, &work).await?);
        }
        let kept = exact(&state.history.read(gpu).await?, &decider.history);
        cases.add(format!("{}: history", self.name), kept);
        let kept = exact(&state.sampled.read(gpu).await?, &decider.sampled);
        cases.add(format!("{}: sums of motion", self.name), kept);
        Ok(())
    }

    fn poison(
        &self,
        cases: &Cases<'_>,
        crowd: &Crowd,
        state: &mut GateState,
        active: &mut Active,
    ) -> Result<Outputs, Error> {
        let (gpu, words) = (cases.gpu, active.updated_bones.bits().len());
        let outputs = Outputs {
            clip_clocks: Poisoned::new(gpu, crowd.len())?,
            bits: Poisoned::new(gpu, 3 * words)?,
            updated_bones: Poisoned::new(gpu, words)?,
            pairs: Poisoned::new(gpu, crowd.pairs())?,
            instances: Poisoned::new(gpu, crowd.len())?,
        };
        state.clip_clocks = outputs.clip_clocks.buffer.clone();
        active.bits = outputs.bits.buffer.clone();
        active.updated_bones = UpdatedBones::over(outputs.updated_bones.buffer.clone());
        active.pairs.pairs = outputs.pairs.buffer.clone();
        active.instances = outputs.instances.buffer.clone();
        Ok(outputs)
    }
}

impl Outputs {
    fn poison(&self, gpu: &relievo::gpu::Gpu) -> Result<(), GpuError> {
        self.clip_clocks.poison(gpu)?;
        [&self.bits, &self.pairs, &self.instances].iter().try_for_each(|output| output.poison(gpu))
    }
}

fn random_lods(draw: &mut Draw, count: usize, is_first: bool) -> Vec<Lod> {
    let lod = |_| Lod {
        omega: [0, draw.word() % OMEGA_ONE, OMEGA_ONE - 1, OMEGA_ONE][draw.word() as usize % 4],
        allowed: draw.word() >> (draw.word() % 32),
        sampling: match draw.word() % 8 {
            _ if is_first => Sampling::Gated,
            0 => Sampling::Hidden,
            1 => Sampling::Forced,
            _ => Sampling::Gated,
        },
        ..Lod::FULL
    };
    (0..count).map(lod).collect()
}

/// Measures frames in which nothing is skipped, and in which everything is.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    for (skipped, omega) in [("nothing", OMEGA_ONE), ("everything", 0)] {
        for count in CROWDS {
            case(bench, &format!("{count} × 153, {skipped} skipped"), omega, count)?;
        }
    }
    Ok(())
}

fn case(bench: &mut Bench<'_>, name: &str, omega: u32, count: usize) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, count)?;
    let (order, gate) = (scene.order(), scene.uniform()?);
    let state = GateState::new(gpu, &scene.crowd)?;
    let active = Active::new(gpu, &order, &scene.crowd)?;
    let lods = vec![Lod { omega, ..Lod::FULL }; count];
    state.write_lods(gpu, &lods)?;
    let pass = DecidePass::new(gpu, &gate, &scene.crowd)?;
    let job = pass.prepare(gpu, &scene.clips, &scene.crowd, &state, &active)?;
    let frame = Frame { ticks: 100_000, frame_ticks: 1092, frame: 91, ahead: 0.0 };
    job.set(gpu, &frame, ELAPSED)?;
    let mut decider = Decider::new(&scene.set, &gate, count);
    // In the first frame no pose is stored, so nothing can be skipped.
    gpu.submit("first", |encoder| job.record(encoder))?;
    let mut decide = || {
        let clip_clocks = decider.clip_clocks(&scene.instances, &[], &lods, ELAPSED, 0.0);
        compact(&order, &decider.bits(&frame, &lods, &clip_clocks))
    };
    decide();
    let chosen = decide().pairs.len();
    // For each instance the kernel reads 12 words and writes 6; it writes bits twice and reads them once, and
    // writes a pair and its slot.
    let words = (18 * count + 3 * active.updated_bones.bits().len() + 2 * chosen) / 2;
    let copied = copy_of(gpu, words)?;
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || drop(std::hint::black_box(decide()))),
    ];
    bench.case(name.to_owned(), (scene.pairs(), "bone"), 8 * words as u64, contenders)
}
