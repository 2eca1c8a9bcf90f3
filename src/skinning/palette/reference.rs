//! Palettes: the CPU reference of `kernels/skinning/palette.wgsl`.

use glam::Vec3;

use crate::animation::local_to_model::reference::product;
use crate::asset::skeleton::Skin;
use crate::asset::transform::Affine;
use crate::asset::transform::rows;
use crate::shared::skinning::rows::LEAST_LENGTH;
use crate::skinning::palette::{DualBone, Palette};
use crate::skinning::vertex::Blend;

/// The palette of a skin, one matrix per bone: model matrix × inverse bind matrix.
///
/// # Panics
/// If the skin does not match the skeleton of `model_matrices`.
pub fn palette(skin: &Skin, model_matrices: &[Affine]) -> Vec<Affine> {
    let bones = skin.bones.iter().zip(&skin.inverse_binds);
    bones.map(|(bone, bind)| product(&model_matrices[*bone as usize], &rows(bind))).collect()
}

/// The palette of a skin in the form that a kind of blending needs.
pub fn palette_for(skin: &Skin, model_matrices: &[Affine], blend: Blend) -> Palette {
    let linear = palette(skin, model_matrices);
    match blend {
        Blend::Linear => Palette::Linear(linear),
        Blend::DualQuaternion => Palette::Dual(linear.iter().map(dual).collect()),
    }
}

/// Splits a matrix into a stretch followed by a rigid motion.
pub fn dual(matrix: &Affine) -> DualBone {
    let column = |at: usize| Vec3::new(matrix[0][at], matrix[1][at], matrix[2][at]);
    let [a, b, c] = [0, 1, 2].map(column);
    // A column without a direction is replaced by a unit vector that leaves the other columns unchanged.
    let x = unit_or(a, Vec3::X);
    let along = x.dot(b);
    let y = unit_or(b - along * x, upright(x));
    let z = x.cross(y);
    let real = quaternion(x.to_array(), y.to_array(), z.to_array());
    DualBone {
        real,
        dual: half_product(column(3).to_array(), real),
        diagonal: [x.dot(a), y.dot(b), z.dot(c), 0.0],
        above: [along, x.dot(c), y.dot(c), 0.0],
    }
}

/// `vector` scaled to length 1, or `other` if `vector` is too short to have a direction.
pub(crate) fn unit_or(vector: Vec3, other: Vec3) -> Vec3 {
    let size = vector.abs().max_element();
    if size < LEAST_LENGTH {
        return other;
    }
    let scaled = vector / size;
    (1.0 / scaled.length_squared().sqrt()) * scaled
}

/// A unit vector perpendicular to `unit` (Duff et al. 2017).
fn upright(unit: Vec3) -> Vec3 {
    let [x, y, z] = unit.to_array();
    let side = if z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (side + z);
    Vec3::new(1.0 + side * x * x * a, side * x * y * a, -side * x)
}

/// The unit quaternion of a rotation whose matrix has these columns; its sign is arbitrary. The quaternion's largest
/// component is at least ½ and is computed without cancellation.
fn quaternion(x: [f32; 3], y: [f32; 3], z: [f32; 3]) -> [f32; 4] {
    let squares = [
        1.0 + x[0] - y[1] - z[2],
        1.0 - x[0] + y[1] - z[2],
        1.0 - x[0] - y[1] + z[2],
        1.0 + x[0] + y[1] + z[2],
    ];
    let [xy, yz, zx] = [x[1] + y[0], y[2] + z[1], z[0] + x[2]];
    let [wx, wy, wz] = [y[2] - z[1], z[0] - x[2], x[1] - y[0]];
    let q = if squares[3] >= 1.0 {
        [wx, wy, wz, squares[3]]
    } else if squares[0] >= squares[1] && squares[0] >= squares[2] {
        [squares[0], xy, zx, wx]
    } else if squares[1] >= squares[2] {
        [xy, squares[1], yz, wy]
    } else {
        [zx, yz, squares[2], wz]
    };
    let inverse = 1.0 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
    q.map(|component| component * inverse)
}

/// Half of the quaternion product of a vector (with real part 0) and `q`.
fn half_product([x, y, z]: [f32; 3], q: [f32; 4]) -> [f32; 4] {
    [
        0.5 * (x * q[3] + y * q[2] - z * q[1]),
        0.5 * (y * q[3] + z * q[0] - x * q[2]),
        0.5 * (z * q[3] + x * q[1] - y * q[0]),
        -0.5 * (x * q[0] + y * q[1] + z * q[2]),
    ]
}
