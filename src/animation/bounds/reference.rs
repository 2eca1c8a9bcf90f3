//! Bounds of instances: the CPU reference of `kernels/animation/bounds.wgsl`.

use crate::animation::bounds::MotionBounds;
use crate::asset::transform::Affine;
use crate::shared::animation::bounds::{GROWTH, LEAST, OF_CENTER};

/// Bounding box of each instance, from its model matrices and the radius of each bone in metres.
///
/// # Panics
/// If `bone_radii` is empty.
pub fn bounds(model_matrices: &[Affine], bone_radii: &[f32]) -> Vec<MotionBounds> {
    model_matrices
        .chunks_exact(bone_radii.len())
        .map(|model_matrices| around(model_matrices, bone_radii))
        .collect()
}

fn around(model_matrices: &[Affine], bone_radii: &[f32]) -> MotionBounds {
    let mut bounds = MotionBounds { low: [f32::MAX; 4], high: [f32::MIN; 4] };
    (bounds.low[3], bounds.high[3]) = (0.0, 0.0);
    for (model, bone_radius) in model_matrices.iter().zip(bone_radii) {
        for (axis, [x, y, z, center]) in model.iter().enumerate() {
            let length = (x * x + y * y + z * z).sqrt();
            let half = bone_radius * (length + LEAST) * GROWTH + center.abs() * OF_CENTER;
            bounds.low[axis] = bounds.low[axis].min(center - half);
            bounds.high[axis] = bounds.high[axis].max(center + half);
        }
    }
    bounds
}
