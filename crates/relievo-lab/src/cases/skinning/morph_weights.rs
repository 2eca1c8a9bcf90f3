//! Parity and benchmark cases of `kernels/skinning/morph_weights.wgsl`.

use relievo::asset::clip::BoneKeys;
use relievo::asset::morph::WeightKeys;
use relievo::asset::{Clip, Interpolation, Model};
use relievo::gpu::Buffer;
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::instance::{Instance, Wrap};
use relievo::ops::animation::keyframe_cursor::reference::inside_clip;
use relievo::ops::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph_weights::reference::{MorphedCrowd, morph_weights};
use relievo::ops::skinning::morph_weights::{MORPH_WEIGHTS_BOUND, MorphWeightsPass, WeightSet};
use relievo::ops::skinning::vertex::Blend;
use relievo::{Error, InputError};

use crate::cases::animation::Draw;
use crate::cases::measure;
use crate::cases::skinning::{SHAPES, Scene, Shape, random_model};
use crate::harness::compare::{Comparison, LeftOut};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases, compare};

/// The distance in seconds from a key, or from the clip's end, within which rounding may decide either way:
/// three roundings of times up to 16 s.
const TOUCH: f32 = 5e-6;

/// Times in seconds since the starts.
const ELAPSED: [f32; 3] = [0.0, 2.71, -1.3];

/// The cases cover steps, lines and splines of one to nine keys, and clips that animate no target; loops and
/// clamps, forwards and backwards, inside and outside the clip. Every fifth instance is not seen, and its
/// weights must stay unchanged. Steps at their very keys and loops at their very ends are left out, and
/// counted.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
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
            let instance_lods: Vec<_> = (0..count)
                .map(|at| if is_seen(at) { InstanceLod::FULL } else { InstanceLod::UNSEEN })
                .collect();
            crowd.instance_lods.write(gpu, &instance_lods)?;
            let output = Poisoned::<f32>::new(gpu, count * shape.targets)?;
            crowd.weights = output.buffer.clone();
            let playing = Buffer::from_slice(gpu, "instances", &instances)?;
            let job = pass.prepare(gpu, &weights, &playing, &crowd)?;
            for elapsed in ELAPSED {
                output.poison(gpu)?;
                job.set(gpu, elapsed)?;
                gpu.submit("verify", |encoder| job.record(encoder))?;
                let mut expected = vec![f32::from_bits(POISON); count * shape.targets];
                let crowd = MorphedCrowd {
                    mesh,
                    set: &set,
                    clips: &clips,
                    instances: &instances,
                    instance_lods: &instance_lods,
                    elapsed,
                };
                morph_weights(&crowd, &mut expected);
                let jumps: Vec<bool> = instances
                    .iter()
                    .enumerate()
                    .map(|(at, instance)| is_seen(at) && is_at_a_jump(instance, &weights, elapsed))
                    .collect();
                let name = format!("{} targets × {count} after {elapsed} s", shape.targets);
                cases.check(name, &output, |actual| compared(actual, &expected, &jumps)).await?;
            }
        }
    }
    Ok(())
}

/// Compares the weights of instances, except those at a jump, which are counted: one in 200 is allowed, so none
/// in small cases.
fn compared(actual: &[f32], expected: &[f32], jumps: &[bool]) -> Comparison {
    let targets = expected.len() / jumps.len();
    let kept = |weights: &[f32]| -> Vec<f32> {
        let instances = weights.chunks(targets).zip(jumps).filter(|(_, is_at_jump)| !**is_at_jump);
        instances.flat_map(|(weights, _)| weights.to_vec()).collect()
    };
    let count = jumps.iter().filter(|is_at_jump| **is_at_jump).count();
    let left_out = LeftOut { count, of: jumps.len(), most: jumps.len() / 200 };
    compare::absolute(&kept(actual), &kept(expected), MORPH_WEIGHTS_BOUND).leaving_out(left_out)
}

/// Whether rounding may put an instance on the other side of a jump: between the end of a loop and its start,
/// or at the key of a step. Lines and splines are continuous at their keys, and a clamped time stays at its
/// clip's end.
fn is_at_a_jump(instance: &Instance, weights: &WeightSet, elapsed: f32) -> bool {
    let entry = &weights.entries[instance.clip as usize];
    let asked = instance.start + instance.rate * elapsed;
    let time = inside_clip(instance.wrap(), entry.duration, asked);
    let is_near = |key: &f32| (time - key).abs() < TOUCH;
    let is_at_end = instance.wrap() == Wrap::Loop && (is_near(&0.0) || is_near(&entry.duration));
    let times = &weights.times[entry.first_time as usize..][..entry.keys as usize];
    entry.keys > 1 && (is_at_end || entry.interpolation == Interpolation::Step && times.iter().any(is_near))
}

