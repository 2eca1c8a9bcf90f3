//! Error bound for the depth of a relief, by the rules of floating point, operation by operation.

use crate::shade::{ShadePoint, ShadeView};
use relievo::ops::surface::relief::LEAST_COSINE;

use crate::cases::surface::bounds::ULP;

/// The largest difference between the depth of a point on a device and that of the reference; infinite if a
/// device may divide by zero.
///
/// Sums, differences and products are within one unit in the last place and quotients within 2.5; a square
/// root, computed as the reciprocal of an inverse square root, is within 4.5. Both sides round, hence the
/// factor of two.
pub(crate) fn depth_off(view: &ShadeView, point: &ShadePoint) -> f64 {
    let position = point.position.map(f64::from);
    let eye = view.eye.to_array().map(f64::from);
    let way = [0, 1, 2].map(|i| eye[i] - eye[3] * position[i]);
    let length = way.iter().map(|axis| axis * axis).sum::<f64>().sqrt();
    let towards = way.map(|axis| axis / length);
    // Two operations per axis, then the length (product, two sums, root) and a quotient, relative to 1.
    let way_off = ULP * (0..3).map(|i| eye[i].abs() + 2.0 * (eye[3] * position[i]).abs()).sum::<f64>();
    let towards_off = 2.0 * way_off / length + ULP * (1.5 + 4.5 + 2.5);
    let cosine = f64::from(point.ray.cosine.max(LEAST_COSINE));
    let behind =
        (f64::from(point.hit.parameter) - f64::from(point.ray.polygon)) * f64::from(point.scale) / cosine;
    let distance = behind * f64::from(point.world);
    // Difference, product, quotient and product, then the product with the direction.
    let sunk_off = distance.abs() * (towards_off + ULP * (1.0 + 1.0 + 2.5 + 1.0 + 1.0));
    let world = [0, 1, 2].map(|i| position[i] - towards[i] * distance);
    let columns = view.clip_from_world.to_cols_array_2d();
    let clip = |row: usize| {
        let [x, y, z, w] = columns.map(|column| f64::from(column[row]));
        let terms = [x * world[0], y * world[1], z * world[2], w];
        // One product and three sums each, of coordinates that have errors themselves.
        let moved: f64 = [x, y, z]
            .iter()
            .zip(position)
            .map(|(factor, at)| factor.abs() * (sunk_off + ULP * (at.abs() + distance.abs())))
            .sum();
        (terms.iter().sum::<f64>(), moved + 4.0 * ULP * terms.iter().map(|term| term.abs()).sum::<f64>())
    };
    let ((z, z_off), (w, w_off)) = (clip(2), clip(3));
    if w.abs() <= 2.0 * w_off {
        return f64::INFINITY;
    }
    let depth = z / w;
    let off = (z_off + depth.abs() * w_off) / (w.abs() - w_off) + 2.5 * ULP * depth.abs();
    // Depths are clamped to 0 and 1.
    if depth + 2.0 * off < 0.0 || depth - 2.0 * off > 1.0 { ULP } else { 2.0 * off }
}
