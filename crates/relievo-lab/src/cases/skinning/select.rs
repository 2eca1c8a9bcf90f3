//! Parity and benchmark cases of `kernels/skinning/select.wgsl`.

use relievo::asset::morph::MorphDelta;
use relievo::asset::{Model, MorphTarget};
use relievo::ops::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use relievo::ops::skinning::clusters::{CLUSTER, Clusters};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::select::reference::{Now, Skinned, remember, select, select_keeping};
use relievo::ops::skinning::select::{ClusterSelectBuffers, ClusterSelectPass, ClusterState, SKINNED_WORDS};
use relievo::ops::skinning::vertex::Blend;
use relievo::{Error, InputError};

use crate::cases::animation::Draw;
use crate::cases::measure;
use crate::cases::skinning::{
    CROWDS, SHAPES, Scene, Shape, random_instance_lods, random_model, random_tiers, seen_of, uploaded,
};
use crate::harness::compare::Comparison;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases, compare};

/// A sequence of frames: name, how many of 64 bones are updated, and whether InstanceLods and weights change.
const FRAMES: [(&str, u32, bool); 10] = [
    ("the first", 8, true),
    ("others seen and faded", 2, true),
    ("bones alone", 5, false),
    ("nothing", 0, false),
    ("all unseen", 5, false),
    ("all back", 0, false),
    ("nothing again", 0, false),
    ("other levels", 0, false),
    ("other levels again", 1, false),
    ("all whole", 0, false),
];

/// The inputs of a frame's selection.
struct Frame {
    updated_bones: Vec<u32>,
    instance_lods: Vec<InstanceLod>,
    weights: Vec<f32>,
}

impl Frame {
    /// The frame before the first: nothing is seen.
    fn before_all(instances: usize, words: usize, targets: usize) -> Self {
        Self {
            updated_bones: vec![0; instances * words],
            instance_lods: vec![InstanceLod::UNSEEN; instances],
            weights: vec![0.0; instances * targets],
        }
    }

    fn now(&self) -> Now<'_> {
        Now { updated_bones: &self.updated_bones, instance_lods: &self.instance_lods, weights: &self.weights }
    }

    /// The next frame.
    fn next(&self, draw: &mut Draw, case: u32, name: &str, fraction: u32, is_other: bool) -> Self {
        let word =
            |_: &u32| (0..32).fold(0_u32, |word, bit| word | u32::from(draw.word() % 64 < fraction) << bit);
        let updated_bones = self.updated_bones.iter().map(word).collect();
        let instances = self.instance_lods.len();
        let instance_lods = match name {
            "all unseen" => vec![InstanceLod::UNSEEN; instances],
            "all back" | "all whole" => vec![InstanceLod::FULL; instances],
            "other levels" | "other levels again" => {
                let level = |old: &InstanceLod| InstanceLod { mesh_lod: draw.word() % 5, ..*old };
                self.instance_lods.iter().map(level).collect()
            }
            _ if is_other => random_instance_lods(case + fraction, instances, 1 + case % 2),
            _ => self.instance_lods.clone(),
        };
        // Every third weight changes, and all of them while no instance is seen.
        let weight = |(at, old): (usize, &f32)| {
            if is_other && at % 3 == 0 || name == "all unseen" { draw.signed() } else { *old }
        };
        let weights = self.weights.iter().enumerate().map(weight).collect();
        Self { updated_bones, instance_lods, weights }
    }
}