/// A model with four clips, three of which animate the weights, each with another interpolation.
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

/// Targets of the mesh, and keys of the clip.
const TARGETS: usize = 4;
const KEYS: usize = 30;

/// Measures four targets with linear interpolation between 30 keys.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = MorphWeightsPass::new(gpu)?;
    let times: Vec<f32> = (0..KEYS).map(|key| key as f32 / 30.0).collect();
    let values = (0..KEYS * TARGETS).map(|at| (at % 7) as f32 / 7.0).collect();
    let keys = WeightKeys::new(["times", "values"], times, values, Interpolation::Linear, TARGETS)?;
    for count in [100, 10_000] {
        let mut scene = Scene::new(gpu, 1, TARGETS, 1)?;
        scene.crowd.weights = Buffer::new(gpu, "weights", count * TARGETS)?;
        let instance_lods = vec![InstanceLod::FULL; count];
        scene.crowd.instance_lods = Buffer::from_slice(gpu, "instance_lods", &instance_lods)?;
        scene.crowd.instances = count;
        scene.model.meshes[0].weight_keys = vec![(0, keys.clone())];
        let (mesh, skeleton) = (&scene.model.meshes[0], &scene.model.skeleton);
        let clip = Clip::new("still", skeleton, &vec![BoneKeys::default(); skeleton.len()], 1.0)?;
        let set = ClipSet::new(&[&clip])?;
        let instances: Vec<_> =
            (0..count).map(|at| Instance::new(0, Wrap::Loop, (at as f32 * 0.618).fract(), 1.0)).collect();
        let playing = Buffer::from_slice(gpu, "instances", &instances)?;
        let job = pass.prepare(gpu, &WeightSet::new(mesh, &set, &[0])?, &playing, &scene.crowd)?;
        job.set(gpu, 0.5)?;
        // The kernel reads an instance, an InstanceLod, four times and two values, and writes a weight.
        let (all, words) = (count * TARGETS, 4 + 2 + 4 + 2 + 1);
        let mut weights = vec![0.0; all];
        let name = format!("4 targets × {count}");
        measure(bench, name, all, "weight", words * all, &|encoder| job.record(encoder), || {
            let weights = std::hint::black_box(&mut weights);
            let (instances, instance_lods) = (&instances[..], &instance_lods[..]);
            let crowd = MorphedCrowd { mesh, set: &set, clips: &[0], instances, instance_lods, elapsed: 0.5 };
            morph_weights(&crowd, weights);
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::ops::skinning::morph_weights::WeightEntry;

    /// One of 400 instances of two targets is at a jump: its own weights are left out, and no others.
    #[test]
    fn one_at_a_jump_is_left_out_alone_and_few_may_be() {
        let expected = vec![0.5; 800];
        let with = |wrong: usize, at_jumps: usize| {
            let mut actual = expected.clone();
            actual[wrong] += 1.0;
            let jumps: Vec<bool> = (0..400).map(|instance| instance < at_jumps).collect();
            compared(&actual, &expected, &jumps)
        };
        assert!(with(1, 1).holds && !with(2, 1).holds && with(3, 2).holds);
        let three = with(0, 3);
        assert!(!three.holds && three.fault.expect("a fault").contains("3 of 400 are left out"));
    }

    /// Steps jump at their keys, and loops at their ends if they have two keys.
    #[test]
    fn lines_and_splines_jump_nowhere_but_at_the_ends_of_loops() {
        let entry = |first_time, keys, interpolation| WeightEntry {
            duration: 2.0,
            first_time,
            keys,
            first_value: 0,
            interpolation,
        };
        let weights = WeightSet {
            entries: vec![
                entry(0, 3, Interpolation::Step),
                entry(0, 3, Interpolation::Linear),
                entry(0, 3, Interpolation::CubicSpline),
                entry(0, 1, Interpolation::Step),
            ],
            times: vec![0.5, 1.0, 1.5],
            values: vec![],
            targets: 1,
        };
        let at = |wrap, time: f32| {
            [0, 1, 2, 3].map(|clip| is_at_a_jump(&Instance::new(clip, wrap, time, 1.0), &weights, 0.0))
        };
        for time in [1.0, 1.0 + 2e-6, 1.0 - 2e-6] {
            assert_eq!(
                [Wrap::Loop, Wrap::Clamp].map(|wrap| at(wrap, time)),
                [[true, false, false, false]; 2]
            );
        }
        for time in [0.0, 2.0, -2e-6, 4.0] {
            assert_eq!(at(Wrap::Loop, time), [true, true, true, false], "{time}");
            assert_eq!(at(Wrap::Clamp, time), [false; 4], "{time}");
        }
        assert_eq!([Wrap::Loop, Wrap::Clamp].map(|wrap| at(wrap, 1.2)), [[false; 4]; 2]);
    }
}
