//! Whole models with fewer triangles: all meshes are reduced together, as one surface, and every triangle keeps its mesh and
//! material.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3};
use relievo::InputError;
use relievo::asset::mesh::{smooth_normals, solved_tangents};
use relievo::asset::{Influences, Mesh, Model};
use relievo::ops::mesh::simplify::{Seams, Stopped, Surface};
use relievo::ops::skinning::at_rest;
use relievo::ops::skinning::attribute_weights::{NORMAL, TextureArea, shown_uv};

use crate::distance;
use crate::distance::{Distance, Triangles};
use crate::reduce::mesh::unique;
use crate::reduce::{Limits, Reduced, Reducer};

/// What normals of a reduced model are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Normals {
    /// Those of the model. They count in the cost. Edges that are hard in normals only do not hinder reducers: vertices that
    /// differ in nothing else are one for them, with the mean of their normals, and afterwards every corner gets the normal
    /// that is closest to those of the triangle from which its own comes. Where a reducer places a vertex anew,
    /// all corners have the normal that it gives. Triangles that were flat-shaded stay so: where no such normal is within 2.5° of the
    /// triangle's own, all of its corners get that.
    #[default]
    Carry,
    /// Computed again: the normalized sums of the normals of the triangles around each vertex, weighted by area. Hard edges
    /// are lost.
    ///
    /// **Decided**: the sum of B's equation 3.2 is over cross products of edges, B's definition of a triangle's normal
    /// (3.2.3), so that slivers count little. B's equation 3.1 needs unit normals, which would count equally here.
    Recompute,
}

/// A model with fewer triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedModel {
    /// The model at rest. Meshes without triangles are left out.
    pub model: Model,
    /// How far it is off, as the reducer estimates it; see [`Reduced::error`].
    pub estimate: f32,
    /// Why the reducer stopped.
    pub stopped: Stopped,
}

impl ReducedModel {
    /// Number of triangles of all meshes.
    pub fn triangles(&self) -> usize {
        self.model.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum()
    }

    /// Number of vertices of all meshes.
    pub fn vertices(&self) -> usize {
        self.model.meshes.iter().map(Mesh::vertices).sum()
    }

    /// The distance between the surfaces of `whole`, the model at rest before it was reduced, and this one, forward and
    /// backward ([`distance::distance`]).
    ///
    /// # Errors
    /// [`InputError`] for a model without triangles, and for options out of range.
    pub fn distance(
        &self,
        whole: &Model,
        options: &distance::DistanceOptions,
    ) -> Result<Distance, InputError> {
        let [from, to] = [whole, &self.model].map(joined);
        let [from, to] = [&from, &to].map(|(positions, indices)| Triangles { positions, indices });
        distance::distance(&from, &to, options)
    }
}

/// Positions and triangles of all meshes.
fn joined(model: &Model) -> (Vec<[f32; 3]>, Vec<u32>) {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for mesh in &model.meshes {
        let first = positions.len() as u32;
        indices.extend(mesh.indices.iter().map(|index| first + index));
        positions.extend_from_slice(&mesh.positions);
    }
    (positions, indices)
}

/// Reduces a model to several limits, as it stands [at rest](at_rest()). All meshes together are one surface: where two of
/// them share a border, the reducer sees a seam, and what it guarantees for seams holds ([`Reducer`]).
///
/// Texture coordinates count on meshes whose material shows a texture, and on those without a material. Their seams are held, unless a [`Reducer::HalfEdge`] may cross them: normals are numbers 0 to 2 of
/// [`Surface::attributes`] if they are carried, and texture coordinates follow. Then they collapse at the price by which
/// the texture slips. Borders between meshes are always held.
///
/// Costs count positions; texture coordinates, scaled by the size of the texture's texels on each mesh; and normals if they
/// are carried. Tangents are computed again.
///
/// # Errors
/// [`InputError`] for a model that is not valid or has no triangles, as [`Reducer::reduce_each`] for the limits, and for
/// limits at which no triangle is left.
pub fn reduce_model(
    model: &Model,
    reducer: &Reducer,
    limits: &[Limits],
    normals: Normals,
) -> Result<Vec<ReducedModel>, InputError> {
    let whole = at_rest(model)?;
    let mut input = Input::new(&whole, normals);
    let mut reducer = *reducer;
    if let Reducer::HalfEdge { seams, .. } = &mut reducer
        && *seams != Seams::Held
    {
        if *seams == Seams::AllCrossed {
            *seams = Seams::Crossed { attributes: input.stride() };
        }
        input.add_meshes();
    }
    if input.indices.is_empty() {
        let bound = "must be at least 1";
        return Err(InputError::new("model.triangles.len", 0, bound));
    }
    let surface = Surface {
        poses: &input.poses,
        indices: &input.indices,
        attributes: &input.attributes,
        stride: input.stride(),
    };
    let reduced = reducer.reduce_each(&surface, limits)?;
    reduced.iter().enumerate().map(|(at, reduced)| input.output(at, reduced)).collect()
}