/// The cases cover no updated bone, some and all; InstanceLods that change and that do not; instances that
/// leave the view and come back; levels that become coarser and finer; weights of targets that move some of the
/// clusters. Lists are compared sorted, together with the untouched memory beyond them, their length, the
/// workgroups, and the stored state.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = ClusterSelectPass::new(gpu)?;
    for (case, shape) in (0..).zip(SHAPES) {
        let model = model(case, shape)?;
        let (mesh, clusters) = uploaded(gpu, &model, &random_tiers(case, &model, shape)?)?;
        let instances = 1 + 29 * (case as usize % 3);
        let crowd = SkinnedCrowd::new(gpu, &mesh, instances, Blend::Linear)?;
        let mut buffers = ClusterSelectBuffers::new(gpu, &mesh, &crowd)?;
        let words = instances * (SKINNED_WORDS + shape.targets);
        let remembered = Poisoned::<u32>::new(gpu, words)?;
        remembered.buffer.write(gpu, &vec![0; words])?;
        buffers.skinned = remembered.buffer.clone();
        let mut active = ActiveClusters::new(gpu, &mesh, &crowd)?;
        let output = Poisoned::<u32>::new(gpu, clusters.len() * instances)?;
        active.pairs = output.buffer.clone();
        let updated_bones = Poisoned::<u32>::new(gpu, instances * clusters.mask_words)?;
        buffers.updated_bones = updated_bones.buffer.clone();
        let [keeping, clearing] = pass.prepare(gpu, &mesh, &crowd, &buffers, &active)?;
        let mut last = vec![Skinned::nothing(shape.targets); instances];
        let mut draw = Draw::new(case ^ 0xb17);
        let mut frame = Frame::before_all(instances, clusters.mask_words, shape.targets);
        for (number, (kind, fraction, is_other)) in FRAMES.into_iter().enumerate() {
            frame = frame.next(&mut draw, case, kind, fraction, is_other);
            crowd.instance_lods.write(gpu, &frame.instance_lods)?;
            crowd.weights.write(gpu, &frame.weights)?;
            buffers.updated_bones.write(gpu, &frame.updated_bones)?;
            output.poison(gpu)?;
            let clears = number % 3 == 1;
            gpu.submit("verify", |encoder| if clears { &clearing } else { &keeping }.record(encoder))?;
            let expected = select(&clusters, &frame.now(), &last);
            remember(&frame.now(), &mut last);
            let dispatched = active.dispatched.read(gpu).await?;
            let name = format!("{} clusters × {instances}, {}", clusters.len(), kind);
            cases.check(name, &output, |actual| listed(actual, &dispatched, &expected)).await?;
            let name = format!("{} clusters × {instances}, {}: updated bones", clusters.len(), kind);
            let left: Vec<u32> =
                frame.updated_bones.iter().map(|word| if clears { 0 } else { *word }).collect();
            cases.exact(name, &updated_bones, &left).await?;
            let name = format!("{} clusters × {instances}, {}: remembered", clusters.len(), kind);
            cases.exact(name, &remembered, &words_of(&last)).await?;
        }
        keeping_cases(cases, &pass, case, &mesh, &clusters, &crowd).await?;
    }
    Ok(())
}

/// The same frames where last positions are kept: what moved is selected once more, and every state is compared.
async fn keeping_cases(
    cases: &mut Cases<'_>,
    pass: &ClusterSelectPass,
    case: u32,
    mesh: &MeshBuffers,
    clusters: &Clusters,
    crowd: &SkinnedCrowd,
) -> Result<(), Error> {
    let (gpu, instances) = (cases.gpu, crowd.instances);
    let count = clusters.len() * instances;
    let buffers = ClusterSelectBuffers::new(gpu, mesh, crowd)?;
    let mut active = ActiveClusters::keeping(gpu, mesh, crowd)?;
    let output = Poisoned::<u32>::new(gpu, 2 * count)?;
    active.pairs = output.buffer.clone();
    let [job, _] = pass.prepare(gpu, mesh, crowd, &buffers, &active)?;
    let mut last = vec![Skinned::nothing(mesh.targets); instances];
    let mut states = vec![ClusterState::Still; count];
    let mut draw = Draw::new(case ^ 0x6ee9);
    let mut frame = Frame::before_all(instances, clusters.mask_words, mesh.targets);
    for (kind, fraction, is_other) in FRAMES {
        frame = frame.next(&mut draw, case, kind, fraction, is_other);
        crowd.instance_lods.write(gpu, &frame.instance_lods)?;
        crowd.weights.write(gpu, &frame.weights)?;
        buffers.updated_bones.write(gpu, &frame.updated_bones)?;
        output.poison(gpu)?;
        let before = states.iter().map(|state| *state as u32);
        active.pairs.write(gpu, &vec![POISON; count].into_iter().chain(before).collect::<Vec<_>>())?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let expected = select_keeping(clusters, &frame.now(), &last, &mut states);
        remember(&frame.now(), &mut last);
        let dispatched = active.dispatched.read(gpu).await?;
        let words: Vec<u32> = states.iter().map(|state| *state as u32).collect();
        let same = |actual: &[u32]| {
            let (pairs, found) = actual.split_at(count.min(actual.len()));
            let listed = listed(pairs, &dispatched, &expected);
            if listed.holds { compare::exact(found, &words) } else { listed }
        };
        let name = format!("{} clusters × {instances}, {}: last kept", clusters.len(), kind);
        cases.check(name, &output, same).await?;
    }
    Ok(())
}

