//! Bone transforms (translation, rotation and scale), and the affine matrices that chains of bones produce.

use crate::InputError;

/// Shortest length of a quaternion with a usable direction; a shorter quaternion is refused.
pub(crate) const SHORTEST: f32 = 1e-6;

/// The transform `translation · rotation · scale`; scale is applied first.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Transform {
    /// Translation in the parent's space, in metres.
    pub translation: [f32; 3],
    /// Rotation as a unit quaternion (x, y, z, w). q and −q are the same rotation.
    pub rotation: [f32; 4],
    /// Scale factors along the bone's own axes; they may be negative or zero.
    pub scale: [f32; 3],
}

impl Transform {
    /// The transform that changes nothing.
    pub const IDENTITY: Self =
        Self { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };

    /// Builds a transform that only translates.
    pub fn from_translation(translation: [f32; 3]) -> Self {
        Self { translation, ..Self::IDENTITY }
    }

    /// Converts the transform to an affine matrix in f64, with its rotation normalized.
    #[doc(hidden)]
    pub fn wide(&self) -> glam::DAffine3 {
        let [scale, translation] =
            [self.scale, self.translation].map(|vector| glam::DVec3::from(vector.map(f64::from)));
        let rotation = glam::DQuat::from_array(self.rotation.map(f64::from)).normalize();
        glam::DAffine3::from_scale_rotation_translation(scale, rotation, translation)
    }

    /// Checks the transform, and returns it with its rotation normalized.
    ///
    /// # Errors
    /// [`InputError`] for values that are not finite, and for a rotation shorter than 1e-6. In the path of the error,
    /// `path` precedes the field's name.
    pub fn checked(self, path: &str) -> Result<Self, InputError> {
        finite(&format!("{path}.translation"), &self.translation)?;
        finite(&format!("{path}.scale"), &self.scale)?;
        Ok(Self { rotation: unit(&format!("{path}.rotation"), self.rotation)?, ..self })
    }
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// Refuses values that are not finite. The error names the first such value by its index.
#[doc(hidden)]
pub fn finite(path: &str, values: &[f32]) -> Result<(), InputError> {
    InputError::check_each(path, values, |value| value.is_finite(), "must be finite")
}

/// Returns the quaternion scaled to length 1. Refuses a quaternion without a direction. `path` names the quaternion in errors.
pub(crate) fn unit(path: &str, quaternion: [f32; 4]) -> Result<[f32; 4], InputError> {
    finite(path, &quaternion)?;
    let wide = quaternion.map(f64::from);
    let length = wide.iter().map(|component| component * component).sum::<f64>().sqrt();
    if length < f64::from(SHORTEST) {
        let bound = format!("must be a unit quaternion, at least {SHORTEST:e} long");
        return Err(InputError::new(path, format!("{quaternion:?}"), bound));
    }
    Ok(wide.map(|component| (component / length) as f32))
}

/// First three rows of an affine 4×4 matrix; the last row is 0 0 0 1. Component r of `m · (p, 1)` is the dot product of `m[r]`
/// and (p, 1). Palettes have this layout, three `vec4` per bone.
pub type Affine = [[f32; 4]; 3];

/// The affine matrix that changes nothing.
pub const AFFINE_IDENTITY: Affine = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// Returns all sixteen components of an affine matrix, in column-major order.
pub fn column_major(affine: &Affine) -> [f32; 16] {
    let row = |row: usize, column: usize| if row < 3 { affine[row][column] } else { f32::from(column == 3) };
    std::array::from_fn(|index| row(index % 4, index / 4))
}

/// Decomposes a column-major matrix into translation, rotation and scale. A matrix that mirrors gets a negative x scale.
///
/// # Errors
/// [`InputError`] for values that are not finite, for a last row other than 0 0 0 1, and for shear.
pub(crate) fn decomposed(path: &str, matrix: &[f32; 16]) -> Result<Transform, InputError> {
    finite(path, matrix)?;
    let refused = |bound| Err(InputError::new(path, format!("{matrix:?}"), bound));
    if [3, 7, 11, 15].map(|index| matrix[index]) != [0.0, 0.0, 0.0, 1.0] {
        return refused("must have 0 0 0 1 as its last row");
    }
    let column = |index: usize| glam::DVec3::from_slice(&matrix.map(f64::from)[4 * index..4 * index + 3]);
    let columns = [column(0), column(1), column(2)];
    let mut scale = columns.map(glam::DVec3::length);
    let largest = scale.iter().copied().fold(0.0, f64::max);
    let mut axes = completed(columns, scale, largest);
    if axes[0].dot(axes[1].cross(axes[2])) < 0.0 {
        scale[0] = -scale[0];
        axes[0] = -axes[0];
    }
    let rotation = glam::DQuat::from_mat3(&glam::DMat3::from_cols(axes[0], axes[1], axes[2])).normalize();
    let error =
        (0..3).map(|axis| (rotation * glam::DVec3::AXES[axis] * scale[axis] - columns[axis]).length());
    if error.fold(0.0, f64::max) > SHEAR * largest {
        return refused("must be a product of translation, rotation and scale, without shear");
    }
    Ok(Transform {
        translation: [matrix[12], matrix[13], matrix[14]],
        rotation: rotation.to_array().map(|component| component as f32),
        scale: scale.map(|length| length as f32),
    })
}

/// Largest allowed difference between a matrix and the product of its translation, rotation and scale, relative to the largest
/// scale.
const SHEAR: f64 = 1e-3;

/// Unit axes of a matrix. An axis with a scale of 0 is chosen at right angles to the others.
fn completed(columns: [glam::DVec3; 3], scale: [f64; 3], largest: f64) -> [glam::DVec3; 3] {
    let zero = glam::DVec3::ZERO;
    let unit = |axis: usize| if scale[axis] > 1e-12 * largest { columns[axis] / scale[axis] } else { zero };
    let mut axes = [0, 1, 2].map(unit);
    if axes == [zero; 3] {
        return glam::DVec3::AXES;
    }
    for axis in 0..3 {
        let [next, last] = [axes[(axis + 1) % 3], axes[(axis + 2) % 3]];
        axes[axis] = match axes[axis] {
            there if there != zero => there,
            _ if next == zero => last.any_orthonormal_vector(),
            _ if last == zero => next.any_orthonormal_vector(),
            _ => next.cross(last).normalize_or_zero(),
        };
    }
    axes
}

/// Returns the first three rows of a column-major matrix.
pub fn rows(matrix: &[f32; 16]) -> Affine {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[4 * column + row]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(transform: &Transform) -> [f32; 16] {
        let [scale, translation] = [transform.scale, transform.translation].map(glam::Vec3::from_array);
        let rotation = glam::Quat::from_array(transform.rotation);
        glam::Mat4::from_scale_rotation_translation(scale, rotation, translation).to_cols_array()
    }

    #[test]
    fn matrices_are_taken_apart() {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        for scale in
            [[1.0, 2.0, 3.0], [-1.0, 2.0, 0.5], [1.0, -1.0, 1.0], [2.0, 0.0, 1.0], [0.0, 0.0, 4.0], [0.0; 3]]
        {
            for rotation in [[0.0, 0.0, 0.0, 1.0], [half, 0.0, 0.0, half], [0.5, -0.5, 0.5, 0.5]] {
                let expected = matrix(&Transform { translation: [1.0, -2.0, 3.0], rotation, scale });
                let parts = decomposed("m", &expected).expect("no shear");
                let again = matrix(&parts);
                let close = again.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-6);
                assert!(close, "{scale:?} {rotation:?}: {again:?} instead of {expected:?}");
                assert!(parts.checked("m").is_ok());
            }
        }
    }