/// A model as one surface.
struct Input<'a> {
    model: &'a Model,
    normals: Normals,
    poses: [Vec<[f32; 3]>; 1],
    indices: Vec<u32>,
    attributes: Vec<f32>,
    /// For each vertex, its mesh, and the vertices there that it stands for: they differ in normals alone.
    vertices: Vec<(usize, Vec<u32>)>,
    /// For each mesh, the number of triangles before it.
    first: Vec<usize>,
    /// For each triangle, its mesh.
    meshes: Vec<u32>,
    /// For each mesh, the factor of texture coordinates.
    texture: Vec<f32>,
    /// Whether the last of each vertex' attributes is its mesh, which holds borders between meshes.
    has_meshes: bool,
}

impl<'a> Input<'a> {
    fn new(model: &'a Model, normals: Normals) -> Self {
        let positions = || {
            model.meshes.iter().flat_map(|mesh| &mesh.positions).map(|place| Vec3::from(*place).as_dvec3())
        };
        let low = positions().fold(DVec3::INFINITY, DVec3::min);
        let high = positions().fold(DVec3::NEG_INFINITY, DVec3::max);
        let mut input = Self {
            model,
            normals,
            poses: [Vec::new()],
            indices: Vec::new(),
            attributes: Vec::new(),
            vertices: Vec::new(),
            first: Vec::new(),
            meshes: Vec::new(),
            texture: model
                .meshes
                .iter()
                .map(|mesh| texture_factor(mesh, &shown_uv(model, mesh), low.distance(high)))
                .collect(),
            has_meshes: false,
        };
        for (at, mesh) in model.meshes.iter().enumerate() {
            input.add(at, mesh);
        }
        input
    }

    /// Numbers per vertex: normals if they are carried, texture coordinates, and the mesh if that counts.
    fn stride(&self) -> usize {
        self.uv_at() + 2 + usize::from(self.has_meshes)
    }

    /// The number of texture coordinates among the attributes.
    fn uv_at(&self) -> usize {
        if self.normals == Normals::Carry { 3 } else { 0 }
    }

    fn add_meshes(&mut self) {
        let own = self.attributes.chunks_exact(self.stride()).zip(&self.vertices);
        self.attributes =
            own.flat_map(|(own, (mesh, _))| own.iter().copied().chain([*mesh as f32])).collect();
        self.has_meshes = true;
    }

    fn add(&mut self, index: usize, mesh: &Mesh) {
        let mut known = HashMap::new();
        let mut slots = Vec::with_capacity(mesh.vertices());
        let places = mesh.positions.iter().copied().zip(shown_uv(self.model, mesh));
        for (vertex, (place, uv)) in (0_u32..).zip(places) {
            let slot = *known.entry((place.map(bits), uv.map(bits))).or_insert(self.vertices.len());
            if slot == self.vertices.len() {
                self.vertices.push((index, Vec::new()));
                self.poses[0].push(place);
            }
            self.vertices[slot].1.push(vertex);
            slots.push(slot as u32);
        }
        self.first.push(self.meshes.len());
        self.indices.extend(mesh.indices.iter().map(|vertex| slots[*vertex as usize]));
        self.meshes.resize(self.indices.len() / 3, index as u32);
        let from = self.attributes.len() / self.stride();
        for at in from..self.vertices.len() {
            self.add_attributes(at);
        }
    }

