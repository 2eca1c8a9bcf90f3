//! Bounds of instances: twin of `kernels/animation/bounds.wgsl`.

use crate::animation::bounds::Bounds;
use crate::asset::transform::Affine;
use crate::shared::animation::bounds::{GROWTH, LEAST, OF_CENTRE};

/// The bounds of each instance, from its palette and the reach of each bone.
///
/// # Panics
/// Without reaches.
pub fn bounds(models: &[Affine], reaches: &[f32]) -> Vec<Bounds> {
    models.chunks_exact(reaches.len()).map(|models| around(models, reaches)).collect()
}

fn around(models: &[Affine], reaches: &[f32]) -> Bounds {
    let mut bounds = Bounds { low: [f32::MAX; 4], high: [f32::MIN; 4] };
    (bounds.low[3], bounds.high[3]) = (0.0, 0.0);
    for (model, reach) in models.iter().zip(reaches) {
        for (axis, [x, y, z, centre]) in model.iter().enumerate() {
            let length = (x * x + y * y + z * z).sqrt();
            let half = reach * (length + LEAST) * GROWTH + centre.abs() * OF_CENTRE;
            bounds.low[axis] = bounds.low[axis].min(centre - half);
            bounds.high[axis] = bounds.high[axis].max(centre + half);
        }
    }
    bounds
}
