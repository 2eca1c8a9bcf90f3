//! Parity and benchmark cases of `kernels/skinning/morph.wgsl`.

use relievo::Error;
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::ops::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use relievo::ops::skinning::clusters::{CLUSTER, Clusters};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::morph::{MORPH_BOUND, MorphPass};
use relievo::ops::skinning::pages::{NO_PAGE, PageBuffers};
use relievo::ops::skinning::vertex::{Blend, Vertex};

use crate::cases::animation::Draw;
use crate::cases::measure;
use crate::cases::skinning::{RING, SHAPES, Scene, Shape, flat, poisoned, random_model};
use crate::harness::compare::Comparison;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases, compare};

/// The cases cover vertices that no target, one, or every target moves; weights of 0, of either sign and above
/// 1; all clusters, none and some. The fourth of five instances is not seen: its vertices must stay unchanged,
/// as must those of other clusters and those beyond the level of an instance. The second instance has the
/// coarsest level, the third level 1. Pages in reverse order get the clusters that have one, and nothing else.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = MorphPass::new(gpu)?;
    for (case, shape) in (0..).zip(SHAPES).filter(|(_, shape)| shape.targets > 0) {
        for instances in [1, 5] {
            let scene = Case::new(gpu, case, shape, instances)?;
            let name = format!("{} vertices, {} targets × {instances}", shape.vertices, shape.targets);
            for (list, every) in [("all", 1), ("none", u32::MAX), ("every third", 3)] {
                cases.add(format!("{name}, {list}"), scene.listed(gpu, &pass, every).await?);
            }
            cases.add(format!("{name}, pages"), scene.paged(gpu, &pass).await?);
        }
    }
    Ok(())
}

/// A mesh on the device, and the weights of its targets for some instances.
struct Case {
    model: Model,
    mesh: MeshBuffers,
    clusters: Clusters,
    instances: usize,
    weights: Vec<f32>,
}

impl Case {
    fn new(gpu: &Gpu, case: u32, shape: Shape, instances: usize) -> Result<Self, Error> {
        let model = random_model(case, shape)?;
        let (mesh, clusters) = MeshBuffers::new(gpu, &model, &model.meshes[0])?;
        let mut draw = Draw::new(case ^ 0x0f0f);
        let weight = |at| if at % 4 == 3 { 0.0 } else { 1.5 * draw.signed() };
        let weights = (0..instances * shape.targets).map(weight).collect();
        Ok(Self { model, mesh, clusters, instances, weights })
    }

    async fn listed(&self, gpu: &Gpu, pass: &MorphPass, every: u32) -> Result<Comparison, Error> {
        let mut crowd = SkinnedCrowd::new(gpu, &self.mesh, self.instances, Blend::Linear)?;
        let output = Poisoned::<Vertex>::new(gpu, crowd.morphed.len())?;
        crowd.morphed = output.buffer.clone();
        crowd.weights.write(gpu, &self.weights)?;
        if self.instances > 3 {
            let (coarsest, coarse) = (InstanceLod::level(15)?, InstanceLod::level(1)?);
            crowd.instance_lods.write_at(gpu, 1, &[coarsest, coarse, InstanceLod::UNSEEN])?;
        }
        let pairs = (self.clusters.len() * self.instances) as u32;
        let chosen: Vec<u32> = (0..pairs).rev().filter(|pair| (pair + 1) % every == 0).collect();
        let active = ActiveClusters::new(gpu, &self.mesh, &crowd)?;
        active.write(gpu, &chosen)?;
        let job = pass.prepare_active(gpu, &self.mesh, &crowd, &active)?;
        gpu.submit("verify", |encoder| job.iter().for_each(|job| job.record(encoder)))?;
        let mut expected = Vec::new();
        for (instance, weights) in self.weights.chunks(self.mesh.targets).enumerate() {
            let morphed = morph(&self.model.meshes[0], weights);
            let level = self.clusters.level([0, 15, 1, 0, 0][instance]);
            expected.extend(self.clusters.order.iter().enumerate().map(|(slot, vertex)| {
                let pair = slot / CLUSTER * self.instances + instance;
                let is_kept = instance == 3 || slot / CLUSTER >= level.clusters as usize;
                let is_morphed = !is_kept && chosen.contains(&(pair as u32));
                if is_morphed { morphed[*vertex as usize] } else { poisoned() }
            }));
        }
        Ok(output.check(gpu, |actual| compared(actual, &expected)).await?)
    }