    fn add_attributes(&mut self, at: usize) {
        let (index, members) = &self.vertices[at];
        let mesh = &self.model.meshes[*index];
        if self.normals == Normals::Carry {
            let normal = mean(members.iter().map(|member| mesh.normals[*member as usize]));
            self.attributes.extend(normal.map(|x| NORMAL * x));
        }
        let scale = self.texture[*index];
        self.attributes.extend(mesh.uv[members[0] as usize].map(|x| scale * x));
    }

    /// The model of a result; `at` is the number of its limit.
    fn output(&self, at: usize, reduced: &Reduced) -> Result<ReducedModel, InputError> {
        let mut corners: Vec<Vec<Corner>> = vec![Vec::new(); self.model.meshes.len()];
        for (triangle, from) in reduced.indices.as_chunks::<3>().0.iter().zip(&reduced.triangles) {
            let mesh = self.meshes[*from as usize] as usize;
            let normal = self.normal_of(mesh, *from as usize);
            let own = triangle.map(|vertex| self.corner(vertex, normal, reduced));
            corners[mesh].extend(self.flat(mesh, *from as usize, own, reduced));
        }
        let meshes = self.model.meshes.iter().zip(corners).filter(|(_, corners)| !corners.is_empty());
        let meshes = meshes
            .map(|(mesh, corners)| self.mesh(mesh, &corners, reduced))
            .collect::<Result<Vec<_>, _>>()?;
        if meshes.is_empty() {
            let bound = "must leave at least one triangle";
            return Err(InputError::new(format!("limits[{at}]"), "0 triangles left", bound));
        }
        let model = Model { meshes, ..self.model.clone() };
        Ok(ReducedModel { model, estimate: reduced.error, stopped: reduced.stopped })
    }

    /// The sum of the normals of a triangle's corners in the model.
    fn normal_of(&self, mesh: usize, triangle: usize) -> Vec3 {
        let mesh_of = &self.model.meshes[mesh];
        let corners = &mesh_of.indices[3 * (triangle - self.first[mesh])..][..3];
        corners.iter().map(|corner| Vec3::from(mesh_of.normals[*corner as usize])).sum()
    }

    /// The corner of a triangle with this normal at a vertex of the result.
    fn corner(&self, vertex: u32, normal: Vec3, reduced: &Reduced) -> Corner {
        let from = reduced.vertices[vertex as usize] as usize;
        let (mesh, members) = &self.vertices[from];
        if self.normals == Normals::Recompute || !self.is_same(vertex, reduced) {
            return Corner { vertex, member: None, face: None };
        }
        let along = |member: &u32| normal.dot(Vec3::from(self.model.meshes[*mesh].normals[*member as usize]));
        // The first of equal ones.
        let best = members
            .iter()
            .copied()
            .reduce(|best, other| if along(&other) > along(&best) { other } else { best });
        Corner { vertex, member: best, face: None }
    }

    /// The corners of a triangle, with its own normal if it was flat-shaded and does not look so any more.
    fn flat(&self, mesh: usize, triangle: usize, corners: [Corner; 3], reduced: &Reduced) -> [Corner; 3] {
        let own = self.model.meshes[mesh].indices[3 * (triangle - self.first[mesh])..].first_chunk::<3>();
        let Some(own) = own.filter(|_| self.normals == Normals::Carry) else { return corners };
        let mesh = &self.model.meshes[mesh];
        let is_flat = |places: [[f32; 3]; 3], normals: [[f32; 3]; 3]| {
            let face = face_normal(places);
            normals.iter().all(|normal| face.dot(Vec3::from(*normal)) > FLAT)
        };
        let was = own.map(|corner| corner as usize);
        let places = corners.map(|corner| reduced.poses[0][corner.vertex as usize]);
        if !is_flat(was.map(|at| mesh.positions[at]), was.map(|at| mesh.normals[at]))
            || is_flat(places, corners.map(|corner| self.normal(&corner, reduced)))
        {
            return corners;
        }
        let face = Some(face_normal(places).to_array().map(f32::to_bits));
        corners.map(|corner| Corner { face, ..corner })
    }

