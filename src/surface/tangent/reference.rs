//! Tangent frames of meshes: twin of `kernels/surface/tangent.wgsl`, in f64.

use glam::{DVec2, DVec3};

use crate::InputError;
use crate::surface::tangent::{Adjacency, DEGENERATE, Mesh, TANGENT_BOUND, VANISHING};

/// 2⁻¹⁰⁰, its bits and those of 2¹⁰⁰.
const LEAST: f64 = 7.888_609_052_210_118e-31;
const LEAST_BITS: u32 = 0x0d80_0000;
const LARGEST_BITS: u32 = 0x7180_0000;

/// A unit of the last place of numbers around 1.
const EPSILON: f64 = f32::EPSILON as f64;

/// A tangent frame, and how well f32 can tell it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Unit tangent x, y, z, orthogonal to the normal; handedness ±1.
    pub tangent: [f32; 4],
    /// By how much [`TANGENT_BOUND`] must be multiplied at this vertex: 1 or more. Infinite where rounding decides
    /// whether something counts as degenerate.
    pub sensitivity: f64,
}

/// The tangent and handedness of every vertex. See [`crate::surface::tangent`].
///
/// # Errors
/// [`InputError`] as [`Mesh::validate`].
pub fn tangents(mesh: &Mesh<'_>) -> Result<Vec<[f32; 4]>, InputError> {
    Ok(frames(mesh)?.into_iter().map(|frame| frame.tangent).collect())
}

/// As [`tangents`], with the sensitivity of each.
///
/// # Errors
/// [`InputError`] as [`Mesh::validate`].
pub fn frames(mesh: &Mesh<'_>) -> Result<Vec<Frame>, InputError> {
    mesh.validate()?;
    let adjacency = Adjacency::new(mesh.positions.len(), mesh.indices);
    Ok((0..mesh.positions.len()).map(|vertex| frame(mesh, &adjacency, vertex)).collect())
}

#[derive(Debug, Clone, Copy, Default)]
struct Contribution {
    tangent: DVec3,
    weight: f64,
    handedness: f64,
    /// Of the tangent and of the handedness.
    sensitivity: DVec2,
}

fn position(mesh: &Mesh<'_>, vertex: u32) -> DVec3 {
    DVec3::from_array(mesh.positions[vertex as usize].map(f64::from))
}

fn texture_coordinate(mesh: &Mesh<'_>, vertex: u32) -> DVec2 {
    DVec2::from_array(mesh.uv[vertex as usize].map(f64::from))
}

fn largest(vector: DVec3) -> f64 {
    let size = vector.abs();
    size.x.max(size.y).max(size.z)
}

fn unit(vector: DVec3) -> DVec3 {
    vector / vector.dot(vector).sqrt()
}

/// What the triangle with this corner adds at the corner's vertex.
fn contribution(mesh: &Mesh<'_>, corner: u32, normal: DVec3) -> Contribution {
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

/// Infinite where `value` lies so near to a threshold that rounding decides.
fn undecided(value: f64, threshold: f64, error: f64) -> f64 {
    if (value - threshold).abs() <= error { f64::INFINITY } else { 0.0 }
}

/// The first vector of the basis of Duff et al. 2017, from a unit normal.
fn fallback(normal: DVec3, negative_z: bool) -> DVec3 {
    let side = if negative_z { -1.0 } else { 1.0 };
    let a = -1.0 / (side + normal.z);
    DVec3::new(1.0 + side * normal.x * normal.x * a, side * normal.x * normal.y * a, -side * normal.x)
}

fn frame(mesh: &Mesh<'_>, adjacency: &Adjacency, vertex: usize) -> Frame {
    let bits = mesh.normals[vertex].map(f32::to_bits);
    let magnitude = bits.map(|bits| bits & 0x7fff_ffff);
    let largest_bits = magnitude[0].max(magnitude[1]).max(magnitude[2]);
    if !(LEAST_BITS..=LARGEST_BITS).contains(&largest_bits) {
        return Frame { tangent: [1.0, 0.0, 0.0, 1.0], sensitivity: 1.0 };
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
    // n additions add n roundings: a unit is 32 of them.
    let sensitivity = sum.sensitivity * (1.0 + corners.len() as f64 / 32.0);
    let error = f64::from(TANGENT_BOUND) * sensitivity;
    let vanishing = if sum.weight > 0.0 { undecided(flat.length(), least, error.x) } else { 0.0 };
    if flat.dot(flat) <= least * least {
        let [x, y, z] = fallback(normal, bits[2] >> 31 == 1).to_array().map(|component| component as f32);
        let decided = sensitivity.x.is_finite() && vanishing == 0.0;
        return Frame { tangent: [x, y, z, 1.0], sensitivity: if decided { 1.0 } else { f64::INFINITY } };
    }
    let tangent = unit(flat);
    let tangent = unit(tangent - normal * normal.dot(tangent));
    let [x, y, z] = tangent.to_array().map(|component| component as f32);
    let handedness = if sum.handedness < -least { -1.0 } else { 1.0 };
    let undecided = vanishing + undecided(sum.handedness, -least, error.y);
    Frame { tangent: [x, y, z, handedness], sensitivity: sensitivity.x / flat.length() + undecided }
}
