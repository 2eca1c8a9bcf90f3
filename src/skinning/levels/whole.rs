//! Meshes of a model that share borders, treated as one surface. Borders that are closed stay closed at every level.

mod shared;

use std::ops::Range;

use glam::Vec3;

use crate::asset::Model;
use crate::asset::mesh::Mesh;
use crate::asset::transform::Affine;
use crate::skinning::attribute_weights::shown_uv;
use crate::skinning::pose::{Moment, Pose, positions_of};
pub(super) use shared::{Shared, shared, sorted};

/// Several meshes of a model, with their vertices and triangles concatenated.
pub(super) struct Whole<'a> {
    model: &'a Model,
    /// Index of each mesh in the model.
    pub meshes: Vec<usize>,
    /// For each mesh, the index of its first vertex. One last entry has the number of all vertices.
    starts: Vec<u32>,
    /// For each vertex, its mesh as an index in [`Whole::meshes`].
    pub member: Vec<u32>,
    /// For each vertex, the vertex whose position it takes: a vertex of another mesh if both meet at a border,
    /// otherwise itself.
    pub shared: Vec<u32>,
    /// The triangles of all meshes, in the order of the meshes.
    pub indices: Vec<u32>,
    /// Texture coordinates for simplification ([`shown_uv`]).
    pub uv: Vec<[f32; 2]>,
    /// Normals of all vertices before skinning.
    pub normals: Vec<[f32; 3]>,
}

impl<'a> Whole<'a> {
    pub fn new(model: &'a Model, meshes: &[usize], borders: &Shared) -> Self {
        let mut starts = vec![0];
        for mesh in meshes {
            starts.push(starts[starts.len() - 1] + model.meshes[*mesh].vertices() as u32);
        }
        let members = || meshes.iter().map(|mesh| &model.meshes[*mesh]).zip(&starts);
        let start_of = |mesh: usize| meshes.iter().position(|other| *other == mesh).map(|at| starts[at]);
        let shared = (meshes.iter().zip(&starts)).flat_map(|(mesh, start)| {
            let own = (0..model.meshes[*mesh].vertices() as u32).map(move |vertex| (vertex, start + vertex));
            own.map(|(vertex, own)| match borders.get(&(*mesh, vertex)) {
                Some((other, vertex)) => start_of(*other).map_or(own, |start| start + vertex),
                None => own,
            })
        });
        let own = |(at, mesh): (u32, &Mesh)| std::iter::repeat_n(at, mesh.vertices());
        Self {
            model,
            meshes: meshes.to_vec(),
            member: (0..).zip(members().map(|(mesh, _)| mesh)).flat_map(own).collect(),
            shared: shared.collect(),
            indices: members()
                .flat_map(|(mesh, start)| mesh.indices.iter().map(move |at| start + at))
                .collect(),
            uv: members().flat_map(|(mesh, _)| shown_uv(model, mesh)).collect(),
            normals: members().flat_map(|(mesh, _)| &mesh.normals).copied().collect(),
            starts,
        }
    }

    /// Number of vertices of all meshes.
    pub fn vertices(&self) -> usize {
        self.member.len()
    }

    /// The range of vertices of one mesh.
    pub fn range(&self, member: usize) -> Range<usize> {
        self.starts[member] as usize..self.starts[member + 1] as usize
    }

    /// The mesh that a triangle belongs to, as an index in [`Whole::meshes`].
    pub fn member_of(&self, triangle: &[u32]) -> u32 {
        self.member[triangle[0] as usize]
    }

    /// The triangles in `indices` that belong to one mesh. The result uses the mesh's own vertex indices.
    pub fn own(&self, indices: &[u32], member: usize) -> Vec<u32> {
        let of_member = |triangle: &&[u32]| self.member_of(triangle) as usize == member;
        let own = indices.chunks_exact(3).filter(of_member).flatten();
        own.map(|vertex| vertex - self.starts[member]).collect()
    }

    /// The index of a vertex in its own mesh.
    pub fn local(&self, vertex: u32) -> u32 {
        vertex - self.starts[self.member[vertex as usize] as usize]
    }

    fn all<T>(&self, of_mesh: impl Fn(&Mesh) -> Vec<T>) -> Vec<T> {
        self.meshes.iter().flat_map(|mesh| of_mesh(&self.model.meshes[*mesh])).collect()
    }

    /// The positions of all vertices at a moment, in multiples of `unit`.
    pub fn points(&self, moment: Moment, unit: f32) -> Vec<Vec3> {
        let points = |mesh: &Mesh| Pose::new(self.model, mesh, moment).positions(mesh);
        self.all(points).into_iter().map(|point| point / unit).collect()
    }

    /// The positions of some vertices at a moment, in multiples of `unit`. `bones` are the bones' model-space matrices
    /// at that moment. `vertices` has one list per mesh, in the mesh's own vertex indices.
    pub fn some_points(
        &self,
        moment: Moment,
        bones: &[Affine],
        vertices: &[Vec<u32>],
        unit: f32,
    ) -> Vec<Vec3> {
        let mut points = Vec::with_capacity(vertices.iter().map(Vec::len).sum());
        for (mesh, vertices) in self.meshes.iter().zip(vertices).filter(|(_, some)| !some.is_empty()) {
            let own = positions_of(self.model, &self.model.meshes[*mesh], moment, bones, vertices);
            points.extend(own.into_iter().map(|point| point / unit));
        }
        points
    }

    /// The positions of all vertices at a moment. Where meshes share a border, their positions are equal to the bit.
    pub fn joined_points(&self, moment: Moment) -> Vec<[f32; 3]> {
        let points = self.points(moment, 1.0);
        self.shared.iter().map(|vertex| points[*vertex as usize].to_array()).collect()
    }

    /// The normals of all vertices at a moment, in the model's space.
    pub fn posed_normals(&self, moment: Moment) -> Vec<[f32; 3]> {
        self.all(|mesh| Pose::new(self.model, mesh, moment).normals(mesh))
    }
}