    /// All clusters into pages that lie in reverse order; every fifth cluster has none.
    async fn paged(&self, gpu: &Gpu, pass: &MorphPass) -> Result<Comparison, Error> {
        let crowd = SkinnedCrowd::paged(gpu, &self.mesh, self.instances, Blend::Linear)?;
        crowd.weights.write(gpu, &self.weights)?;
        let count = self.clusters.len() * self.instances;
        let has_page = |entry: usize| entry % 5 != 4;
        let page = |entry: usize| if has_page(entry) { (count - 1 - entry) as u32 } else { NO_PAGE };
        let output = Poisoned::<Vertex>::new(gpu, CLUSTER * count)?;
        let mut pages = PageBuffers::new(gpu, &self.mesh, &crowd, 0)?;
        pages.morphed = output.buffer.clone();
        pages.table.write(gpu, &(0..count).map(page).collect::<Vec<_>>())?;
        let active = ActiveClusters::new(gpu, &self.mesh, &crowd)?;
        active.write(gpu, &(0..count as u32).collect::<Vec<_>>())?;
        let job = pass.prepare_paged(gpu, &self.mesh, &crowd, &pages, &active)?;
        gpu.submit("verify", |encoder| job.iter().for_each(|job| job.record(encoder)))?;
        let mut expected = vec![poisoned(); CLUSTER * count];
        for (instance, weights) in self.weights.chunks(self.mesh.targets).enumerate() {
            let morphed = morph(&self.model.meshes[0], weights);
            for (slot, vertex) in self.clusters.order.iter().enumerate() {
                let entry = instance * self.clusters.len() + slot / CLUSTER;
                if has_page(entry) {
                    expected[CLUSTER * (count - 1 - entry) + slot % CLUSTER] = morphed[*vertex as usize];
                }
            }
        }
        Ok(output.check(gpu, |actual| compared(actual, &expected)).await?)
    }
}

fn compared(actual: &[Vertex], expected: &[Vertex]) -> Comparison {
    compare::absolute(&flat(actual), &flat(expected), MORPH_BOUND)
}

/// Measures four targets that move a quarter of the vertices.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = MorphPass::new(gpu)?;
    for instances in [1, 100] {
        let scene = Scene::new(gpu, 1, 4, instances)?;
        scene.crowd.weights.write(gpu, &vec![0.5; 4 * instances])?;
        let active = ActiveClusters::new(gpu, &scene.mesh, &scene.crowd)?;
        active.write(gpu, &(0..(instances * scene.clusters.len()) as u32).collect::<Vec<_>>())?;
        let job = pass.prepare_active(gpu, &scene.mesh, &scene.crowd, &active)?;
        let all = RING * RING * instances;
        // The kernel reads a vertex, two offsets, a delta of 12 words and its weight, and writes a vertex.
        let words = 10 + 2 + 13 + 10;
        let reference = || {
            for _ in 0..instances {
                drop(std::hint::black_box(morph(&scene.model.meshes[0], &[0.5; 4])));
            }
        };
        let name = format!("4 targets, 10k × {instances}");
        let record = |encoder: &mut wgpu::CommandEncoder| job.iter().for_each(|job| job.record(encoder));
        measure(bench, name, all, "vertex", words * all, &record, reference)?;
    }
    Ok(())
}
