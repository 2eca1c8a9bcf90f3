//! Parity and benchmark cases of `kernels/skinning/skin.wgsl`.

use std::iter;

use relievo::Error;
use relievo::asset::Influences;
use relievo::asset::mesh::MeshLevel;
use relievo::asset::transform::{Affine, rows};
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use relievo::ops::skinning::clusters::{CLUSTER, Clusters};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::pages::{NO_PAGE, PageBuffers};
use relievo::ops::skinning::palette::Palette;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::select::ClusterState;
use relievo::ops::skinning::skin::reference::weights::reduced;
use relievo::ops::skinning::skin::reference::{SkinnedMesh, blended, skin, skin_seen};
use relievo::ops::skinning::skin::{SKIN_BOUND, SkinPass, TRUNCATED};
use relievo::ops::skinning::vertex::{Blend, Vertex};

use crate::cases::skinning::{
    CROWDS, RING, SHAPES, Scene, Shape, flat, poisoned, random_instance_lods, random_matrices, random_model,
    random_tiers, seen_of, tube, uploaded,
};
use crate::cases::terrain::copy_of;
use crate::harness::compare::Comparison;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender, compare};

/// Number of instances of a case: full, truncated, fading and unseen ones.
const INSTANCES: usize = 9;

/// The cases cover one to eight influences, linear blending and dual quaternions, with and without morph
/// targets; lists of all clusters, some, and none. All other vertices must stay unchanged, as must those
/// of unseen instances and those beyond an instance's level. Errors are divided by each value's own bound.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for blend in [Blend::Linear, Blend::DualQuaternion] {
        let pass = SkinPass::new(cases.gpu, blend)?;
        for (case, shape) in (0..).zip(SHAPES) {
            let scene = Case::new(cases.gpu, case, shape, blend)?;
            let name = format!("{} vertices of {} influences, {blend:?}", shape.vertices, shape.influences);
            for (list, every) in [("none", u32::MAX), ("every third", 3), ("backwards", 1)] {
                cases.add(format!("{name}, {list}"), scene.some(cases.gpu, &pass, every).await?);
            }
            cases.add(format!("{name}, in pages"), scene.paged(cases.gpu, &pass).await?);
            cases.add(format!("{name}, last kept"), scene.kept(cases.gpu, &pass).await?);
        }
    }
    Ok(())
}

/// An expected vertex, and its tolerances.
#[derive(Clone, Copy)]
struct Expected {
    vertex: Vertex,
    position: f32,
    normal: f32,
    tangent: f32,
}

impl Expected {
    fn untouched() -> Self {
        Self { vertex: poisoned(), position: 1.0, normal: 1.0, tangent: 1.0 }
    }
}

struct Case {
    mesh: MeshBuffers,
    clusters: Clusters,
    crowd: SkinnedCrowd,
    /// Vertices instance by instance, in the mesh's order.
    expected: Vec<Expected>,
}

impl Case {
    fn new(gpu: &Gpu, case: u32, shape: Shape, blend: Blend) -> Result<Self, Error> {
        let model = random_model(case, shape)?;
        let tiers = random_tiers(case, &model, shape)?;
        let (mesh, clusters) = uploaded(gpu, &model, &tiers)?;
        let mut crowd = SkinnedCrowd::new(gpu, &mesh, INSTANCES, blend)?;
        let instance_lods = random_instance_lods(case, INSTANCES, 1 + tiers.len() as u32);
        let tiers: Vec<&Influences> = iter::once(&model.meshes[0].influences).chain(&tiers).collect();
        crowd.instance_lods.write(gpu, &instance_lods)?;
        let matrices = random_matrices(case, shape.bones, INSTANCES);
        let mut vectors: Vec<[f32; 4]> = Vec::new();
        let mut placed = Vec::new();
        let mut expected = Vec::new();
        for (instance, models) in matrices.chunks(shape.bones).enumerate() {
            let palette = palette_for(&model.skins[0], models, blend);
            match &palette {
                Palette::Linear(bones) => vectors.extend(bones.as_flattened()),
                Palette::Dual(bones) => vectors.extend(bytemuck::cast_slice::<_, [f32; 4]>(bones)),
            }
            let weights: Vec<f32> =
                (0..shape.targets).map(|target| 0.5 - 0.25 * (target + instance) as f32).collect();
            let vertices = morph(&model.meshes[0], &weights);
            placed.extend(clusters.order.iter().map(|vertex| vertices[*vertex as usize]));
            expected.extend(expect(
                tiers[instance_lods[instance].tier as usize],
                &vertices,
                &clusters,
                &palette,
                instance_lods[instance],
            ));
        }
        crowd.palette = Buffer::from_slice(gpu, "palette", &vectors)?;
        if shape.targets > 0 {
            crowd.morphed = Buffer::from_slice(gpu, "morphed", &placed)?;
        }
        Ok(Self { mesh, clusters, crowd, expected })
    }