    /// A mesh of `corners`, three a triangle, with a vertex for all that are equal.
    fn mesh(&self, mesh: &Mesh, corners: &[Corner], reduced: &Reduced) -> Result<Mesh, InputError> {
        let used = unique(corners.iter().copied());
        let slots: HashMap<Corner, u32> = used.iter().copied().zip(0..).collect();
        let indices: Vec<u32> = corners.iter().map(|corner| slots[corner]).collect();
        let positions: Vec<[f32; 3]> =
            used.iter().map(|corner| reduced.poses[0][corner.vertex as usize]).collect();
        let uv: Vec<[f32; 2]> = used.iter().map(|corner| self.uv(corner.vertex, reduced)).collect();
        let normals = match self.normals {
            Normals::Carry => used.iter().map(|corner| self.normal(corner, reduced)).collect(),
            Normals::Recompute => smooth_normals(&positions, &indices),
        };
        let tangents = solved_tangents(&positions, &normals, &uv, &indices)?;
        Ok(Mesh {
            influences: Influences::rigid(used.len()),
            positions,
            normals,
            tangents,
            uv,
            indices,
            name: mesh.name.clone(),
            double_sided: mesh.double_sided,
            material: mesh.material,
            ..Mesh::default()
        })
    }

    /// Whether a vertex of the result has the attributes of the vertex from which it comes.
    fn is_same(&self, vertex: u32, reduced: &Reduced) -> bool {
        let stride = self.stride();
        let from = reduced.vertices[vertex as usize] as usize;
        let now = &reduced.attributes[stride * vertex as usize..][..stride];
        let before = &self.attributes[stride * from..][..stride];
        now.iter().zip(before).all(|(now, before)| bits(*now) == bits(*before))
    }

    fn uv(&self, vertex: u32, reduced: &Reduced) -> [f32; 2] {
        let (mesh, members) = &self.vertices[reduced.vertices[vertex as usize] as usize];
        let scale = self.texture[*mesh];
        if scale == 0.0 || self.is_same(vertex, reduced) {
            return self.model.meshes[*mesh].uv[members[0] as usize];
        }
        let at = self.stride() * vertex as usize + self.uv_at();
        [reduced.attributes[at] / scale, reduced.attributes[at + 1] / scale]
    }

    fn normal(&self, corner: &Corner, reduced: &Reduced) -> [f32; 3] {
        let (mesh, members) = &self.vertices[reduced.vertices[corner.vertex as usize] as usize];
        let own = |member: u32| self.model.meshes[*mesh].normals[member as usize];
        if let Some(face) = corner.face {
            return face.map(f32::from_bits);
        }
        let Some(member) = corner.member else {
            let scaled = Vec3::from_slice(&reduced.attributes[self.stride() * corner.vertex as usize..]);
            let unit = scaled.as_dvec3().try_normalize();
            return unit.map_or_else(|| own(members[0]), |normal| normal.as_vec3().to_array());
        };
        own(member)
    }
}

/// A corner of a reduced mesh: a vertex of the result, and what gives the normal: a vertex of the model, or the triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Corner {
    vertex: u32,
    member: Option<u32>,
    /// The bits of the normal of a triangle that is flat-shaded.
    face: Option<[u32; 3]>,
}

/// The cosine of the angle up to which normals make a triangle look flat: 2.5°.
const FLAT: f32 = 0.999;

/// The unit normal of a triangle; 0 if it has no area.
fn face_normal(places: [[f32; 3]; 3]) -> Vec3 {
    let [a, b, c] = places.map(Vec3::from);
    (b - a).cross(c - a).normalize_or_zero()
}

/// The normalized sum of normals; the first of them where they cancel.
fn mean(normals: impl Iterator<Item = [f32; 3]> + Clone) -> [f32; 3] {
    let first = normals.clone().next().unwrap_or_default();
    if normals.clone().all(|normal| normal == first) {
        return first;
    }
    let sum: DVec3 = normals.map(|normal| Vec3::from(normal).as_dvec3()).sum();
    sum.try_normalize().map_or(first, |normal| normal.as_vec3().to_array())
}

fn bits(number: f32) -> u32 {
    // −0 is 0.
    (number + 0.0).to_bits()
}

/// The factor of a mesh's texture coordinates in a model of this size.
fn texture_factor(mesh: &Mesh, uv: &[[f32; 2]], size: f64) -> f32 {
    let mut area = TextureArea::default();
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let place = |corner: u32| DVec3::from(mesh.positions[corner as usize].map(f64::from));
        let uv = |corner: u32| DVec2::from(uv[corner as usize].map(f64::from));
        area.add(triangle.map(place), triangle.map(uv));
    }
    area.factor(size)
}
