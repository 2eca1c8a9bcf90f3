//! Normals of triangles, and the test whether a collapse flips one (A section 4.1).

use glam::DVec3;

use super::points::Points;
use super::topology::Topology;

/// The squared sine of the angle between two edges up to which a triangle counts as having no area. Coordinates
/// are rounded to 2⁻²⁴ of their size, so that smaller angles are noise.
const NO_AREA: f64 = 1e-12;

/// A triangle without area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Flat;

/// The normal of a triangle: its length is twice the area, and the corners are counter-clockwise seen from the
/// side to which it points.
#[inline]
pub(crate) fn normal([a, b, c]: [DVec3; 3]) -> Result<DVec3, Flat> {
    let (first, second) = (b - a, c - a);
    let normal = first.cross(second);
    let least = NO_AREA * first.length_squared() * second.length_squared();
    if normal.length_squared() > least { Ok(normal) } else { Err(Flat) }
}

/// The square of the cosine of the largest angle by which a triangle's normal may turn: 75.5°, as meshoptimizer has it. Up
/// to 90° no triangle would turn around at once, but several collapses in a row could turn one.
const LEAST: f64 = 0.0625;

/// The square of the largest distance of a point from the planes of its triangles after a collapse, in any pose. `None` if
/// the collapse turns a triangle by more than 75°, or takes its area away, in any pose. Triangles that have no area before
/// may turn.
pub(crate) fn deviation(topology: &Topology, points: &Points, point: u32, neighbor: u32) -> Option<f64> {
    let mut worst = 0.0_f64;
    for pose in 0..points.poses() {
        let (from, to) = (points.position(point, pose), points.position(neighbor, pose));
        for &[next, last] in topology.ring(point) {
            if next == neighbor || last == neighbor {
                continue;
            }
            let (next, last) = (points.position(next, pose), points.position(last, pose));
            let (before, after) = (normal([from, next, last]), normal([to, next, last]));
            let (Ok(before), Ok(after)) = (before, after) else {
                match before {
                    Ok(_) => return None,
                    Err(Flat) => continue,
                }
            };
            let (cosine, squares) = (before.dot(after), before.length_squared() * after.length_squared());
            if cosine <= 0.0 || cosine * cosine < LEAST * squares {
                return None;
            }
            let off = after.dot(from - to);
            worst = worst.max(off * off / after.length_squared());
        }
    }
    Some(worst)
}
