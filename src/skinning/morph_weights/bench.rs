//! Benchmark cases of `skinning/morph_weights`: weights of morph targets of crowds.

use crate::Error;
use crate::animation::clip_set::ClipSet;
use crate::animation::instance::Instance;
use crate::animation::instance::Wrap;
use crate::asset::clip::BoneKeys;
use crate::asset::morph::WeightKeys;
use crate::asset::{Clip, Interpolation};
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::skinning::bench::Scene;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::morph_weights::reference::morph_weights;
use crate::skinning::morph_weights::{MorphWeightsPass, WeightSet};
use crate::terrain::bench::copy_of;

/// Targets of the mesh, and keys of the clip.
const TARGETS: usize = 4;
const KEYS: usize = 30;

/// Measures four targets with linear interpolation between 30 keys.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
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
        let copied = copy_of(gpu, words * all / 2)?;
        let mut weights = vec![0.0; all];
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let weights = std::hint::black_box(&mut weights);
                morph_weights(mesh, (&set, &[0]), &instances, &instance_lods, 0.5, weights);
            }),
        ];
        bench.case(format!("4 targets × {count}"), (all, "weight"), (4 * words * all) as u64, contenders)?;
    }
    Ok(())
}
