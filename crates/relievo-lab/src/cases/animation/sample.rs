//! Parity and benchmark cases of `kernels/animation/sample.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::asset::keyframe::{KeyframeCursor, RotationPath};
use relievo::asset::transform::Transform;
use relievo::gpu::Gpu;
use relievo::ops::animation::active::{ActivePairs, PAIR_AHEAD};
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd, Local, packed};
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::keyframe_cursor::reference::cursors;
use relievo::ops::animation::layers::{AnimationLayer, MAX_LAYERS, all_instances};
use relievo::ops::animation::sample::reference::{blend, sample_layers, sample_set, sample_set_into};
use relievo::ops::animation::sample::{LAYER_GROWTH, SAMPLE_BOUND, SamplePass};

use crate::baseline::gather::Reads;
use crate::cases::animation::edges::{ELAPSED, edges};
use crate::cases::animation::plain_soa::PlainSoa;
use crate::cases::animation::scene::{CROWDS, KEYS, Scene};
use crate::cases::animation::{Draw, SIZES, random_crowd, random_instances};
use crate::cases::baseline::gather::evenly_keyed;
use crate::cases::measure;
use crate::harness::compare::LeftOut;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender, compare};

/// The cases cover every interpolation, at the reference's cursors: every pair, and lists of some pairs, of
/// none and of all; crowds of one layer and of several. Pairs that are not listed must stay unchanged.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (_, set, instances) = random_crowd(case as u32, bones, count)?;
        for path in [RotationPath::Slerp, RotationPath::Nlerp] {
            add(cases, format!("{bones} bones × {count}, {path:?}"), &set, &instances, &[], path).await?;
        }
    }
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (_, set, instances) = random_crowd(case as u32, bones, count)?;
        let above = [1, 2, MAX_LAYERS - 1][case % 3];
        let layers = random_layers(case as u32, &set, count, above);
        let path = [RotationPath::Slerp, RotationPath::Nlerp][case % 2];
        let name = format!("{bones} bones × {count}, {} layers", 1 + above);
        add(cases, name, &set, &instances, &layers, path).await?;
    }
    // Sets without splines have kernels of their own.
    let set = evenly_keyed(&mut Draw::new(1), 153, 60)?;
    let instances = random_instances(0, &set, 40);
    for path in [RotationPath::Slerp, RotationPath::Nlerp] {
        add(cases, format!("153 bones × 40 without splines, {path:?}"), &set, &instances, &[], path).await?;
    }
    at_edges(cases).await
}

/// Compares poses that are known without a reference, and the same under a layer with equal poses whose
/// rotation keys are negated.
async fn at_edges(cases: &mut Cases<'_>) -> Result<(), Error> {
    let edges = edges()?;
    let poses: Vec<Local> = edges.poses().iter().map(packed).collect();
    let negated = edges.instances.iter().map(|instance| Instance { clip: instance.clip + 2, ..*instance });
    let layer = AnimationLayer::new(negated.collect(), vec![0.5; edges.instances.len()]);
    for (name, layers) in [("edges", vec![]), ("edges under their negatives", vec![layer])] {
        let mut bench = Case::new(cases.gpu, &edges.set, &edges.instances, &layers, RotationPath::Slerp)?;
        bench.expected.clone_from(&poses);
        cases.add(name, bench.all().await?);
    }
    Ok(())
}

/// Adds cases for all pairs, and for lists.
async fn add(
    cases: &mut Cases<'_>,
    name: String,
    set: &ClipSet,
    base: &[Instance],
    layers: &[AnimationLayer],
    path: RotationPath,
) -> Result<(), Error> {
    let bench = Case::new(cases.gpu, set, base, layers, path)?;
    cases.add(format!("{name}, all"), bench.all().await?);
    let pairs = bench.expected.len() as u32;
    for (list, every) in [("none", u32::MAX), ("every third", 3), ("backwards", 1)] {
        let chosen: Vec<u32> = (0..pairs).rev().filter(|pair| (pair + 1) % every == 0).collect();
        cases.add(format!("{name}, {list}"), bench.some(&chosen).await?);
    }
    Ok(())
}

/// Random layers with weights and masks of 0, of 1 and in between; every second layer has no mask.
fn random_layers(case: u32, set: &ClipSet, count: usize, above: usize) -> Vec<AnimationLayer> {
    let mut draw = Draw::new(case ^ 0x1a7e);
    let mut weight = || match draw.word() % 4 {
        0 => 0.0,
        1 => 1.0,
        _ => draw.signed().abs(),
    };
    let layer = |at: usize| {
        let instances = random_instances(case ^ (at as u32 + 1) << 8, set, count);
        let layer = AnimationLayer::new(instances, (0..count).map(|_| weight()).collect());
        if at.is_multiple_of(2) { layer } else { layer.masked((0..set.bones()).map(|_| weight()).collect()) }
    };
    (0..above).map(layer).collect()
}

