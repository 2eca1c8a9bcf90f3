//! Computes tangent frames of meshes in f64. They are the import's fallback, and the reference for
//! `kernels/surface/tangent.wgsl`. `relievo::ops::surface::tangent` defines tangent frames.

use glam::{DVec2, DVec3};

use super::indices::check_triangles;
use crate::InputError;

/// A triangle contributes nothing if its area, its tangent or its area in uv is no larger than this. Before the measurement, the
/// triangle is scaled to a box of edge 1, and its uv coordinates to a square of edge 1, u and v separately. Rounding errors are
/// at most a sixteenth of this value. They rotate a tangent of this length by less than four degrees.
pub const DEGENERATE: f32 = 1.0 / 16384.0;

/// Threshold of two sums at a vertex, as a fraction of the sum of weights. A sum of tangents counts as 0 if its component
/// orthogonal to the normal is no longer than the threshold. The handedness is -1 if the sum of handedness values is below the
/// negative threshold.
pub const VANISHING: f32 = 1.0 / 64.0;

/// Bits of the f32 2⁻¹⁰⁰. A normal whose components are all smaller counts as a vector without direction.
pub const LEAST_BITS: u32 = 0x0d80_0000;

/// Bits of the f32 2¹⁰⁰. A normal with a larger component counts as a vector without direction.
pub const LARGEST_BITS: u32 = 0x7180_0000;

/// Largest allowed absolute value of a component of positions and texture coordinates.
pub const COORDINATE_LIMIT: f32 = 1e18;

/// Largest allowed difference, on any device, between a component of a tangent and the same component of the reference. The
/// bound applies to a vertex of sensitivity 1 ([`TangentFrame::sensitivity`]). For other vertices, the bound is multiplied by
/// the sensitivity.
///
/// `docs/rounding-bounds.md` has the derivation.
pub const TANGENT_BOUND: f32 = 1e-5;

/// A triangle mesh with normals and texture coordinates.
#[derive(Debug, Clone, Copy)]
pub struct TangentMesh<'a> {
    /// Positions in any unit. Components are finite and at most [`COORDINATE_LIMIT`] in absolute value.
    pub positions: &'a [[f32; 3]],
    /// One normal per vertex, of any length.
    pub normals: &'a [[f32; 3]],
    /// Texture coordinates per vertex. Components are finite and at most [`COORDINATE_LIMIT`] in absolute value.
    pub uv: &'a [[f32; 2]],
    /// Three vertex indices per triangle, counter-clockwise seen from the side to which normals point.
    pub indices: &'a [u32],
}

impl TangentMesh<'_> {
    /// Checks lengths, indices and coordinates.
    ///
    /// # Errors
    /// [`InputError`] that names the wrong field, with its index.
    pub fn validate(&self) -> Result<(), InputError> {
        let vertices = self.positions.len();
        InputError::check_len("normals", self.normals.len(), vertices, "a position")?;
        InputError::check_len("uv", self.uv.len(), vertices, "a position")?;
        for (field, len) in [("positions.len", vertices), ("indices.len", self.indices.len())] {
            // The last offset of the adjacency is the number of corners, and offsets are u32.
            InputError::check_most(field, len, u32::MAX as usize)?;
        }
        in_range("positions", self.positions)?;
        in_range("uv", self.uv)?;
        check_triangles("indices", self.indices, vertices)
    }
}

/// Refuses components that are not finite or exceed [`COORDINATE_LIMIT`] in absolute value. `path` names the list of vectors.
pub(crate) fn in_range(path: &str, vectors: &[impl AsRef<[f32]>]) -> Result<(), InputError> {
    (vectors.iter().enumerate())
        .try_for_each(|(at, vector)| numbers_in_range(|| format!("{path}[{at}]"), vector.as_ref()))
}

