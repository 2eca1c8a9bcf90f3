//! Parity of `kernels/skinning/morph_weights.wgsl`.

use crate::animation::clip_set::ClipSet;
use crate::animation::instance::Instance;
use crate::animation::instance::Wrap;
use crate::animation::place::reference::inside_clip;
use crate::animation::verify::Draw;
use crate::asset::clip::BoneKeys;
use crate::asset::morph::WeightKeys;
use crate::asset::{Clip, Interpolation, Model};
use crate::gpu::Buffer;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Cases, compare};
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use crate::skinning::morph_weights::reference::morph_weights;
use crate::skinning::morph_weights::{MORPH_WEIGHTS_BOUND, MorphWeightsPass, WeightSet};
use crate::skinning::reduction::Reduction;
use crate::skinning::verify::{SHAPES, Shape, random_model};
use crate::skinning::vertex::Blend;
use crate::{Error, InputError};

/// How near to a key, or to the clip's end, rounding may decide otherwise: times up to 16 s, three roundings.
const TOUCH: f32 = 5e-6;

/// Seconds since the starts.
const ELAPSED: [f32; 3] = [0.0, 2.71, -1.3];

/// Steps, lines and splines of one key to nine, and clips that move no target; loops and clamps, forwards and backwards,
/// inside and outside the clip. Every fifth instance is not seen: its weights stay. Steps at their very keys are left
/// out, and counted.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = MorphWeightsPass::new(gpu)?;
    for (case, shape) in (0..).zip(SHAPES).filter(|(_, shape)| shape.targets > 0) {
        let (model, set) = keyed_model(case, shape)?;
        let (mesh, clips) = (&model.meshes[0], [3, 0, 2, 1]);
        let weights = WeightSet::new(mesh, &set, &clips)?;
        let (buffers, _) = MeshBuffers::new(gpu, &model, mesh)?;
        for count in [1, 64, 65, 200] {
            let mut draw = Draw::new(case ^ 0x3e1);
            let play = |at: usize| {
                let wrap = if at.is_multiple_of(3) { Wrap::Clamp } else { Wrap::Loop };
                Instance::new(draw.word() % 4, wrap, 4.0 * draw.signed(), 2.0 * draw.signed())
            };
            let instances: Vec<Instance> = (0..count).map(play).collect();
            let mut crowd = SkinnedCrowd::new(gpu, &buffers, count, Blend::Linear)?;
            let is_seen = |at: usize| at % 5 != 4;
            let reductions: Vec<_> =
                (0..count).map(|at| if is_seen(at) { Reduction::FULL } else { Reduction::UNSEEN }).collect();
            crowd.reductions.write(gpu, &reductions)?;
            let output = Poisoned::<f32>::new(gpu, count * shape.targets)?;
            crowd.weights = output.buffer.clone();
            let playing = Buffer::from_slice(gpu, "instances", &instances)?;
            let job = pass.prepare(gpu, &weights, &playing, &crowd)?;
            for elapsed in ELAPSED {
                output.poison(gpu)?;
                job.set(gpu, elapsed)?;
                gpu.run("verify", |encoder| job.record(encoder))?;
                let mut expected = vec![f32::from_bits(POISON); count * shape.targets];
                morph_weights(mesh, (&set, &clips), &instances, &reductions, elapsed, &mut expected);
                let touches: Vec<bool> =
                    instances.iter().map(|instance| touches(instance, &weights, elapsed)).collect();
                let touching = touches.iter().filter(|touches| **touches).count();
                let comparison = output.check(gpu, |actual| {
                    let mut actual = actual.to_vec();
                    for (at, _) in touches.iter().enumerate().filter(|(_, touches)| **touches) {
                        let own = at * shape.targets..(at + 1) * shape.targets;
                        actual[own.clone()].copy_from_slice(&expected[own]);
                    }
                    compare::absolute(&actual, &expected, MORPH_WEIGHTS_BOUND)
                })?;
                let name = format!("{} targets × {count} after {elapsed} s", shape.targets);
                let few = touching * 50 <= count + 50;
                cases.add(name, if few { comparison } else { compare::exact(&[touching as u32], &[0]) });
            }
        }
    }
    Ok(())
}

/// Whether rounding may put an instance on the other side of a jump.
fn touches(instance: &Instance, weights: &WeightSet, elapsed: f32) -> bool {
    let entry = &weights.entries[instance.clip as usize];
    let asked = instance.start + instance.rate * elapsed;
    if instance.wrap() == Wrap::Clamp && !(-TOUCH..=entry.duration + TOUCH).contains(&asked) {
        return false;
    }
    let time = inside_clip(instance.wrap(), entry.duration, asked);
    let times = &weights.times[entry.first_time as usize..][..entry.keys as usize];
    times.iter().chain(&[0.0, entry.duration]).any(|key| (time - key).abs() < TOUCH)
}

/// A model with four clips, of which three move the targets, each in another way.
fn keyed_model(case: u32, shape: Shape) -> Result<(Model, ClipSet), InputError> {
    let mut draw = Draw::new(case ^ 0x1ce);
    let mut model = random_model(case, shape)?;
    for (clip, interpolation) in
        [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline].into_iter().enumerate()
    {
        let keys = [1, 2, 9][(case as usize + clip) % 3];
        let mut time = 0.0;
        let mut step = |_| {
            time += (1 + draw.word() % 8) as f32 / 8.0;
            time
        };
        let times: Vec<f32> = (0..keys).map(&mut step).collect();
        let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let values = (0..each * keys * shape.targets).map(|_| draw.signed()).collect();
        let keys = WeightKeys::new(["times", "values"], times, values, interpolation, shape.targets)?;
        model.meshes[0].weight_keys.push((clip, keys));
    }
    model.meshes[0].weights = (0..shape.targets).map(|_| draw.signed()).collect();
    // In the order of the set.
    let clips = [3.5, 4.0, 6.25, 2.0].map(|duration| {
        Clip::new("still", &model.skeleton, &vec![BoneKeys::default(); model.skeleton.len()], duration)
    });
    let [a, b, c, d] = clips;
    let set = ClipSet::new(&[&a?, &b?, &c?, &d?])?;
    Ok((model, set))
}
