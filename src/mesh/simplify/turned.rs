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
    let edges = [b - a, c - a];
    let normal = edges[0].cross(edges[1]);
    if is_flat(normal.length_squared(), edges) { Err(Flat) } else { Ok(normal) }
}

/// Whether a triangle has no area: `square` is that of its normal, which is the cross product of two edges.
#[inline]
fn is_flat(square: f64, [first, second]: [DVec3; 2]) -> bool {
    square <= NO_AREA * first.length_squared() * second.length_squared()
}

/// The square of the cosine of the largest angle by which a triangle's normal may turn: 75.5°, as meshoptimizer has it. Up
/// to 90° no triangle would turn around at once, but several collapses in a row could turn one.
const LEAST: f64 = 0.0625;

/// The square of the largest distance of a point from the planes of its triangles after a collapse, in any pose. `None` if
/// the collapse turns a triangle by more than 75°, or takes its area away, in any pose. Triangles that have no area before
/// may turn. The search begins with the triangle number `first` of the point, and leaves there the one that turns: what turns
/// for one neighbour mostly does for the next.
pub(crate) fn deviation(
    topology: &Topology,
    points: &Points,
    [point, neighbor]: [u32; 2],
    first: &mut usize,
) -> Option<f64> {
    let mut worst = 0.0_f64;
    let body = points.common_body(&[point, neighbor]);
    let is_rigid = topology.ring(point).iter().all(|others| points.common_body(others) == body);
    let poses = if is_rigid { points.poses_between(body, body) } else { points.poses() };
    for pose in 0..poses {
        let (from, to) = (points.position(point, pose), points.position(neighbor, pose));
        let moved = from - to;
        let ring = topology.ring(point);
        let start = (*first).min(ring.len());
        for at in (start..ring.len()).chain(0..start) {
            let [next, last] = ring[at];
            if next == neighbor || last == neighbor {
                continue;
            }
            let (next, last) = (points.position(next, pose), points.position(last, pose));
            let before = (next - from).cross(last - from);
            let after = (next - to).cross(last - to);
            let (cosine, square) = (before.dot(after), after.length_squared());
            let is_turned = cosine <= 0.0 || cosine * cosine < LEAST * before.length_squared() * square;
            if is_turned || is_flat(square, [next - to, last - to]) {
                if is_flat(before.length_squared(), [next - from, last - from]) {
                    continue;
                }
                *first = at;
                return None;
            }
            if is_flat(before.length_squared(), [next - from, last - from]) {
                continue;
            }
            let off = after.dot(moved);
            worst = worst.max(off * off / square);
        }
    }
    Some(worst)
}