/// Refuses numbers of one list that are not finite or exceed [`COORDINATE_LIMIT`] in absolute value. `path` names the list.
pub(super) fn numbers_in_range(path: impl Fn() -> String, numbers: &[f32]) -> Result<(), InputError> {
    // NaN is refused, too, because comparisons with it are false.
    let is_within = |value: &f32| value.abs() <= COORDINATE_LIMIT;
    match numbers.iter().position(|value| !is_within(value)) {
        None => Ok(()),
        Some(at) => {
            let bound = format!("must be finite and within ±{COORDINATE_LIMIT:e}");
            Err(InputError::new(format!("{}[{at}]", path()), numbers[at], bound))
        }
    }
}

/// For each vertex, the triangle corners that meet there. The reference and the kernel add the contributions of the corners in
/// this order, so that all runs agree.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adjacency {
    /// Start of each vertex's range in `corners`; one more entry holds the total.
    pub offsets: Vec<u32>,
    /// Positions in the mesh's index list, in ascending order for each vertex.
    pub corners: Vec<u32>,
}

impl Adjacency {
    /// Builds the adjacency of `vertices` vertices. All `indices` must be valid.
    #[doc(hidden)]
    pub fn new(vertices: usize, indices: &[u32]) -> Self {
        let mut offsets = vec![0; vertices + 1];
        for index in indices {
            offsets[*index as usize + 1] += 1;
        }
        for vertex in 0..vertices {
            offsets[vertex + 1] += offsets[vertex];
        }
        let mut next = offsets.clone();
        let mut corners = vec![0; indices.len()];
        for (index, corner) in indices.iter().zip(0..) {
            let place = &mut next[*index as usize];
            corners[*place as usize] = corner;
            *place += 1;
        }
        Self { offsets, corners }
    }

    /// The corners at one vertex, as positions in the mesh's index list.
    pub fn at(&self, vertex: usize) -> &[u32] {
        &self.corners[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }
}

/// Lengths below this threshold, 2⁻¹⁰⁰, count as degenerate.
const LEAST: f64 = f32::from_bits(LEAST_BITS) as f64;

/// Machine epsilon of f32: distance between 1 and the next larger number.
const EPSILON: f64 = f32::EPSILON as f64;

/// A tangent frame, and its sensitivity to rounding in f32.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentFrame {
    /// Unit tangent x, y, z, orthogonal to the normal, and the handedness ±1 of the frame.
    pub tangent: [f32; 4],
    /// Factor of [`TANGENT_BOUND`] at this vertex, 1 or more. Infinite if rounding decides whether a triangle, or the sum over
    /// the vertex's triangles, is degenerate.
    pub sensitivity: f64,
}

/// Computes tangent and handedness of every vertex, as `relievo::ops::surface::tangent` defines them.
///
/// # Errors
/// The errors of [`TangentMesh::validate`].
pub fn tangents(mesh: &TangentMesh<'_>) -> Result<Vec<[f32; 4]>, InputError> {
    Ok(frames(mesh)?.into_iter().map(|frame| frame.tangent).collect())
}

/// Computes the tangent frame of every vertex, with its sensitivity to rounding. [`tangents`] returns the same tangents without
/// the sensitivity.
///
/// # Errors
/// The errors of [`TangentMesh::validate`].
pub fn frames(mesh: &TangentMesh<'_>) -> Result<Vec<TangentFrame>, InputError> {
    mesh.validate()?;
    let adjacency = Adjacency::new(mesh.positions.len(), mesh.indices);
    Ok((0..mesh.positions.len()).map(|vertex| frame(mesh, &adjacency, vertex)).collect())
}

#[derive(Debug, Clone, Copy, Default)]
struct Contribution {
    tangent: DVec3,
    weight: f64,
    handedness: f64,
    /// Sensitivity of the tangent (x) and of the handedness (y) to rounding.
    sensitivity: DVec2,
}

fn position(mesh: &TangentMesh<'_>, vertex: u32) -> DVec3 {
    DVec3::from_array(mesh.positions[vertex as usize].map(f64::from))
}

fn texture_coordinate(mesh: &TangentMesh<'_>, vertex: u32) -> DVec2 {
    DVec2::from_array(mesh.uv[vertex as usize].map(f64::from))
}