    #[test]
    fn shear_projection_and_infinity_are_refused() {
        let mut shear = matrix(&Transform::IDENTITY);
        shear[4] = 0.1;
        assert!(decomposed("nodes[2].matrix", &shear).expect_err("shear").bound.contains("shear"));
        let mut projection = matrix(&Transform::IDENTITY);
        projection[3] = 0.1;
        assert!(decomposed("m", &projection).expect_err("projection").bound.contains("last row"));
        let mut wrong = matrix(&Transform::IDENTITY);
        wrong[6] = f32::NAN;
        assert_eq!(decomposed("m", &wrong).expect_err("NaN").path, "m[6]");
    }

    #[test]
    fn rotations_get_length_one_or_are_refused() {
        let long = Transform { rotation: [0.0, 0.0, 3.0, 4.0], ..Transform::IDENTITY };
        assert_eq!(long.checked("b").expect("not zero").rotation, [0.0, 0.0, 0.6, 0.8]);
        let none = Transform { rotation: [0.0; 4], ..Transform::IDENTITY };
        assert_eq!(none.checked("bones[1].rest").expect_err("zero").path, "bones[1].rest.rotation");
    }

    #[test]
    fn columns_come_first() {
        let affine = [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0], [9.0, 10.0, 11.0, 12.0]];
        let expected = [1, 5, 9, 0, 2, 6, 10, 0, 3, 7, 11, 0, 4, 8, 12, 1].map(|value| value as f32);
        assert_eq!(column_major(&affine), expected);
    }
}