    async fn some(&self, gpu: &Gpu, pass: &SkinPass, every: u32) -> Result<Comparison, Error> {
        let output = Poisoned::<Vertex>::new(gpu, self.expected.len())?;
        let active = ActiveClusters::new(gpu, &self.mesh, &self.crowd)?;
        let pairs = (self.clusters.len() * INSTANCES) as u32;
        let chosen: Vec<u32> = (0..pairs).rev().filter(|pair| (pair + 1) % every == 0).collect();
        active.write(gpu, &chosen)?;
        let job = pass.prepare_active(gpu, &self.mesh, &self.crowd, &output.buffer, &active)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let mut expected = self.expected.clone();
        for (instance, expected) in expected.chunks_mut(self.clusters.order.len()).enumerate() {
            for (slot, vertex) in self.clusters.order.iter().enumerate() {
                let pair = (slot / 64 * INSTANCES + instance) as u32;
                if !chosen.contains(&pair) {
                    expected[*vertex as usize] = Expected::untouched();
                }
            }
        }
        Ok(output.check(gpu, |actual| self.compare(actual, &expected)).await?)
    }

    /// All clusters into pages that lie in reverse order; every fifth cluster has none.
    async fn paged(&self, gpu: &Gpu, pass: &SkinPass) -> Result<Comparison, Error> {
        let (clusters, vertices) = (self.clusters.len(), self.clusters.order.len());
        let count = clusters * INSTANCES;
        let output = Poisoned::<Vertex>::new(gpu, CLUSTER * count)?;
        let active = ActiveClusters::new(gpu, &self.mesh, &self.crowd)?;
        active.write(gpu, &(0..count as u32).collect::<Vec<_>>())?;
        let has_page = |entry: usize| entry % 5 != 4;
        let page = |entry: usize| if has_page(entry) { (count - 1 - entry) as u32 } else { NO_PAGE };
        let mut pages = PageBuffers::new(gpu, &self.mesh, &self.crowd, 0)?;
        pages.skinned = output.buffer.clone();
        pages.table.write(gpu, &(0..count).map(page).collect::<Vec<_>>())?;
        if self.mesh.targets > 0 {
            pages.morphed = Buffer::from_slice(gpu, "morphed", &self.morphed_pages(gpu).await?)?;
        }
        let job = pass.prepare_paged(gpu, &self.mesh, &self.crowd, &pages, &active)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let mut expected = self.expected.clone();
        let comparison = output
            .check(gpu, |actual| {
                let mut found = Vec::with_capacity(expected.len());
                for (instance, expected) in expected.chunks_mut(vertices).enumerate() {
                    for (slot, vertex) in self.clusters.order.iter().enumerate() {
                        let entry = instance * clusters + slot / CLUSTER;
                        // Clusters without a page leave no trace; what lies in pages without a cluster is compared too.
                        if !has_page(entry) {
                            expected[*vertex as usize] = Expected::untouched();
                        }
                        found.push(actual[CLUSTER * (count - 1 - entry) + slot % CLUSTER]);
                    }
                }
                self.compare(&found, &expected)
            })
            .await?;
        Ok(comparison)
    }

    /// The morphed vertices in pages that lie in reverse order.
    async fn morphed_pages(&self, gpu: &Gpu) -> Result<Vec<Vertex>, Error> {
        let (clusters, vertices) = (self.clusters.len(), self.clusters.order.len());
        let count = clusters * INSTANCES;
        let mut all = vec![poisoned(); CLUSTER * count];
        for (at, vertex) in self.crowd.morphed.read(gpu).await?.into_iter().enumerate() {
            let (instance, slot) = (at / vertices, at % vertices);
            let page = count - 1 - (instance * clusters + slot / CLUSTER);
            all[CLUSTER * page + slot % CLUSTER] = vertex;
        }
        Ok(all)
    }