fn largest(vector: DVec3) -> f64 {
    let size = vector.abs();
    size.x.max(size.y).max(size.z)
}

fn unit(vector: DVec3) -> DVec3 {
    vector / vector.dot(vector).sqrt()
}

/// Contribution of one triangle to the frame of the vertex at `corner`.
fn contribution(mesh: &TangentMesh<'_>, corner: u32, normal: DVec3) -> Contribution {
    let first = corner - corner % 3;
    let [vertex, next, last] = [corner, first + (corner + 1) % 3, first + (corner + 2) % 3]
        .map(|corner| mesh.indices[corner as usize]);
    let mut a = position(mesh, next) - position(mesh, vertex);
    let mut b = position(mesh, last) - position(mesh, vertex);
    let size = largest(a).max(largest(b)).max(largest(b - a));
    let mut s = texture_coordinate(mesh, next) - texture_coordinate(mesh, vertex);
    let mut t = texture_coordinate(mesh, last) - texture_coordinate(mesh, vertex);
    let extent = s.abs().max(t.abs()).max((t - s).abs());
    let smallest = size.min(extent.x).min(extent.y);
    if smallest < LEAST {
        let sensitivity = DVec2::splat(undecided(smallest, LEAST, EPSILON * LEAST));
        return Contribution { sensitivity, ..Default::default() };
    }
    a /= size;
    b /= size;
    s /= extent;
    t /= extent;
    let area = s.x * t.y - t.x * s.y;
    let face = a.cross(b);
    let along = t.y * a - s.y * b;
    let degenerate = f64::from(DEGENERATE);
    let nearest = area.abs().min(face.length()).min(along.length());
    let sensitivity = DVec2::splat(undecided(nearest, degenerate, 32.0 * EPSILON));
    if area.abs() <= degenerate
        || face.dot(face) <= degenerate * degenerate
        || along.dot(along) <= degenerate * degenerate
    {
        return Contribution { sensitivity, ..Default::default() };
    }
    let weight = (unit(b) - unit(a)).length();
    let signed_weight = if area > 0.0 { weight } else { -weight };
    Contribution {
        tangent: unit(along) * signed_weight,
        weight,
        handedness: signed_weight * normal.dot(unit(face)),
        sensitivity: sensitivity + 1.0 + weight * (1.0 + 1.0 / DVec2::new(along.length(), face.length())),
    }
}

/// Returns infinity if `value` is so close to `threshold` that rounding decides the comparison; otherwise 0.
fn undecided(value: f64, threshold: f64, error: f64) -> f64 {
    if (value - threshold).abs() <= error { f64::INFINITY } else { 0.0 }
}

/// First vector of an orthonormal basis around a unit normal (Duff et al. 2017).
fn fallback(normal: DVec3, negative_z: bool) -> DVec3 {
    let side = if negative_z { -1.0 } else { 1.0 };
    let a = -1.0 / (side + normal.z);
    DVec3::new(1.0 + side * normal.x * normal.x * a, side * normal.x * normal.y * a, -side * normal.x)
}

