//! The distance between two surfaces of triangles, in both directions: root mean square, and largest (the Hausdorff
//! distance).
//!
//! # The largest distance
//!
//! It is bounded from both sides, and the bounds are brought together by branch and bound (after Tang, Lee and Kim,
//! "Interactive Hausdorff Distance Computation for General Polygonal Models", SIGGRAPH 2009, and Sacht and Jacobson,
//! "Cascading Upper Bounds for Triangle Soup Pompeiu-Hausdorff Distance", SGP 2024):
//! - *From below*: the distance of any point of one surface from the other is a lower bound.
//! - *From above*: the distance from a convex set is a convex function (for points p and q and their nearest points p′ and q′
//!   in the set, a·p′ + (1 − a)·q′ lies in the set, so that the distance of a·p + (1 − a)·q is at most
//!   a·|p − p′| + (1 − a)·|q − q′|). A convex function on a triangle is largest at one of the corners. No point of
//!   a triangle T is therefore further from the whole surface than the corner of T is that is furthest from *one* triangle
//!   of it, whichever that is. The bound uses the best one.
//!
//! A triangle whose upper bound exceeds the largest lower bound of all is divided, and its parts are bounded in turn. It is
//! cut along the sides of the triangle of the other surface that is nearest to its middle: above one triangle the
//! distance is nearly linear, so that the bounds meet after a few cuts, however fine the other surface is. Where no side cuts
//! it, its longest edge is halved. The largest distance that is returned is an upper bound, at most
//! [`DistanceOptions::tolerance`] times larger than the distance of a point that was seen.
//!
//! # The root mean square
//!
//! It is an integral over the surface, by area. Every triangle is divided into n² equal ones, each with the three-point
//! rule that is exact for quadratic polynomials, so that the result is exact where the distance is linear in each of them.
//! Its error has a bound in any case: the distance from a surface changes by no more than the point moves. Let each sample
//! stand for the third of its triangle around its corner, between the medians. The mean square of the way from a point to the
//! sample is then (l₁² + l₂² + l₃²)/108 for edges of lengths l, and by Minkowski's inequality the root mean square of
//! the distances differs from that of the samples by at most the root mean square of these ways
//! ([`OneWay::rms_within`]).
//!
//! Everything is computed in double precision. Results do not depend on the number of threads.

use glam::DVec3;
use relievo::InputError;
use relievo::asset::indices::check_triangles;
use tree::Tree;

mod bound;
mod pieces;
mod rms;
pub(crate) mod tree;

/// Triangles of a surface.
#[derive(Debug, Clone, Copy)]
pub struct Triangles<'a> {
    /// Positions of vertices, finite.
    pub positions: &'a [[f32; 3]],
    /// Three indices per triangle, of at least one.
    pub indices: &'a [u32],
}

/// How exact distances are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistanceOptions {
    /// How much larger than the distance of some point the largest distance may be: a fraction of 0.001 to 1. By default 0.01.
    pub tolerance: f64,
    /// The least number of samples of the root mean square on each surface, spread by area: 1 to 2²⁸. Each triangle has at
    /// least three. By default 2¹⁸.
    pub samples: usize,
}

impl Default for DistanceOptions {
    fn default() -> Self {
        Self { tolerance: 0.01, samples: 1 << 18 }
    }
}

/// The distances of the points of one surface from the other, in the unit of the positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneWay {
    /// The root mean square over the area. For a surface without area, over the samples.
    pub rms: f64,
    /// The true root mean square differs from `rms` by at most this. It usually differs far less.
    pub rms_within: f64,
    /// The largest distance, rounded up: no point of the surface is further away.
    pub max: f64,
    /// The largest distance of a point that was seen: at most `max`. `max` exceeds it by at most the tolerance, or by a
    /// 10⁹th of the surfaces' extent, unless the surfaces needed more divisions than
    /// 64 a triangle and a million.
    pub reached: f64,
}

/// The distances between two surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    /// Of the points of the first surface from the second.
    pub forward: OneWay,
    /// Of the points of the second surface from the first.
    pub backward: OneWay,
}

impl Distance {
    /// The larger root mean square of both directions.
    pub fn rms(&self) -> f64 {
        self.forward.rms.max(self.backward.rms)
    }

    /// The largest distance in either direction: the Hausdorff distance, rounded up.
    pub fn max(&self) -> f64 {
        self.forward.max.max(self.backward.max)
    }
}

/// Measures how far two surfaces are apart.
///
/// ```
/// use relievo_lab::distance::{DistanceOptions, Triangles, distance};
///
/// // Two parallel triangles; a corner of the second leans away.
/// let low = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let high = [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.0, 1.0, 2.0]];
/// let [from, to] = [&low, &high].map(|positions| Triangles { positions, indices: &[0, 1, 2] });
/// let found = distance(&from, &to, &DistanceOptions::default())?;
/// assert!((2.0..2.0201).contains(&found.backward.max) && found.backward.reached <= 2.0);
/// # Ok::<(), relievo::InputError>(())
/// ```
///
/// # Errors
/// [`InputError`] for a surface without triangles, for indices that are out of range or not three per triangle, for positions
/// that are not finite, and for options out of range. Paths begin with `from` or `to`, or with `options`.
pub fn distance(
    from: &Triangles<'_>,
    to: &Triangles<'_>,
    options: &DistanceOptions,
) -> Result<Distance, InputError> {
    let DistanceOptions { tolerance, samples } = *options;
    if !(0.001..=1.0).contains(&tolerance) {
        return Err(InputError::new("options.tolerance", tolerance, "must be in 0.001..=1"));
    }
    if !(1..=1 << 28).contains(&samples) {
        return Err(InputError::new("options.samples", samples, format!("must be in 1..={}", 1 << 28)));
    }
    let from = Surface::new("from", from)?;
    let to = Surface::new("to", to)?;
    let extent = extent(&[&from, &to]);
    let one_way = |surface: &Surface, other: &Surface| {
        let tree = Tree::new(&other.corners);
        let sampled = rms::sampled(surface, &tree, samples);
        let (reached, max) = bound::largest(surface, &tree, sampled.largest, tolerance, extent);
        OneWay { rms: sampled.rms, rms_within: sampled.within, max, reached }
    };
    Ok(Distance { forward: one_way(&from, &to), backward: one_way(&to, &from) })
}

/// The corners of triangles, in double precision.
struct Surface {
    corners: Vec<[DVec3; 3]>,
}

impl Surface {
    fn new(path: &str, triangles: &Triangles<'_>) -> Result<Self, InputError> {
        let Triangles { positions, indices } = *triangles;
        if indices.is_empty() {
            return Err(InputError::new(format!("{path}.indices.len"), 0, "must be at least 3"));
        }
        check_triangles(&format!("{path}.indices"), indices, positions.len())?;
        let numbers = positions.as_flattened();
        if let Some(at) = numbers.iter().position(|number| !number.is_finite()) {
            let path = format!("{path}.positions[{}][{}]", at / 3, at % 3);
            return Err(InputError::new(path, numbers[at], "must be finite"));
        }
        let position = |index: u32| DVec3::from(positions[index as usize].map(f64::from));
        let corners = indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(position)).collect();
        Ok(Self { corners })
    }
}

/// The diagonal of the box around surfaces.
fn extent(surfaces: &[&Surface]) -> f64 {
    let corners = || surfaces.iter().flat_map(|surface| surface.corners.as_flattened());
    let low = corners().fold(DVec3::INFINITY, |low, corner| low.min(*corner));
    let high = corners().fold(DVec3::NEG_INFINITY, |high, corner| high.max(*corner));
    low.distance(high)
}
