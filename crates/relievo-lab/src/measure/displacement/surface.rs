//! The surfaces of a model that are compared: the triangles of each primitive, all of them and those drawn, and samples.

use std::collections::BTreeSet;

use glam::DVec3;
use relievo::asset::{Mesh, Model};
use relievo::ops::lod::OBJECT_LISTS;
use relievo::ops::skinning::clusters::Clusters;
use relievo::ops::skinning::merged::Merged;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::{Blend, InstanceLod, Vertex};
use relievo::scene::mesh::{at_rest_merged, coarsest_levels, moving_merged};
use relievo::scene::query::{DrawnAs, DrawnInstance};
use relievo::scene::{ClipTime, ObjectId, Scene, View};
use relievo::{Error, InputError, ops::animation};

use crate::distance::tree::Tree;

/// An object of a scene, and the model from which it was made.
pub(super) struct Watched {
    pub object: ObjectId,
    pub primitives: Vec<Primitive>,
    merged: Merged,
    is_character: bool,
    /// For each merged mesh, the order of its vertices on the device.
    clusters: Vec<Clusters>,
}

/// A primitive of the model, as a part of a merged mesh. In a model that was joined from levels, all primitives of a merged mesh
/// count as one, since each level has primitives of its own.
pub(super) struct Primitive {
    /// Index of the merged mesh.
    pub mesh: usize,
    /// Index of the model's own mesh; `None` for all that are merged.
    source: Option<u32>,
    /// All of its triangles.
    pub full: Surface,
    /// For each list of the object, the triangles that its instances are drawn with, once they are known.
    pub lists: Vec<Option<Surface>>,
}

/// Triangles, and samples of them.
#[derive(Default)]
pub(super) struct Surface {
    pub triangles: Vec<[u32; 3]>,
    /// The vertices that triangles use, in ascending order, then the middles of edges and of triangles.
    pub samples: Vec<Sample>,
}

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Sample {
    /// A vertex.
    Vertex(u32),
    /// The middle of an edge.
    Edge([u32; 2]),
    /// The middle of a triangle.
    Triangle([u32; 3]),
}

impl Watched {
    pub fn new(scene: &Scene, object: ObjectId, model: &Model) -> Result<Self, InputError> {
        let is_character = scene.is_character(object)?;
        let merged = if is_character { moving_merged(model)? } else { at_rest_merged(model)?.0 };
        let primitives = (0..merged.model.meshes.len()).flat_map(|mesh| primitives(&merged, mesh)).collect();
        let Model { meshes, skins, skeleton, .. } = &merged.model;
        let all = meshes.iter().map(|mesh| Clusters::new(mesh, skins, skeleton));
        let clusters = all.collect::<Result<_, _>>()?;
        Ok(Self { object, is_character, primitives, merged, clusters })
    }

    /// Reads the triangles that a view draws of the instances of a list, unless they are known.
    pub fn read_list(&mut self, scene: &Scene, view: &View, list: u32) -> Result<(), Error> {
        if self.primitives.iter().all(|primitive| primitive.lists[list as usize].is_some()) {
            return Ok(());
        }
        let drawn = scene.drawn_triangles(view, self.object, list)?;
        for Primitive { mesh, source, lists, .. } in &mut self.primitives {
            let (order, sources) = (&self.clusters[*mesh].order, &self.merged.sources[*mesh]);
            let all = drawn[*mesh].iter().map(|slots| slots.map(|slot| order[slot as usize]));
            let own = all.filter(|corners| is_of(*source, sources[corners[0] as usize]));
            lists[list as usize] = Some(Surface::new(own.collect()));
        }
        Ok(())
    }

    /// The vertices that are drawn of some instances, mesh by mesh, `None` for those without a page: a list for each instance
    /// of a character, and one for all instances of a mesh.
    pub fn vertices(
        &self,
        scene: &Scene,
        instances: &[DrawnInstance],
    ) -> Result<Vec<Vec<Vec<Option<Vertex>>>>, Error> {
        let handles: Vec<_> = instances.iter().map(|instance| instance.instance).collect();
        scene.drawn_vertices(self.object, &handles)
    }

    /// The positions of all vertices at full detail in the model's space, mesh by mesh, by the CPU references.
    pub fn posed(&self, time: Option<ClipTime>) -> Vec<Vec<DVec3>> {
        let model = &self.merged.model;
        let Some(ClipTime { clip, seconds }) = time else {
            return model.meshes.iter().map(|mesh| precise(&mesh.positions)).collect();
        };
        let pose = animation::Pose::on_host(&model.skeleton, &model.clips[clip], seconds);
        let skinned = |mesh: &Mesh| {
            let palette = palette_for(&model.skins[mesh.skin], &pose.model_matrices, Blend::Linear);
            let vertices = morph(mesh, &mesh.weights_at(clip, seconds));
            let all = skin(&vertices, &mesh.influences, &palette, InstanceLod::FULL);
            precise(&all.iter().map(|vertex| vertex.position).collect::<Vec<_>>())
        };
        model.meshes.iter().map(skinned).collect()
    }