fn frame(mesh: &TangentMesh<'_>, adjacency: &Adjacency, vertex: usize) -> TangentFrame {
    let bits = mesh.normals[vertex].map(f32::to_bits);
    let magnitude = bits.map(|bits| bits & 0x7fff_ffff);
    let largest_bits = magnitude[0].max(magnitude[1]).max(magnitude[2]);
    if !(LEAST_BITS..=LARGEST_BITS).contains(&largest_bits) {
        return TangentFrame { tangent: [1.0, 0.0, 0.0, 1.0], sensitivity: 1.0 };
    }
    let normal = DVec3::from_array(mesh.normals[vertex].map(f64::from));
    let normal = unit(normal / f64::from(f32::from_bits(largest_bits)));
    let mut sum = Contribution::default();
    let corners = adjacency.at(vertex);
    for corner in corners {
        let added = contribution(mesh, *corner, normal);
        sum.tangent += added.tangent;
        sum.weight += added.weight;
        sum.handedness += added.handedness;
        sum.sensitivity += added.sensitivity;
    }
    let flat = sum.tangent - normal * normal.dot(sum.tangent);
    let least = sum.weight * f64::from(VANISHING);
    // Adding n contributions causes n roundings. For every 32 roundings, the sum of the sensitivities is added once more.
    let sensitivity = sum.sensitivity * (1.0 + corners.len() as f64 / 32.0);
    let error = f64::from(TANGENT_BOUND) * sensitivity;
    let vanishing = if sum.weight > 0.0 { undecided(flat.length(), least, error.x) } else { 0.0 };
    if flat.dot(flat) <= least * least {
        let [x, y, z] = fallback(normal, bits[2] >> 31 == 1).to_array().map(|component| component as f32);
        let decided = sensitivity.x.is_finite() && vanishing == 0.0;
        return TangentFrame {
            tangent: [x, y, z, 1.0],
            sensitivity: if decided { 1.0 } else { f64::INFINITY },
        };
    }
    let tangent = unit(flat);
    let tangent = unit(tangent - normal * normal.dot(tangent));
    let [x, y, z] = tangent.to_array().map(|component| component as f32);
    let handedness = if sum.handedness < -least { -1.0 } else { 1.0 };
    let undecided = vanishing + undecided(sum.handedness, -least, error.y);
    TangentFrame { tangent: [x, y, z, handedness], sensitivity: sensitivity.x / flat.length() + undecided }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MESH: TangentMesh<'static> = TangentMesh {
        positions: &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        normals: &[[0.0, 0.0, 1.0]; 3],
        uv: &[[0.0; 2], [1.0, 0.0], [0.0, 1.0]],
        indices: &[0, 1, 2],
    };

    fn refused(mesh: &TangentMesh<'_>, field: &str, value: &str) {
        let error = mesh.validate().expect_err("refused");
        assert_eq!((error.path.as_str(), error.value.as_str()), (field, value));
    }

    #[test]
    fn meshes_are_checked_field_by_field() {
        assert_eq!(MESH.validate(), Ok(()));
        assert_eq!(TangentMesh { positions: &[], normals: &[], uv: &[], indices: &[] }.validate(), Ok(()));
        refused(&TangentMesh { normals: &MESH.normals[1..], ..MESH }, "normals.len", "2");
        refused(&TangentMesh { uv: &MESH.uv[..1], ..MESH }, "uv.len", "1");
        refused(&TangentMesh { indices: &[0, 1, 2, 0], ..MESH }, "indices.len", "4");
        refused(&TangentMesh { indices: &[0, 1, 3], ..MESH }, "indices[2]", "3");
        for (wrong, value) in [(f32::NAN, "NaN"), (f32::NEG_INFINITY, "-inf"), (2e18, "2000000000000000000")]
        {
            let mut positions = MESH.positions.to_vec();
            positions[1][2] = wrong;
            refused(&TangentMesh { positions: &positions, ..MESH }, "positions[1][2]", value);
            let mut uv = MESH.uv.to_vec();
            uv[2][0] = wrong;
            refused(&TangentMesh { uv: &uv, ..MESH }, "uv[2][0]", value);
        }
        let limits = [[COORDINATE_LIMIT, -COORDINATE_LIMIT, 0.0]; 3];
        let normals = [[f32::NAN, f32::INFINITY, 0.0]; 3];
        assert_eq!(TangentMesh { positions: &limits, normals: &normals, ..MESH }.validate(), Ok(()));
    }

    #[test]
    fn corners_ascend_at_each_vertex() {
        let adjacency = Adjacency::new(5, &[3, 0, 1, 1, 0, 4, 0, 0, 3]);
        assert_eq!(adjacency.offsets, [0, 4, 6, 6, 8, 9]);
        let corners: Vec<_> = (0..5).map(|vertex| adjacency.at(vertex).to_vec()).collect();
        assert_eq!(corners, [vec![1, 4, 6, 7], vec![2, 3], vec![], vec![0, 8], vec![5]]);
    }
}
