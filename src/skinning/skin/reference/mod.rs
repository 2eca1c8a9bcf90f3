//! Skinning: the CPU reference of `kernels/skinning/skin.wgsl`.

pub mod weights;

use glam::Vec3;

use crate::asset::influences::{Influence, Influences};
use crate::asset::transform::Affine;
use crate::skinning::clusters::{CLUSTER, Clusters};
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::palette::reference::unit_or;
use crate::skinning::palette::{DualBone, Palette};
use crate::skinning::skin::reference::weights::reduced;
use crate::skinning::vertex::Vertex;

/// Transforms vertices by a palette. `vertices` are the mesh's vertices, morphed or not. `influences` are the mesh's
/// influences.
///
/// # Panics
/// In three cases: there are fewer influences than vertices; `instance_lod` allows 0 influences; an influence names a
/// bone that the palette does not have.
pub fn skin(
    vertices: &[Vertex],
    influences: &Influences,
    palette: &Palette,
    instance_lod: InstanceLod,
) -> Vec<Vertex> {
    let matrix = |at: usize| blended(palette, &reduced(influences.of(at), instance_lod));
    vertices.iter().enumerate().map(|(at, vertex)| transformed(vertex, &matrix(at))).collect()
}

/// A mesh to skin, as input of [`skin_seen`].
#[derive(Debug, Clone, Copy)]
pub struct SkinnedMesh<'a> {
    /// The mesh's vertices, morphed or not.
    pub vertices: &'a [Vertex],
    /// The influences of each vertex.
    pub influences: &'a Influences,
    /// The order of the mesh's vertices in clusters.
    pub clusters: &'a Clusters,
}

/// As [`skin`], for one instance of a crowd, with the result in `skinned` (one entry per vertex of the mesh). If the
/// instance is invisible, its vertices stay unchanged. So do vertices in clusters beyond its level of detail.
///
/// # Panics
/// In the cases of [`skin`].
pub fn skin_seen(
    skinned: &mut [Vertex],
    mesh: SkinnedMesh<'_>,
    palette: &Palette,
    instance_lod: InstanceLod,
) {
    let SkinnedMesh { vertices, influences, clusters } = mesh;
    if instance_lod.max_influences > 0 {
        let all = skin(vertices, influences, palette, instance_lod);
        let slots = CLUSTER * clusters.level(instance_lod.mesh_lod).clusters as usize;
        for vertex in clusters.order.iter().take(slots).map(|vertex| *vertex as usize) {
            skinned[vertex] = all[vertex];
        }
    }
}

/// The blended matrix of a vertex. `left` are the influences that remain after [`reduced`], the strongest first.
pub fn blended(palette: &Palette, left: &[Influence]) -> Affine {
    match palette {
        Palette::Linear(bones) => mean(bones, left),
        Palette::Dual(bones) => dual_mean(bones, left),
    }
}

/// The influences with the strongest last, because the kernel computes the strongest weight last.
fn weaker_first(left: &[Influence]) -> impl Iterator<Item = &Influence> {
    left[1..].iter().chain(&left[..1])
}

fn mean(bones: &[Affine], left: &[Influence]) -> Affine {
    weaker_first(left).fold([[0.0; 4]; 3], |sum, influence| {
        let bone = &bones[influence.bone as usize];
        std::array::from_fn(|row| added(sum[row], influence.weight, bone[row]))
    })
}

fn added(sum: [f32; 4], weight: f32, value: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|at| sum[at] + weight * value[at])
}

fn dual_mean(bones: &[DualBone], left: &[Influence]) -> Affine {
    let strongest = &bones[left[0].bone as usize];
    let zero = [0.0; 4];
    let mut sum = DualBone { real: zero, dual: zero, diagonal: zero, above: zero };
    for influence in weaker_first(left) {
        let bone = &bones[influence.bone as usize];
        // The quaternions q and −q give the same rotation. The one in the hemisphere of the strongest bone's quaternion
        // is used.
        let side = if dot4(bone.real, strongest.real) < 0.0 { -influence.weight } else { influence.weight };
        sum.real = added(sum.real, side, bone.real);
        sum.dual = added(sum.dual, side, bone.dual);
        sum.diagonal = added(sum.diagonal, influence.weight, bone.diagonal);
        sum.above = added(sum.above, influence.weight, bone.above);
    }
    matrix_of(&sum)
}

fn dot4(a: [f32; 4], b: [f32; 4]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// The matrix of a weighted sum of bones. The sum's rotation is not 0: the strongest weight is at least 1/8, and no
/// other bone opposes it.
fn matrix_of(sum: &DualBone) -> Affine {
    let inverse = 1.0 / dot4(sum.real, sum.real);
    let [x, y, z, w] = sum.real;
    let [dx, dy, dz, dw] = sum.dual;
    // The factor of 2 divided by the squared length replaces normalization.
    let twice = 2.0 * inverse;
    let rotation = [
        [1.0 - twice * (y * y + z * z), twice * (x * y - w * z), twice * (x * z + w * y)],
        [twice * (x * y + w * z), 1.0 - twice * (x * x + z * z), twice * (y * z - w * x)],
        [twice * (x * z - w * y), twice * (y * z + w * x), 1.0 - twice * (x * x + y * y)],
    ];
    let translation = [
        twice * (w * dx - dw * x + y * dz - z * dy),
        twice * (w * dy - dw * y + z * dx - x * dz),
        twice * (w * dz - dw * z + x * dy - y * dx),
    ];
    let ([u, v, t, _], [uv, ut, vt, _]) = (sum.diagonal, sum.above);
    std::array::from_fn(|row| {
        let [a, b, c] = rotation[row];
        [a * u, a * uv + b * v, a * ut + b * vt + c * t, translation[row]]
    })
}

/// A vertex transformed by a matrix: position, unit normal and unit tangent.
pub fn transformed(vertex: &Vertex, [x, y, z]: &Affine) -> Vertex {
    let linear = |row: &[f32; 4], v: [f32; 3]| row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
    let position = [x, y, z].map(|row| linear(row, vertex.position) + row[3]);
    let [a, b, c] = [x, y, z].map(|row| Vec3::new(row[0], row[1], row[2]));
    // The rows of the cofactor matrix.
    let cofactors = [b.cross(c), c.cross(a), a.cross(b)];
    let side = if a.dot(cofactors[0]) < 0.0 { -1.0 } else { 1.0 };
    let unmoved = Vec3::from(vertex.normal);
    let normal = Vec3::from(cofactors.map(|row| side * row.dot(unmoved)));
    let [tx, ty, tz, handedness] = vertex.tangent;
    let along = [tx, ty, tz];
    let tangent = unit_or([x, y, z].map(|row| linear(row, along)).into(), along.into());
    Vertex {
        position,
        normal: unit_or(normal, unmoved).into(),
        tangent: tangent.extend(side * handedness).into(),
    }
}
