//! Rigid bodies: sets of vertices that follow the same single bone. If the bone is not stretched, the distances between
//! these vertices are the same in every pose. A distance measured in one pose then holds in all poses.

use std::collections::BTreeSet;

use glam::{Mat3, Vec3};

use crate::asset::transform::Affine;
use crate::asset::{Mesh, Model};
use crate::mesh::simplify::NO_BODY;
use crate::parallel;
use crate::skinning::palette::reference::palette;
use crate::skinning::pose::{Moment, bones_at};

/// The largest relative change of a distance within a rigid body between two moments.
pub(super) const STRETCH: f32 = 1e-4;

/// Bound on the rounding error of a position, as a fraction of the largest summand in its computation: 64 times half an
/// ulp of f32.
const ROUNDING: f32 = 4e-6;

/// The rigid bodies of a model's meshes.
pub(super) struct Bodies {
    /// For each mesh of the model, the rigid body of each vertex, or [`NO_BODY`].
    of: Vec<Vec<u32>>,
    /// Bound on the rounding error of a position at any of the moments, in the model's units.
    pub rounding: f32,
}

impl Bodies {
    /// Finds the rigid bodies of some meshes. A bone forms a body if it is not stretched between any two of the
    /// moments. Expects at least one moment.
    pub fn new(model: &Model, meshes: &[usize], moments: &[Moment]) -> Self {
        let skins: BTreeSet<usize> = meshes.iter().map(|mesh| model.meshes[*mesh].skin).collect();
        let skins: Vec<(usize, f32)> =
            skins.into_iter().map(|skin| (skin, reach(model, meshes, skin))).collect();
        let first = Look::new(model, &skins, &bones_at(model, moments[0]));
        let look = |moment: &Moment| {
            let own = Look::new(model, &skins, &bones_at(model, *moment));
            let is_rigid = own.squares.iter().zip(&first.squares).map(|(own, first)| is_alike(first, own));
            (is_rigid.collect::<Vec<bool>>(), own.largest)
        };
        let (mut is_rigid, mut largest) = (vec![true; first.squares.len()], 0.0_f32);
        for (own, other) in parallel::map(moments, look) {
            is_rigid.iter_mut().zip(own).for_each(|(all, own)| *all &= own);
            largest = largest.max(other);
        }
        // A bone that is stretched in one skin does not form a body in any skin.
        let mut is_body = vec![true; model.skeleton.len()];
        let bones = skins.iter().flat_map(|(skin, _)| &model.skins[*skin].bones);
        bones.zip(is_rigid).for_each(|(bone, is_rigid)| is_body[*bone as usize] &= is_rigid);
        let mut of = vec![Vec::new(); model.meshes.len()];
        for mesh in meshes {
            of[*mesh] = bodies_of(model, &model.meshes[*mesh], &is_body);
        }
        Self { of, rounding: ROUNDING * largest }
    }

    /// The rigid body of each vertex of a mesh, or [`NO_BODY`].
    pub fn of(&self, mesh: usize) -> &[u32] {
        &self.of[mesh]
    }
}

/// The rigid body that all three vertices belong to, or [`NO_BODY`] if there is none.
pub(super) fn common(bodies: &[u32], vertices: &[u32; 3]) -> u32 {
    let [a, b, c] = vertices.map(|vertex| bodies[vertex as usize]);
    if a == b && b == c { a } else { NO_BODY }
}

/// Measurements of the bones of some skins at one moment.
struct Look {
    /// For each bone of each skin, the dot products between the columns of its matrix.
    squares: Vec<Mat3>,
    /// The largest summand in the computation of a position.
    largest: f32,
}

impl Look {
    fn new(model: &Model, skins: &[(usize, f32)], bones: &[Affine]) -> Self {
        let mut look = Self { squares: Vec::new(), largest: 0.0 };
        for (skin, reach) in skins {
            for matrix in palette(&model.skins[*skin], bones) {
                let rows = matrix.map(|[x, y, z, _]| Vec3::new(x, y, z));
                let linear = Mat3::from_cols(rows[0], rows[1], rows[2]).transpose();
                let square = linear.transpose() * linear;
                let trace = square.x_axis.x + square.y_axis.y + square.z_axis.z;
                let moved = matrix.map(|row| row[3].abs()).into_iter().fold(0.0, f32::max);
                look.largest = look.largest.max(moved + trace.sqrt() * reach);
                look.squares.push(square);
            }
        }
        look
    }
}

/// Whether a bone stretches each direction by the same factor at two moments, with a tolerance of [`STRETCH`]. The
/// arguments are the dot products between the columns of its matrix at each moment.
fn is_alike(first: &Mat3, other: &Mat3) -> bool {
    let trace = first.x_axis.x + first.y_axis.y + first.z_axis.z;
    // A lower bound of the smallest eigenvalue of `first`. The smallest eigenvalue is the determinant divided by the
    // product of the other two. This product is at most the square of their mean, and their mean is at most half the
    // trace.
    let least = 4.0 * first.determinant() / (trace * trace);
    let off = (*first - *other).to_cols_array().into_iter().fold(0.0, |most: f32, x| most.max(x.abs()));
    // Three times the largest entry bounds the norm of the difference. The relative difference of squared lengths is
    // twice the relative difference of lengths. The result is false for NaN.
    3.0 * off <= 2.0 * STRETCH * least
}

/// The largest distance of a skin's vertices from the origin, in bind space, with morph targets.
fn reach(model: &Model, meshes: &[usize], skin: usize) -> f32 {
    let length = |vector: &[f32; 3]| Vec3::from(*vector).length();
    let own = meshes.iter().map(|mesh| &model.meshes[*mesh]).filter(|mesh| mesh.skin == skin);
    let of_mesh = |mesh: &Mesh| {
        let still = mesh.positions.iter().map(length).fold(0.0, f32::max);
        let targets = mesh.targets.iter().enumerate().map(|(at, target)| {
            let deltas = target.deltas.iter().map(|delta| length(&delta.position));
            mesh.largest_weight(at) * deltas.fold(0.0, f32::max)
        });
        still + targets.sum::<f32>()
    };
    own.map(of_mesh).fold(0.0, f32::max)
}

fn bodies_of(model: &Model, mesh: &Mesh, is_body: &[bool]) -> Vec<u32> {
    let bones = &model.skins[mesh.skin].bones;
    let body = |vertex: usize| match mesh.influences.of(vertex) {
        [only] => Some(bones[only.bone as usize]).filter(|bone| is_body[*bone as usize]).unwrap_or(NO_BODY),
        _ => NO_BODY,
    };
    let mut all: Vec<u32> = (0..mesh.vertices()).map(body).collect();
    for vertex in mesh.targets.iter().flat_map(|target| &target.vertices) {
        all[*vertex as usize] = NO_BODY;
    }
    all
}
