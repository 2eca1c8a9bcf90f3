//! Computes missing tangents of meshes by MikkTSpace, as section 3.7.2.1 of glTF 2.0 requires. If the corners of a vertex have
//! different tangents, for example where texture coordinates are mirrored, the vertex is duplicated for each tangent.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};

use crate::InputError;
use crate::asset::mesh::Mesh;
use crate::asset::tangents::{TangentMesh as Surface, tangents};

/// Largest number of triangles around a vertex for which MikkTSpace is used. MikkTSpace visits these triangles by recursion,
/// and its time grows with the square of their number. A surface with more triangles around a vertex gets the tangents of
/// `relievo::ops::surface::tangent`.
const MAX_AROUND: u32 = 1024;

/// The tangents of a surface, and the vertices that were duplicated for them.
pub struct Tangents {
    /// Tangents in this crate's handedness: one per original vertex, then one per copy.
    pub tangents: Vec<[f32; 4]>,
    /// Three vertex indices per triangle. Copies are numbered after the original vertices.
    pub indices: Vec<u32>,
    /// For each copy, the original vertex. The copy differs only in the tangent.
    pub copied: Vec<u32>,
}

/// Computes one tangent per vertex with the solver of `relievo::ops::surface::tangent`. No vertex is duplicated. This is the
/// fallback where MikkTSpace cannot be used.
///
/// # Errors
/// [`InputError`] for coordinates out of range, and for indices of vertices that do not exist.
pub fn solved(surface: &Surface<'_>) -> Result<Tangents, InputError> {
    let indices = surface.indices.to_vec();
    Ok(Tangents { tangents: tangents(surface)?, indices, copied: Vec::new() })
}

/// Computes tangents by MikkTSpace. A vertex gets the tangent of [`solved`] if none of its triangles has an area both in space
/// and in texture space.
///
/// # Errors
/// The errors of [`solved`].
pub fn generated(surface: &Surface<'_>) -> Result<Tangents, InputError> {
    let mut found = solved(surface)?;
    let mut faces = Faces::new(surface);
    if faces.is_crowded() || generate_tangents(&mut faces).is_err() {
        return Ok(found);
    }
    let mut is_known = vec![false; surface.positions.len()];
    let mut copies = HashMap::new();
    for (at, tangent) in faces.corners().zip(&faces.tangents) {
        let Some(tangent) = *tangent else { continue };
        let vertex = found.indices[at];
        let known = &mut found.tangents[vertex as usize];
        if !std::mem::replace(&mut is_known[vertex as usize], true) {
            *known = tangent;
        } else if *known != tangent {
            found.indices[at] = *copies.entry((vertex, tangent.map(f32::to_bits))).or_insert_with(|| {
                found.tangents.push(tangent);
                found.copied.push(vertex);
                (found.tangents.len() - 1) as u32
            });
        }
    }
    Ok(found)
}

impl Tangents {
    /// Sets the tangents and triangles of a mesh, and appends the duplicated vertices.
    pub fn apply(self, mesh: &mut Mesh) {
        let Self { tangents, indices, copied } = self;
        for vertex in copied {
            let (at, copy) = (vertex as usize, mesh.positions.len() as u32);
            mesh.positions.push(mesh.positions[at]);
            mesh.normals.push(mesh.normals[at]);
            mesh.uv.push(mesh.uv[at]);
            mesh.second_uv.extend(mesh.second_uv.get(at).copied());
            mesh.colors.extend(mesh.colors.get(at).copied());
            mesh.influences.repeat(at);
            mesh.targets.iter_mut().for_each(|target| target.repeat(vertex, copy));
        }
        (mesh.tangents, mesh.indices) = (tangents, indices);
    }
}

/// Triangles whose three corners have different positions. Other triangles would slow MikkTSpace down without changing the
/// result.
struct Faces<'a> {
    surface: &'a Surface<'a>,
    /// For each triangle, the position of its first corner in the index list.
    first: Vec<usize>,
    /// For each triangle corner, the tangent that MikkTSpace found, if any.
    tangents: Vec<Option<[f32; 4]>>,
}

impl<'a> Faces<'a> {
    fn new(surface: &'a Surface<'a>) -> Self {
        let is_apart = |first: &usize| {
            let [a, b, c] =
                [0, 1, 2].map(|corner| surface.positions[surface.indices[first + corner] as usize]);
            a != b && b != c && c != a
        };
        let first: Vec<usize> = (0..surface.indices.len()).step_by(3).filter(is_apart).collect();
        let tangents = vec![None; 3 * first.len()];
        Self { surface, first, tangents }
    }

    /// Positions of the triangles' corners in the index list.
    fn corners(&self) -> impl Iterator<Item = usize> {
        self.first.iter().flat_map(|first| *first..first + 3)
    }

    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.surface.indices[self.first[face] + corner] as usize
    }

    /// Whether more than [`MAX_AROUND`] triangles meet at some vertex.
    fn is_crowded(&self) -> bool {
        let Surface { positions, normals, uv, indices } = self.surface;
        let mut around: HashMap<_, u32> = HashMap::new();
        self.corners().any(|corner| {
            let vertex = indices[corner] as usize;
            let place = (bits(positions[vertex]), bits(normals[vertex]), bits(uv[vertex]));
            let count = around.entry(place).or_default();
            *count += 1;
            *count > MAX_AROUND
        })
    }
}

/// Bit patterns of the components. Equal values give equal bits, even −0 and +0.
fn bits<const N: usize>(vector: [f32; N]) -> [u32; N] {
    one_zero(vector).map(f32::to_bits)
}

fn one_zero<const N: usize>(vector: [f32; N]) -> [f32; N] {
    vector.map(|number| number + 0.0)
}

/// Square root and arc cosine with the same results on every machine.
struct Libm;

impl Ops for Libm {
    fn sqrt(x: f32) -> f32 {
        libm::sqrtf(x)
    }

    fn acos(x: f32) -> f32 {
        libm::acos(f64::from(x)) as f32
    }
}

impl Geometry<Libm> for Faces<'_> {
    fn num_faces(&self) -> usize {
        self.first.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        one_zero(self.surface.positions[self.vertex(face, corner)])
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        one_zero(self.surface.normals[self.vertex(face, corner)])
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        one_zero(self.surface.uv[self.vertex(face, corner)])
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        // The bitangents of MikkTSpace and of this crate point down the image; glTF's bitangent points up.
        let tangent = space.map(|space| space.tangent_encoded());
        // A tangent is unusable if no triangle around the vertex has an area, or if numbers were too large or too small.
        let length = |[x, y, z, _]: &[f32; 4]| x * x + y * y + z * z;
        self.tangents[3 * face + corner] =
            tangent.filter(|tangent| (length(tangent) - 1.0).abs() < 1e-3).map(one_zero);
    }
}