/// Bones that a layer rotates by half a turn within `margin`, where rounding decides which of q and −q is
/// nearer.
fn torn(
    set: &ClipSet,
    base: &[Instance],
    layers: &[AnimationLayer],
    cursors: &[KeyframeCursor],
    path: RotationPath,
    margin: f32,
) -> Vec<bool> {
    let all = sample_set(set, &all_instances(base, layers), cursors, path);
    let mut torn = vec![false; base.len() * set.bones()];
    let (below, above) = all.split_at(torn.len());
    for (pair, torn) in torn.iter_mut().enumerate() {
        let mut pose = below[pair];
        for (layer, over) in layers.iter().zip(above.chunks(below.len())) {
            let weight = layer.weight(pair / set.bones(), pair % set.bones());
            if weight > 0.0 {
                let cosine: f32 = pose.rotation.iter().zip(over[pair].rotation).map(|(a, b)| a * b).sum();
                *torn |= cosine.abs() < margin;
                pose = blend(&pose, &over[pair], weight);
            }
        }
    }
    torn
}

/// Compares poses, except those that are left out, which are counted: one in 100 is allowed.
fn compared(actual: &[Local], expected: &[Local], is_left_out: &[bool], bound: f32) -> compare::Comparison {
    let flat = |locals: &[Local]| {
        let kept = locals.iter().zip(is_left_out).filter(|(_, is_left_out)| !**is_left_out);
        kept.flat_map(|(local, _)| local.as_flattened().to_vec()).collect::<Vec<f32>>()
    };
    let (count, of) = (is_left_out.iter().filter(|is_left_out| **is_left_out).count(), is_left_out.len());
    let left_out = LeftOut { count, of, most: of / 100 };
    compare::absolute(&flat(actual), &flat(expected), bound).leaving_out(left_out)
}

struct Case<'a> {
    gpu: &'a Gpu,
    pass: SamplePass,
    clips: ClipBuffers,
    crowd: Crowd,
    output: Poisoned<Local>,
    expected: Vec<Local>,
    /// The expected poses of the base layer ahead.
    ahead: Vec<Local>,
    torn: Vec<bool>,
    bound: f32,
}

impl<'a> Case<'a> {
    fn new(
        gpu: &'a Gpu,
        set: &ClipSet,
        base: &[Instance],
        layers: &[AnimationLayer],
        path: RotationPath,
    ) -> Result<Self, Error> {
        let cursors: Vec<KeyframeCursor> = cursors(set, &all_instances(base, layers), ELAPSED);
        let mut crowd = Crowd::layered(gpu, set, base, layers)?.with_path(path);
        // Layers are not sampled ahead.
        let later = self::cursors(set, base, ELAPSED + 0.3);
        let mut cursors_ahead = cursors.clone();
        cursors_ahead[..later.len()].copy_from_slice(&later);
        crowd.cursors.write(gpu, &[cursors.as_slice(), &later].concat())?;
        let output = Poisoned::new(gpu, crowd.pairs())?;
        crowd.locals = output.buffer.clone();
        let is_layered = !layers.is_empty();
        let pass = if is_layered { SamplePass::layered(gpu, path)? } else { SamplePass::new(gpu, path)? };
        let bound = SAMPLE_BOUND * LAYER_GROWTH.powi(layers.len() as i32);
        let poses = |cursors: &[KeyframeCursor]| {
            sample_layers(set, base, layers, cursors, path).iter().map(packed).collect::<Vec<_>>()
        };
        let (clips, expected, ahead) = (ClipBuffers::new(gpu, set)?, poses(&cursors), poses(&cursors_ahead));
        // Each of the two quaternions is off by at most the bound.
        let [now, later] =
            [&cursors, &cursors_ahead].map(|cursors| torn(set, base, layers, cursors, path, 4.0 * bound));
        let torn = now.iter().zip(later).map(|(now, later)| *now || later).collect();
        Ok(Self { gpu, pass, clips, crowd, output, expected, ahead, torn, bound })
    }

    async fn all(&self) -> Result<compare::Comparison, Error> {
        self.output.poison(self.gpu)?;
        let job = self.pass.prepare(self.gpu, &self.clips, &self.crowd)?;
        self.gpu.submit("verify", |encoder| job.record(encoder))?;
        self.compare(|pair| Some(&self.expected[pair])).await
    }

    async fn some(&self, chosen: &[u32]) -> Result<compare::Comparison, Error> {
        self.output.poison(self.gpu)?;
        let active = ActivePairs::new(self.gpu, &self.crowd)?;
        let is_ahead = |pair: usize| pair % 7 % 2 == 1;
        let flagged = |pair: &u32| if is_ahead(*pair as usize) { pair | PAIR_AHEAD } else { *pair };
        active.write(self.gpu, &chosen.iter().map(flagged).collect::<Vec<_>>())?;
        let job = self.pass.prepare_active(self.gpu, &self.clips, &self.crowd, &active)?;
        self.gpu.submit("verify", |encoder| job.record(encoder))?;
        let mut is_chosen = vec![false; self.expected.len()];
        chosen.iter().for_each(|pair| is_chosen[*pair as usize] = true);
        let of = |pair: usize| if is_ahead(pair) { &self.ahead[pair] } else { &self.expected[pair] };
        self.compare(|pair| is_chosen[pair].then(|| of(pair))).await
    }

