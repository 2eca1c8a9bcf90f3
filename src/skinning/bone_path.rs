//! Where a bone carries a sphere through a clip.

use glam::{DMat3, DVec3};

use super::bounding_sphere::{BoundingSphere, MARGIN, middle_of, poses};
use crate::animation::bounds::reference::bounds;
use crate::animation::local_to_model::reference::local_to_model;
use crate::asset::{Affine, Model};

/// Where a bone carries a sphere through a clip, and how it deforms what it carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BonePath {
    /// A sphere around all places of the carried sphere, in the model's space.
    pub sphere: BoundingSphere,
    /// The largest factor by which the bone enlarges a length.
    pub stretch: f32,
    /// Whether the bone mirrors at the clip's start.
    pub mirrors: bool,
}

impl BonePath {
    /// Follows a bone through a clip, sampled as [`BoundingSphere::in_clip`] samples it and enlarged like it for motion
    /// between samples, with a sphere in the bone's space.
    pub fn new(model: &Model, clip: usize, bone: usize, carried: &BoundingSphere) -> Self {
        let (mut low, mut high) = (glam::Vec3::MAX, glam::Vec3::MIN);
        let (mut stretch, mut mirrors) = (0.0_f64, None);
        for locals in poses(&model.clips[clip]) {
            let matrix = local_to_model(&model.skeleton, &locals)[bone];
            let [x, y, z] = carried.center.to_array();
            let centered: Affine = matrix.map(|[a, b, c, d]| [a, b, c, a * x + b * y + c * z + d]);
            for found in bounds(&[centered], &[carried.radius]) {
                low = low.min(glam::Vec3::from_slice(&found.low));
                high = high.max(glam::Vec3::from_slice(&found.high));
            }
            let column = |at: usize| DVec3::from(matrix.map(|row| f64::from(row[at])));
            let linear = DMat3::from_cols(column(0), column(1), column(2));
            stretch = stretch.max(largest_stretch(&linear));
            mirrors.get_or_insert(linear.determinant() < 0.0);
        }
        let sphere =
            BoundingSphere { center: middle_of(low, high), radius: MARGIN * low.distance(high) / 2.0 };
        Self { sphere, stretch: MARGIN * stretch as f32, mirrors: mirrors == Some(true) }
    }
}

/// An upper bound of the factor by which a matrix enlarges a length: exact for columns at right angles, as rotations and scales
/// have.
fn largest_stretch(linear: &DMat3) -> f64 {
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
    let squares = columns.map(DVec3::length_squared);
    let largest = squares.into_iter().fold(0.0, f64::max);
    let skew = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| columns[a].dot(columns[b]).abs());
    // The rows of the symmetric product of the matrix with itself add up to at least its eigenvalues.
    (largest + 2.0 * skew.into_iter().fold(0.0, f64::max)).sqrt()
}

#[cfg(all(test, feature = "samples"))]
mod tests {
    use super::*;
    use glam::Vec3;

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
        let turned = DMat3::from_rotation_x(0.7) * DMat3::from_diagonal(DVec3::new(2.0, -3.0, 0.5));
        assert!((largest_stretch(&turned) - 3.0).abs() < 1e-9);
        let sheared = DMat3::from_cols(DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::Z);
        // The golden ratio's relative: 1 + √2.
        assert!((2.414..=3.0).contains(&largest_stretch(&sheared)), "{}", largest_stretch(&sheared));
    }
}
