//! Parity cases of `kernels/skinning/skin.wgsl`.

use crate::Error;
use crate::asset::Model;
use crate::asset::transform::Affine;
use crate::gpu::{Buffer, Gpu};
use crate::harness::compare::Comparison;
use crate::harness::poison::Poisoned;
use crate::harness::{Cases, compare};
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use crate::skinning::clusters::{CLUSTER, Clusters};
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::morph::reference::morph;
use crate::skinning::pages::{NO_PAGE, PageBuffers};
use crate::skinning::palette::Palette;
use crate::skinning::palette::reference::palette_for;
use crate::skinning::select::ClusterState;
use crate::skinning::skin::reference::weights::reduced;
use crate::skinning::skin::reference::{blended, skin_seen};
use crate::skinning::skin::{SKIN_BOUND, SkinPass, TRUNCATED};
use crate::skinning::verify::{
    SHAPES, Shape, flat, poisoned, random_instance_lods, random_matrices, random_model,
};
use crate::skinning::vertex::{Blend, Vertex};

/// Number of instances of a case: full, truncated, fading and unseen ones.
const INSTANCES: usize = 9;

/// The cases cover one to eight influences, linear blending and dual quaternions, with and without morph
/// targets; all instances, some, and lists of clusters. All other vertices must stay unchanged, as must those
/// of unseen instances and those beyond an instance's level. Errors are divided by each value's own bound.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    for blend in [Blend::Linear, Blend::DualQuaternion] {
        let pass = SkinPass::new(cases.gpu, blend)?;
        for (case, shape) in (0..).zip(SHAPES) {
            let scene = Scene::new(cases.gpu, case, shape, blend)?;
            let name = format!("{} vertices of {} influences, {blend:?}", shape.vertices, shape.influences);
            for instances in [0..INSTANCES, 0..1, 4..7] {
                let output = Poisoned::<Vertex>::new(cases.gpu, instances.len() * shape.vertices)?;
                let (mesh, crowd) = (&scene.mesh, &scene.crowd);
                let job = pass.prepare(cases.gpu, mesh, crowd, instances.clone(), &output.buffer)?;
                cases.gpu.run("verify", |encoder| job.record(encoder))?;
                let expected =
                    &scene.expected[instances.start * shape.vertices..][..instances.len() * shape.vertices];
                let comparison = output.check(cases.gpu, |actual| scene.compare(actual, expected))?;
                cases.add(format!("{name}, instances {instances:?}"), comparison);
            }
            for (list, every) in [("none", u32::MAX), ("every third", 3), ("backwards", 1)] {
                cases.add(format!("{name}, {list}"), scene.some(cases.gpu, &pass, every)?);
            }
            cases.add(format!("{name}, in pages"), scene.paged(cases.gpu, &pass)?);
            cases.add(format!("{name}, last kept"), scene.kept(cases.gpu, &pass)?);
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

struct Scene {
    mesh: MeshBuffers,
    clusters: Clusters,
    crowd: SkinnedCrowd,
    /// Vertices instance by instance, in the mesh's order.
    expected: Vec<Expected>,
}

impl Scene {
    fn new(gpu: &Gpu, case: u32, shape: Shape, blend: Blend) -> Result<Self, Error> {
        let model = random_model(case, shape)?;
        let (mesh, clusters) = MeshBuffers::new(gpu, &model, &model.meshes[0])?;
        let mut crowd = SkinnedCrowd::new(gpu, &mesh, INSTANCES, blend)?;
        let instance_lods = random_instance_lods(case, INSTANCES);
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
            expected.extend(expect(&model, (&vertices, &clusters), &palette, instance_lods[instance]));
        }
        crowd.palette = Buffer::from_slice(gpu, "palette", &vectors)?;
        if shape.targets > 0 {
            crowd.morphed = Buffer::from_slice(gpu, "morphed", &placed)?;
        }
        Ok(Self { mesh, clusters, crowd, expected })
    }

    fn some(&self, gpu: &Gpu, pass: &SkinPass, every: u32) -> Result<Comparison, Error> {
        let output = Poisoned::<Vertex>::new(gpu, self.expected.len())?;
        let active = ActiveClusters::new(gpu, &self.mesh, &self.crowd)?;
        let pairs = (self.clusters.len() * INSTANCES) as u32;
        let chosen: Vec<u32> = (0..pairs).rev().filter(|pair| (pair + 1) % every == 0).collect();
        active.write(gpu, &chosen)?;
        let job = pass.prepare_active(gpu, &self.mesh, &self.crowd, &output.buffer, &active)?;
        gpu.run("verify", |encoder| job.record(encoder))?;
        let mut expected = self.expected.clone();
        for (instance, expected) in expected.chunks_mut(self.clusters.order.len()).enumerate() {
            for (slot, vertex) in self.clusters.order.iter().enumerate() {
                let pair = (slot / 64 * INSTANCES + instance) as u32;
                if !chosen.contains(&pair) {
                    expected[*vertex as usize] = Expected::untouched();
                }
            }
        }
        Ok(output.check(gpu, |actual| self.compare(actual, &expected))?)
    }

    /// All clusters into pages that lie in reverse order; every fifth cluster has none.
    fn paged(&self, gpu: &Gpu, pass: &SkinPass) -> Result<Comparison, Error> {
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
            pages.morphed = Buffer::from_slice(gpu, "morphed", &self.morphed_pages(gpu)?)?;
        }
        let job = pass.prepare_paged(gpu, &self.mesh, &self.crowd, &pages, &active)?;
        gpu.run("verify", |encoder| job.record(encoder))?;
        let mut expected = self.expected.clone();
        let comparison = output.check(gpu, |actual| {
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
        })?;
        Ok(comparison)
    }

    /// The morphed vertices in pages that lie in reverse order.
    fn morphed_pages(&self, gpu: &Gpu) -> Result<Vec<Vertex>, Error> {
        let (clusters, vertices) = (self.clusters.len(), self.clusters.order.len());
        let count = clusters * INSTANCES;
        let mut all = vec![poisoned(); CLUSTER * count];
        for (at, vertex) in self.crowd.morphed.read_blocking(gpu)?.into_iter().enumerate() {
            let (instance, slot) = (at / vertices, at % vertices);
            let page = count - 1 - (instance * clusters + slot / CLUSTER);
            all[CLUSTER * page + slot % CLUSTER] = vertex;
        }
        Ok(all)
    }

    /// All clusters into pages that keep last positions: of those that moved what lay there, of the others, but for those
    /// without a page, what is written. Both are copies, to the bit.
    fn kept(&self, gpu: &Gpu, pass: &SkinPass) -> Result<Comparison, Error> {
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
        gpu.run("verify", |encoder| job.record(encoder))?;
        let found = pages.skinned.read_blocking(gpu)?;
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
    model: &Model,
    (vertices, clusters): (&[Vertex], &Clusters),
    palette: &Palette,
    instance_lod: InstanceLod,
) -> Vec<Expected> {
    let influences = &model.meshes[0].influences;
    let mut skinned = vec![poisoned(); vertices.len()];
    skin_seen(&mut skinned, vertices, (influences, clusters), palette, instance_lod);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Options;

    /// The reference's own vertices pass the comparison; a vertex that is displaced, rotated or mirrored fails
    /// it.
    #[test]
    fn vertices_that_go_astray_are_seen() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        for blend in [Blend::Linear, Blend::DualQuaternion] {
            let scene = Scene::new(&gpu, 3, SHAPES[3], blend).expect("made");
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