    async fn compare<'b>(
        &'b self,
        written: impl Fn(usize) -> Option<&'b Local>,
    ) -> Result<compare::Comparison, Error> {
        let poison = [[f32::from_bits(POISON); 4]; 3];
        let expected: Vec<Local> =
            (0..self.expected.len()).map(|pair| written(pair).copied().unwrap_or(poison)).collect();
        let largest =
            self.expected.as_flattened().as_flattened().iter().fold(1.0, |a: f32, b| a.max(b.abs()));
        // A pair that is not listed stays unchanged, whether it is left out or not.
        let is_left_out: Vec<bool> =
            self.torn.iter().enumerate().map(|(pair, torn)| *torn && written(pair).is_some()).collect();
        let near = |actual: &[Local]| compared(actual, &expected, &is_left_out, self.bound * largest);
        Ok(self.output.check(self.gpu, near).await?)
    }
}

/// Measures all bones, a list of every fourth, and two blended clips. `copy` reads and writes the same words;
/// `limit` reads the same keys without looking tracks up.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SamplePass::new(gpu, RotationPath::Slerp)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let pairs = scene.pairs();
        let job = pass.prepare(gpu, &scene.clips, &scene.crowd)?;
        let copied = scene.gathered(gpu, Reads::Everything)?;
        let keys = scene.gathered(gpu, Reads::Keys(KEYS as u32))?;
        let plain = PlainSoa::new(&scene.skeleton, &scene.set)?;
        let mut soa = vec![plain.locals(); count];
        let mut locals = vec![Transform::IDENTITY; pairs];
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::job(Backend::Limit, &keys),
            Contender::host(Backend::Reference, || reference(&scene, &scene.cursors, black_box(&mut locals))),
            Contender::host(Backend::PlainSoa, || {
                for (cursor, soa) in scene.cursors.iter().zip(black_box(&mut soa)) {
                    plain.sample(*cursor, soa);
                }
            }),
        ];
        bench.case(format!("{count} × 153, 60 keys"), pairs, "bone", 128 * pairs as u64, contenders)?;
    }
    quarter(bench, &pass)?;
    blended(bench)
}

fn reference(scene: &Scene, cursors: &[KeyframeCursor], locals: &mut [Transform]) {
    sample_set_into(&scene.set, &scene.instances[..cursors.len()], cursors, RotationPath::Slerp, locals);
}

fn quarter(bench: &mut Bench<'_>, pass: &SamplePass) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, CROWDS[1])?;
    let active = ActivePairs::new(gpu, &scene.crowd)?;
    let chosen: Vec<u32> = (0..scene.pairs() as u32).step_by(4).collect();
    active.write(gpu, &chosen)?;
    let job = pass.prepare_active(gpu, &scene.clips, &scene.crowd, &active)?;
    let cursors = &scene.cursors[..scene.cursors.len() / 4];
    let mut locals = vec![Transform::IDENTITY; cursors.len() * scene.set.bones()];
    measure(
        bench,
        "a quarter of 1000 × 153",
        chosen.len(),
        "bone",
        32 * chosen.len(),
        &|encoder| job.record(encoder),
        || reference(&scene, cursors, black_box(&mut locals)),
    )
}

/// Two layers on all bones; the upper one is 0.3 s later and has half the weight.
fn blended(bench: &mut Bench<'_>) -> Result<(), Error> {
    let (gpu, count) = (bench.gpu, CROWDS[1]);
    let scene = Scene::new(gpu, count)?;
    let later = |instance: &Instance| Instance { start: instance.start + 0.3, ..*instance };
    let layers = [AnimationLayer::new(scene.instances.iter().map(later).collect(), vec![0.5; count])];
    let found = cursors(&scene.set, &all_instances(&scene.instances, &layers), 0.4);
    let crowd = Crowd::layered(gpu, &scene.set, &scene.instances, &layers)?;
    crowd.cursors.write(gpu, &found)?;
    let pairs = crowd.pairs();
    let job = SamplePass::layered(gpu, RotationPath::Slerp)?.prepare(gpu, &scene.clips, &crowd)?;
    // The kernel reads four keys of 10 words and writes 10 words.
    measure(
        bench,
        "two clips blended, 1000 × 153",
        pairs,
        "bone",
        50 * pairs,
        &|encoder| job.record(encoder),
        || sample_layers(&scene.set, &scene.instances, &layers, &found, RotationPath::Slerp),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One of 100 bones is half a turn away: it is left out, and no other.
    #[test]
    fn bones_half_a_turn_apart_are_left_out_alone_and_few_may_be() {
        let expected = vec![[[0.5; 4]; 3]; 100];
        let with = |wrong: usize, torn: usize| {
            let mut actual = expected.clone();
            actual[wrong][1][2] = -0.5;
            let is_left_out: Vec<bool> = (0..100).map(|pair| pair < torn).collect();
            compared(&actual, &expected, &is_left_out, 1e-5)
        };
        assert!(with(0, 1).holds && !with(1, 1).holds);
        let two = with(0, 2);
        assert!(!two.holds && two.fault.expect("a fault").contains("2 of 100 are left out"));
    }
}
