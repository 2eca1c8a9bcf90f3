//! The space that a sphere sweeps when a bone carries it through a clip.

use glam::{Vec3, Vec3Swizzles as _};

use super::bounding_sphere::{BoundingSphere, MARGIN, middle_of, poses};
use crate::animation::bounds::reference::bounds;
use crate::animation::local_to_model::reference::local_to_model;
use crate::asset::{Affine, Model};

/// The result of moving a sphere with a bone through a clip: the space that it sweeps, and how the bone deforms it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BonePath {
    /// A sphere around all positions of the moved sphere, in the model's space.
    pub sphere: BoundingSphere,
    /// The largest factor by which the bone's transform lengthens a vector, over all poses.
    pub stretch: f32,
    /// Whether the bone's transform mirrors at the clip's start.
    pub mirrors: bool,
}

impl BonePath {
    /// Moves the sphere `carried`, given in the bone's space, with a bone through a clip. The number of sampled poses
    /// and the margin for motion between them are the same as in [`BoundingSphere::in_clip`].
    pub fn new(model: &Model, clip: usize, bone: usize, carried: &BoundingSphere) -> Self {
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        let (mut largest, mut mirrors) = (0.0_f32, None);
        for locals in poses(&model.clips[clip]) {
            let matrix = local_to_model(&model.skeleton, &locals)[bone];
            let [x, y, z] = carried.center.to_array();
            let centered: Affine = matrix.map(|[a, b, c, d]| [a, b, c, a * x + b * y + c * z + d]);
            for found in bounds(&[centered], &[carried.radius]) {
                low = low.min(Vec3::from_slice(&found.low));
                high = high.max(Vec3::from_slice(&found.high));
            }
            let rows = matrix.map(|row| Vec3::from_slice(&row[..3]));
            largest = largest.max(stretch(rows));
            let [x, y, z] = rows;
            mirrors.get_or_insert(x.dot(y.cross(z)) < 0.0);
        }
        let sphere =
            BoundingSphere { center: middle_of(low, high), radius: MARGIN * low.distance(high) / 2.0 };
        Self { sphere, stretch: MARGIN * largest, mirrors: mirrors == Some(true) }
    }
}

/// An upper bound on the factor by which a matrix with these rows lengthens a vector.
///
/// The bound is the square root of the smaller of two values. One is the largest row sum of absolute values in the
/// matrix of dot products between columns (Gershgorin). The other is the sum of the squares of all elements. Up to
/// rounding, the bound is exact for a scale along the axes followed by a rotation.
fn stretch(rows: [Vec3; 3]) -> f32 {
    let squares: Vec3 = rows.iter().map(|row| row * row).sum();
    let mixed = rows.iter().map(|row| row * row.yzx()).sum::<Vec3>().abs();
    (squares + mixed + mixed.zxy()).max_element().min(squares.element_sum()).sqrt()
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Quat};

    use super::*;

    #[test]
    fn the_sphere_holds_what_the_bone_carries() {
        let model = crate::samples::creature().expect("valid");
        let carried = BoundingSphere { center: Vec3::new(0.1, 0.5, -0.2), radius: 0.3 };
        let bone = 60;
        let path = BonePath::new(&model, 0, bone, &carried);
        let clip = &model.clips[0];
        let mut farthest = 0.0_f32;
        for moment in 0_u16..77 {
            let time = clip.duration() * f32::from(moment) / 76.0;
            let pose = crate::animation::Pose::on_host(&model.skeleton, clip, time);
            let matrix = &pose.model_matrices[bone];
            let [x, y, z] = carried.center.to_array();
            let at = Vec3::from(matrix.map(|[a, b, c, d]| a * x + b * y + c * z + d));
            farthest = farthest.max(at.distance(path.sphere.center) + carried.radius);
        }
        assert!(
            (farthest..2.0 * farthest).contains(&path.sphere.radius),
            "{} for {farthest}",
            path.sphere.radius
        );
        assert!((1.0..1.2).contains(&path.stretch) && !path.mirrors, "{}", path.stretch);
    }

    #[test]
    fn stretches_are_not_too_small() {
        let of = |linear: Mat3| stretch([0, 1, 2].map(|row| linear.row(row)));
        let turned = of(Mat3::from_rotation_x(0.7) * Mat3::from_diagonal(Vec3::new(2.0, -3.0, 0.5)));
        assert!((turned - 3.0).abs() < 1e-5, "{turned}");
        let sheared = of(Mat3::from_cols(Vec3::X, Vec3::new(2.0, 1.0, 0.0), Vec3::Z));
        // The exact value is 1 + √2, the silver ratio.
        assert!((2.414..=2.65).contains(&sheared), "{sheared}");
    }

    #[test]
    fn no_matrix_stretches_further() {
        let unit = |at: usize| {
            let at = at as f32;
            Vec3::new(libm::sinf(1.3 * at), libm::cosf(2.1 * at), libm::sinf(0.7 * at + 1.0)).normalize()
        };
        let turn = |at: usize| Mat3::from_quat(Quat::from_axis_angle(unit(at), 0.37 * at as f32));
        let of = |matrix: Mat3| stretch(matrix.transpose().to_cols_array_2d().map(Vec3::from));
        for at in 0..100 {
            let scale = Vec3::new(0.2 + 0.02 * at as f32, -1.0, 1.5);
            // A scale followed by a rotation is bounded exactly; a scale between two rotations shears.
            assert!((of(turn(at) * Mat3::from_diagonal(scale)) - scale.abs().max_element()).abs() < 1e-5);
            let sheared = turn(at) * Mat3::from_diagonal(scale) * turn(3 * at + 1);
            let found = of(sheared);
            let longest = (0..500).map(|to| (sheared * unit(to)).length()).fold(0.0, f32::max);
            assert!(longest <= found + 1e-5, "{longest} of {found}");
            assert!(found < 1.8 * longest, "{longest} of {found}");
        }
    }
}