    /// All clusters into pages that keep last positions: of those that moved what lay there, of the others, but for those
    /// without a page, what is written. Both are copies, to the bit.
    async fn kept(&self, gpu: &Gpu, pass: &SkinPass) -> Result<Comparison, Error> {
        let count = self.clusters.len() * INSTANCES;
        let mut active = ActiveClusters::keeping(gpu, &self.mesh, &self.crowd)?;
        active.write(gpu, &(0..count as u32).collect::<Vec<_>>())?;
        let is_fresh = |pair: usize| pair.is_multiple_of(3);
        let state = |pair: usize| {
            let state = if is_fresh(pair) { ClusterState::Fresh } else { ClusterState::Moved };
            state as u32
        };
        let pairs: Vec<u32> = (0..count as u32).chain((0..count).map(state)).collect();
        active.pairs = Buffer::from_slice(gpu, "pairs", &pairs)?;
        let mut pages = PageBuffers::keeping(gpu, &self.mesh, &self.crowd, count as u32)?;
        let page = |entry: usize| if entry % 5 == 4 { NO_PAGE } else { entry as u32 };
        pages.table.write(gpu, &(0..count).map(page).collect::<Vec<_>>())?;
        let old: Vec<f32> = (0..10 * pages.skinned.len()).map(|at| at as f32).collect();
        pages.skinned = Buffer::from_slice(gpu, "pages", bytemuck::cast_slice::<_, Vertex>(&old))?;
        let job = pass.prepare_paged(gpu, &self.mesh, &self.crowd, &pages, &active)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let found = pages.skinned.read(gpu).await?;
        let found: &[f32] = bytemuck::cast_slice(&found);
        let last = 2 * pages.last as usize;
        let mut expected = old[last..][..4 * CLUSTER * count].to_vec();
        for (slot, kept) in expected.chunks_exact_mut(4).enumerate() {
            let (entry, lane) = (slot / CLUSTER, slot % CLUSTER);
            let (instance, cluster) = (entry / self.clusters.len(), entry % self.clusters.len());
            if self.is_skinned(instance, CLUSTER * cluster + lane) && page(entry) != NO_PAGE {
                let from = if is_fresh(cluster * INSTANCES + instance) { found } else { &old };
                kept[..3].copy_from_slice(&from[10 * slot..][..3]);
                kept[3] = 0.0;
            }
        }
        let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        Ok(compare::exact(&bits(&found[last..][..expected.len()]), &bits(&expected)))
    }

    /// Whether the vertex of a slot is skinned.
    fn is_skinned(&self, instance: usize, slot: usize) -> bool {
        let vertices = self.clusters.order.len();
        let vertex = self.clusters.order.get(slot);
        vertex
            .is_some_and(|vertex| self.expected[instance * vertices + *vertex as usize].vertex != poisoned())
    }

    fn compare(&self, actual: &[Vertex], expected: &[Expected]) -> Comparison {
        let ordered =
            actual.chunks(self.clusters.order.len()).flat_map(|actual| self.clusters.in_mesh_order(actual));
        let relative = |vertices: Vec<Vertex>| {
            let mut values = flat(&vertices);
            for (values, expected) in values.chunks_exact_mut(10).zip(expected) {
                let Expected { position: p, normal: n, tangent: t, .. } = *expected;
                let bounds = [p, p, p, n, n, n, t, t, t, 0.5];
                values.iter_mut().zip(bounds).for_each(|(value, bound)| *value /= bound);
            }
            values
        };
        let expected = relative(expected.iter().map(|expected| expected.vertex).collect());
        compare::absolute(&relative(ordered.collect()), &expected, 1.0)
    }
}

/// The reference's vertices, each with its own bounds; see [`SKIN_BOUND`].
fn expect(
    influences: &Influences,
    vertices: &[Vertex],
    clusters: &Clusters,
    palette: &Palette,
    instance_lod: InstanceLod,
) -> Vec<Expected> {
    let mut skinned = vec![poisoned(); vertices.len()];
    skin_seen(&mut skinned, SkinnedMesh { vertices, influences, clusters }, palette, instance_lod);
    if instance_lod == InstanceLod::UNSEEN {
        return skinned.into_iter().map(|vertex| Expected { vertex, ..Expected::untouched() }).collect();
    }
    let largest = match palette {
        Palette::Linear(bones) => size(bones.as_flattened().as_flattened()),
        // Translations are twice the dual part, and three products of three factors take the place of one
        // matrix.
        Palette::Dual(bones) => 8.0 * size(bytemuck::cast_slice(bones)),
    };
    let expected = |(at, vertex): (usize, Vertex)| {
        if vertex == poisoned() {
            return Expected::untouched();
        }
        let matrix = blended(palette, &reduced(influences.of(at), instance_lod));
        let old = &vertices[at];
        let is_truncated = (instance_lod.max_influences as usize) < influences.of(at).len();
        let bound = SKIN_BOUND * if is_truncated { TRUNCATED } else { 1.0 } * largest;
        let sum = |vector: &[f32]| vector.iter().map(|x| x.abs()).sum::<f32>();
        let [normal, tangent] = lengths(&matrix, old);
        Expected {
            vertex,
            position: bound * (1.0 + sum(&old.position)),
            normal: 4.0 * bound * largest * sum(&old.normal) / normal,
            tangent: 2.0 * bound * sum(&old.tangent[..3]) / tangent,
        }
    };
    skinned.into_iter().enumerate().map(expected).collect()
}