    /// The positions of the vertices that are drawn of an instance of a list, in the model's space, mesh by mesh; `skinned` are
    /// those that the scene tells. Vertices that are not drawn are not numbers.
    pub fn drawn(&self, skinned: &[Vec<Option<Vertex>>], drawn: &DrawnAs) -> Result<Vec<Vec<DVec3>>, Error> {
        let in_order = |(clusters, vertices): (&Clusters, &Vec<Option<Vertex>>)| match self.is_character {
            true => vertices.clone(),
            false => clusters.in_mesh_order(vertices),
        };
        let skinned: Vec<_> = self.clusters.iter().zip(skinned).map(in_order).collect();
        for Primitive { mesh, lists, .. } in &self.primitives {
            let mut drawn =
                lists[drawn.list as usize].iter().flat_map(|surface| surface.triangles.as_flattened());
            if let Some(vertex) = drawn.find(|vertex| skinned[*mesh][**vertex as usize].is_none()) {
                let bound = "must lie in a page, since it is drawn";
                return Err(
                    InputError::new(format!("meshes[{mesh}].vertices[{vertex}]"), "none", bound).into()
                );
            }
        }
        let position = |vertex: &Option<Vertex>| {
            vertex.map_or(DVec3::NAN, |vertex| glam::Vec3::from(vertex.position).as_dvec3())
        };
        let skinned = skinned.iter().map(|mesh| mesh.iter().map(position).collect());
        let moves = self.moves(drawn);
        let all = self.merged.model.meshes.iter().zip(&moves).zip(skinned);
        Ok(all.map(|((mesh, moves), still)| moved(mesh, moves, still, drawn.way)).collect())
    }

    /// For each merged mesh, which of its vertices are on their way to others; nothing if none is.
    pub fn moves(&self, drawn: &DrawnAs) -> Vec<Vec<bool>> {
        let errors = &self.merged.errors;
        let of_mesh = |mesh: &Mesh| match drawn.way > 0.0 && !mesh.partners.is_empty() {
            true => coarsest_levels(mesh, errors).iter().map(|level| *level == drawn.list / 2).collect(),
            false => Vec::new(),
        };
        self.merged.model.meshes.iter().map(of_mesh).collect()
    }
}

/// The vertices of a mesh, of which those that are on their way have moved towards their partners.
fn moved(mesh: &Mesh, moves: &[bool], still: Vec<DVec3>, way: f64) -> Vec<DVec3> {
    if moves.is_empty() {
        return still;
    }
    let all = still.iter().zip(&mesh.partners).zip(moves);
    all.map(|((position, partner), moves)| match moves {
        true => position.lerp(still[*partner as usize], way),
        false => *position,
    })
    .collect()
}

fn precise(positions: &[[f32; 3]]) -> Vec<DVec3> {
    positions.iter().map(|position| glam::Vec3::from(*position).as_dvec3()).collect()
}

/// Whether a mesh is a primitive's source.
fn is_of(source: Option<u32>, mesh: u32) -> bool {
    source.is_none_or(|source| source == mesh)
}

/// The primitives of a merged mesh.
fn primitives(merged: &Merged, index: usize) -> Vec<Primitive> {
    let (mesh, sources) = (&merged.model.meshes[index], &merged.sources[index]);
    let all: BTreeSet<u32> = sources.iter().copied().collect();
    let fine: BTreeSet<u32> = mesh.indices.iter().map(|vertex| sources[*vertex as usize]).collect();
    let all: Vec<Option<u32>> = match all == fine {
        true => all.into_iter().map(Some).collect(),
        false => vec![None],
    };
    let full = |source: Option<u32>| {
        let all = mesh.indices.as_chunks::<3>().0.iter();
        Surface::new(all.filter(|corners| is_of(source, sources[corners[0] as usize])).copied().collect())
    };
    let none = || (0..OBJECT_LISTS).map(|_| None).collect();
    let primitive = |source| Primitive { mesh: index, source, full: full(source), lists: none() };
    all.into_iter().map(primitive).collect()
}

impl Surface {
    fn new(triangles: Vec<[u32; 3]>) -> Self {
        let edges = |corners: &[u32; 3]| {
            [[0, 1], [1, 2], [2, 0]].map(|edge| {
                let [a, b] = edge.map(|at: usize| corners[at]);
                Sample::Edge([a.min(b), a.max(b)])
            })
        };
        let vertices = triangles.as_flattened().iter().map(|vertex| Sample::Vertex(*vertex));
        let mut samples: Vec<Sample> = vertices.chain(triangles.iter().flat_map(edges)).collect();
        samples.extend(triangles.iter().map(|corners| Sample::Triangle(*corners)));
        samples.sort_unstable();
        samples.dedup();
        Self { triangles, samples }
    }

    /// Whether a triangle has a vertex, an edge or a corner set.
    pub fn has(&self, sample: &Sample) -> bool {
        self.samples.binary_search(sample).is_ok()
    }

    /// The triangles between points.
    pub fn tree(&self, points: &[DVec3]) -> Option<Tree> {
        let corners = self.triangles.iter().map(|corners| corners.map(|vertex| points[vertex as usize]));
        (!self.triangles.is_empty()).then(|| Tree::new(&corners.collect::<Vec<_>>()))
    }
}

impl Sample {
    /// Its position, given those of vertices.
    pub fn position(&self, points: &[DVec3]) -> DVec3 {
        let point = |vertex: &u32| points[*vertex as usize];
        match self {
            Self::Vertex(vertex) => point(vertex),
            Self::Edge(ends) => ends.iter().map(point).sum::<DVec3>() / 2.0,
            Self::Triangle(corners) => corners.iter().map(point).sum::<DVec3>() / 3.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_eleven_samples() {
        let square = Surface::new(vec![[0, 1, 2], [2, 1, 3]]);
        assert_eq!(square.samples.len(), 4 + 5 + 2);
        assert!(square.has(&Sample::Vertex(3)) && !square.has(&Sample::Vertex(4)));
        assert!(square.has(&Sample::Edge([1, 2])) && !square.has(&Sample::Edge([0, 3])));
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE].map(|point| 6.0 * point);
        assert_eq!(Sample::Edge([1, 2]).position(&points), DVec3::new(3.0, 3.0, 0.0));
        assert_eq!(Sample::Triangle([0, 1, 2]).position(&points), DVec3::new(2.0, 2.0, 0.0));
    }
}