fn listed(actual: &[u32], dispatched: &[u32], expected: &[u32]) -> Comparison {
    let count = expected.len() as u32;
    let (listed, behind) = actual.split_at(actual.len().min(expected.len()));
    let mut all = listed.to_vec();
    all.sort_unstable();
    let x = count.clamp(1, 65_535);
    let dispatches = [x, count.div_ceil(x), 1, count, 0];
    compare::exact(
        &[&all, behind, dispatched].concat(),
        &[expected, &vec![POISON; behind.len()], &dispatches].concat(),
    )
}

fn words_of(last: &[Skinned]) -> Vec<u32> {
    let words = |last: &Skinned| {
        let InstanceLod { influence_fade: fade, max_influences: most, mesh_lod: level, tier } =
            last.instance_lod;
        let weights = last.weights.iter().map(|weight| weight.to_bits());
        [fade.to_bits(), most, level, tier, last.seen].into_iter().chain(weights).collect::<Vec<_>>()
    };
    last.iter().flat_map(words).collect()
}

/// A random model whose targets move only vertices of every second cluster.
fn model(case: u32, shape: Shape) -> Result<Model, InputError> {
    let mut model = random_model(case, shape)?;
    let order = Clusters::new(&model.meshes[0], &model.skins, &model.skeleton)?.order;
    for target in &mut model.meshes[0].targets {
        let is_kept = |vertex: &u32| {
            order
                .iter()
                .position(|other| other == vertex)
                .is_some_and(|slot| (slot / CLUSTER).is_multiple_of(2))
        };
        let (vertices, deltas): (Vec<u32>, Vec<MorphDelta>) =
            target.vertices.iter().zip(&target.deltas).filter(|(vertex, _)| is_kept(vertex)).unzip();
        *target = MorphTarget { vertices, deltas };
    }
    Ok(model)
}

/// Measures crowds in which one bone in eight is updated, with all instances seen or a quarter of them.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = ClusterSelectPass::new(gpu)?;
    for (instances, seen) in CROWDS.map(|count| (count, 1)).into_iter().chain([(CROWDS[2], 4)]) {
        let scene = Scene::new(gpu, 4, 0, instances)?;
        let buffers = ClusterSelectBuffers::new(gpu, &scene.mesh, &scene.crowd)?;
        let active = ActiveClusters::new(gpu, &scene.mesh, &scene.crowd)?;
        let updated_bones = vec![0x0101_0101; instances * scene.mesh.mask_words];
        buffers.updated_bones.write(gpu, &updated_bones)?;
        let instance_lods = seen_of(instances, seen);
        scene.crowd.instance_lods.write(gpu, &instance_lods)?;
        let [job, _] = pass.prepare(gpu, &scene.mesh, &scene.crowd, &buffers, &active)?;
        let pairs = scene.clusters.len() * instances;
        let last: Vec<Skinned> =
            instance_lods.iter().map(|now| Skinned { instance_lod: *now, ..Skinned::nothing(0) }).collect();
        let words = scene.mesh.mask_words;
        // The kernel reads an InstanceLod and the remembered state and, for instances that are seen, a mask and
        // a set of bones.
        let read = 2 + SKINNED_WORDS + 2 * words / seen;
        let name = if seen == 1 { "" } else { ", a quarter seen" };
        let case = format!("157 clusters × {instances}{name}");
        measure(bench, case, pairs, "cluster", read * pairs, &|encoder| job.record(encoder), || {
            let now = Now { updated_bones: &updated_bones, instance_lods: &instance_lods, weights: &[] };
            select(&scene.clusters, &now, &last)
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pairs of four, in any order; then one too few, a wrong one, and one that was written beyond the
    /// list.
    #[test]
    fn lists_are_compared_with_what_is_behind_them() {
        let holds = |actual: &[u32], count| listed(actual, &[count, 1, 1, count, 0], &[3, 9]).holds;
        assert!(holds(&[9, 3, POISON, POISON], 2));
        assert!(!holds(&[9, POISON, POISON, POISON], 2) && !holds(&[9, 4, POISON, POISON], 2));
        assert!(!holds(&[9, 3, POISON, POISON], 3) && !holds(&[9, 3, POISON, 3], 2));
    }
}
