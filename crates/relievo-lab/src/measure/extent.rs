//! The extent of a model at rest, from which the length of a unit follows.

use relievo::InputError;
use relievo::asset::{Affine, Skeleton};
use relievo::ops::animation::local_to_model::reference::local_to_model;

/// A box around all bones of a model at rest, in the model's units.
pub(crate) struct Extent {
    /// The length of the box's longest edge.
    pub largest: f64,
    /// The height above the model's origin of the middle of the box.
    pub middle: f64,
}

impl Extent {
    /// # Errors
    /// [`InputError`] for a skeleton whose bones all lie in one point.
    pub(crate) fn new(skeleton: &Skeleton) -> Result<Self, InputError> {
        let [low, high] = corners(&local_to_model(skeleton, &skeleton.rest()), &skeleton.lengths());
        let largest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        if !(largest > 0.0 && largest.is_finite()) {
            let bound = "must be finite and above 0: the model at rest is a point";
            return Err(InputError::new("model.extent", largest, bound));
        }
        Ok(Self { largest, middle: (low[1] + high[1]) / 2.0 })
    }
}

/// The corners of a box around all bones, each taken as a sphere around its origin.
fn corners(models: &[Affine], lengths: &[f64]) -> [[f64; 3]; 2] {
    let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for (model, length) in models.iter().zip(lengths) {
        for (axis, row) in model.iter().enumerate() {
            let extent = length * f64::from(row[0].hypot(row[1]).hypot(row[2]));
            // The direction of a bone is unknown: the sphere around its origin has half its length as radius.
            corners[0][axis] = corners[0][axis].min(f64::from(row[3]) - extent / 2.0);
            corners[1][axis] = corners[1][axis].max(f64::from(row[3]) + extent / 2.0);
        }
    }
    corners
}