fn size(values: &[f32]) -> f32 {
    values.iter().fold(1.0, |a: f32, b| a.max(b.abs()))
}

/// The lengths of a vertex's normal and tangent before normalization.
fn lengths(matrix: &Affine, vertex: &Vertex) -> [f32; 2] {
    let linear = glam::Mat3::from_cols_array_2d(&matrix.map(|[x, y, z, _]| [x, y, z])).transpose();
    let cofactors = linear.determinant() * linear.inverse().transpose();
    let [tx, ty, tz, _] = vertex.tangent;
    [(cofactors * glam::Vec3::from(vertex.normal)).length(), (linear * glam::vec3(tx, ty, tz)).length()]
}

/// A benchmark case: which clusters of a crowd are skinned, and what its reference does.
struct Work {
    name: String,
    /// Instances of the scene, and how often all of it is skinned.
    instances: usize,
    repeats: usize,
    /// Every so many of the clusters are listed.
    every: usize,
    /// Vertices that are skinned, in all, and by each call of the reference.
    vertices: usize,
    each: usize,
    /// Words that are loaded and stored per vertex.
    words: usize,
    instance_lods: Vec<InstanceLod>,
}

impl Work {
    /// All vertices of `instances` instances of the tube, at full quality.
    fn new(name: String, influences: usize, instances: usize) -> Self {
        let each = RING * RING;
        // The kernel reads a vertex, its influences and its bones' rows, and writes a vertex.
        let words = 10 + influences.div_ceil(2) + (influences - 1) + 12 * influences + 10;
        let (vertices, instance_lods) = (each * instances, vec![InstanceLod::FULL; instances]);
        Self { name, instances, repeats: 1, every: 1, vertices, each, words, instance_lods }
    }
}

/// Measures vertices with eight, four, two influences and one; and of a hundred instances with four: a list with every eighth
/// cluster; instances of which a quarter is seen; a level with a quarter of the vertices; and full fade, where the weight that
/// decides is read, and one bone. Times are per skinned vertex.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let (gpu, count, vertices) = (bench.gpu, CROWDS[1], RING * RING);
    let pass = SkinPass::new(gpu, Blend::Linear)?;
    for influences in [8, 4, 2, 1] {
        for instances in CROWDS {
            let name = format!("{influences} influences, 10k × {instances}");
            let each = batch(gpu, instances);
            let work = Work { repeats: instances / each, ..Work::new(name, influences, each) };
            measured(bench, &pass, Scene::new(gpu, influences, 0, each)?, &work)?;
        }
    }
    let four = |name: &str| Work::new(name.to_owned(), 4, count);
    let scene = || Scene::new(gpu, 4, 0, count);
    let clusters = scene()?.clusters.len();
    let listed = CLUSTER * (count * clusters).div_ceil(8);
    measured(
        bench,
        &pass,
        scene()?,
        &Work { every: 8, vertices: listed, ..four("an eighth of 4, 10k × 100") },
    )?;
    let (quarter, instance_lods) = (count / 4 * vertices, seen_of(count, 4));
    let seen = four("4, a quarter of 10k × 100 seen");
    measured(bench, &pass, scene()?, &Work { vertices: quarter, instance_lods, ..seen })?;
    let mut model = tube(4, 0)?;
    let mesh = &mut model.meshes[0];
    let indices = mesh.indices[..mesh.indices.len() / 12 * 3].to_vec();
    mesh.levels = vec![MeshLevel { indices, error: 0.0 }];
    let levelled = Scene::of(gpu, model, count)?;
    let each = CLUSTER * levelled.clusters.level(1).clusters as usize;
    let instance_lods = vec![InstanceLod::level(1)?; count];
    let level = four("4, 10k × 100 at a level of a quarter");
    measured(bench, &pass, levelled, &Work { vertices: count * each, each, instance_lods, ..level })?;
    let instance_lods = vec![InstanceLod::fade(1.0)?; count];
    measured(bench, &pass, scene()?, &Work { words: 34, instance_lods, ..four("4 faded to 1, 10k × 100") })
}

/// Measures a crowd beside a copy of the same words, and one of the same output without influences.
fn measured(bench: &mut Bench<'_>, pass: &SkinPass, scene: Scene, work: &Work) -> Result<(), Error> {
    let gpu = bench.gpu;
    scene.crowd.instance_lods.write(gpu, &work.instance_lods)?;
    let output = Buffer::new(gpu, "skinned", work.instances * RING * RING)?;
    let active = ActiveClusters::new(gpu, &scene.mesh, &scene.crowd)?;
    let pairs = (work.instances * scene.clusters.len()) as u32;
    active.write(gpu, &(0..pairs).step_by(work.every).collect::<Vec<_>>())?;
    let job = pass.prepare_active(gpu, &scene.mesh, &scene.crowd, &output, &active)?;
    let [copied, unmoved] = [work.words, 20].map(|words| copy_of(gpu, words * work.vertices / 2));
    let (copied, unmoved) = (copied?, unmoved?);
    let mesh = &scene.model.meshes[0];
    let palette = Palette::Linear(scene.model.skins[0].inverse_binds.iter().map(rows).collect());
    let unskinned = morph(mesh, &[]);
    let all = work.repeats * work.vertices;
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| (0..work.repeats).for_each(|_| job.record(encoder))),
        Contender::recorded(Backend::Copy, |encoder| (0..work.repeats).for_each(|_| copied.record(encoder))),
        Contender::recorded(Backend::Limit, |encoder| {
            (0..work.repeats).for_each(|_| unmoved.record(encoder))
        }),
        Contender::host(Backend::Reference, || {
            for _ in 0..all / work.each {
                let some = &unskinned[..work.each];
                drop(std::hint::black_box(skin(some, &mesh.influences, &palette, InstanceLod::FULL)));
            }
        }),
    ];
    bench.case(&work.name, all, "vertex", (4 * work.words * all) as u64, contenders)
}

/// The number of instances, a divisor of `instances`, whose vertices and copies fit one buffer.
fn batch(gpu: &Gpu, instances: usize) -> usize {
    // The copy of eight influences is the largest: 128 words a vertex, half of them read.
    let room = gpu.max_binding() as usize / (RING * RING * 4 * 64);
    (1..=instances).rev().find(|batch| instances.is_multiple_of(*batch) && *batch <= room.max(1)).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::gpu::Options;

    /// The reference's own vertices pass the comparison; a vertex that is displaced, rotated or mirrored fails
    /// it.
    #[test]
    fn vertices_that_go_astray_are_seen() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        for blend in [Blend::Linear, Blend::DualQuaternion] {
            let scene = Case::new(&gpu, 3, SHAPES[3], blend).expect("made");
            let vertices = SHAPES[3].vertices;
            let placed = |instance: usize| {
                let expected = &scene.expected[instance * vertices..][..vertices];
                scene
                    .clusters
                    .order
                    .iter()
                    .map(|vertex| expected[*vertex as usize].vertex)
                    .collect::<Vec<_>>()
            };
            let right: Vec<Vertex> = (0..INSTANCES).flat_map(placed).collect();
            assert!(scene.compare(&right, &scene.expected).holds);
            let wrong = |change: &dyn Fn(&mut Vertex)| {
                let mut changed = right.clone();
                change(&mut changed[300]);
                scene.compare(&changed, &scene.expected)
            };
            for axis in 0..3 {
                assert!(!wrong(&|vertex| vertex.position[axis] += 4e-3).holds);
                assert!(!wrong(&|vertex| vertex.normal[axis] += 0.05).holds);
                assert!(!wrong(&|vertex| vertex.tangent[axis] += 0.05).holds);
                assert!(!wrong(&|vertex| vertex.position[axis] = f32::NAN).holds);
            }
            assert!(!wrong(&|vertex| vertex.tangent[3] *= -1.0).holds);
            assert!(!scene.compare(&right[1..], &scene.expected).holds);
        }
    }
}
