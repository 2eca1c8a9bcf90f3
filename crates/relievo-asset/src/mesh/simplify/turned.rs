//! Normals of triangles, and the test whether a collapse flips a triangle (thesis A section 4.1).

use glam::DVec3;

use super::points::Points;
use super::topology::Topology;

/// Limit of the squared sine of the angle between two edges. At or below this limit, a triangle counts as having no
/// area. Coordinates are rounded to 2⁻²⁴ of their size, so smaller angles are noise.
const NO_AREA: f64 = 1e-12;

/// Error for a triangle without area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Flat;

/// Normal of a triangle, with a length of twice the area. Seen from the side to which the normal points, the corners
/// are counter-clockwise.
#[inline]
pub(crate) fn normal([a, b, c]: [DVec3; 3]) -> Result<DVec3, Flat> {
    let edges = [b - a, c - a];
    let normal = edges[0].cross(edges[1]);
    if is_flat(normal.length_squared(), edges) { Err(Flat) } else { Ok(normal) }
}

/// Whether a triangle has no area. `square` is the squared length of the cross product of its two edges.
#[inline]
fn is_flat(square: f64, [first, second]: [DVec3; 2]) -> bool {
    square <= NO_AREA * first.length_squared() * second.length_squared()
}

/// Squared cosine of the largest angle by which a triangle's normal may turn: 75.5°, as in meshoptimizer. A limit of
/// 90° would prevent a flip by one collapse, but several collapses in a row could still flip a triangle.
const LEAST: f64 = 0.0625;

/// Largest squared distance, over all poses, between a point and the planes of its triangles after a collapse. For a
/// border point, the distance from the new border also counts. `None` if the collapse turns a triangle by more than 75°
/// or removes its area, in any pose. Triangles that had no area before may turn. `first` is the index of the triangle
/// to test first, in the point's list. If a triangle turns, `first` is set to its index, because the same triangle
/// mostly turns for the next neighbour.
pub(crate) fn deviation(
    topology: &Topology,
    points: &Points,
    [point, neighbor]: [u32; 2],
    first: &mut usize,
) -> Option<f64> {
    let mut worst = 0.0_f64;
    // The neighbour at the other end of the new border edge.
    let border =
        topology.along_border(point).map(|[first, last]| if first == neighbor { last } else { first });
    for pose in 0..topology.poses_around(points, [point, neighbor]) {
        let (from, to) = (points.position(point, pose), points.position(neighbor, pose));
        let moved = from - to;
        if let Some(end) = border {
            worst = worst.max(square_from_segment(from, [to, points.position(end, pose)]));
        }
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

/// Squared distance from a position to a line segment.
fn square_from_segment(from: DVec3, [start, end]: [DVec3; 2]) -> f64 {
    let (edge, to) = (end - start, from - start);
    let square = edge.length_squared();
    let along = if square > 0.0 { (to.dot(edge) / square).clamp(0.0, 1.0) } else { 0.0 };
    (to - edge * along).length_squared()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat fan around a border point. The planes of its triangles do not detect that the border moves.
    #[test]
    fn points_on_borders_are_off_by_their_distance_from_the_border() {
        let at = |x: f32, y: f32| [x, y, 0.0];
        let corners = |notch: f32| {
            vec![at(0.0, notch), at(-2.0, 0.0), at(-1.0, -1.0), at(1.0, -1.0), at(2.0, 0.0), at(0.0, -3.0)]
        };
        let indices = [0, 1, 2, 0, 2, 3, 0, 3, 4, 2, 5, 3];
        let off = |poses: &[Vec<[f32; 3]>], neighbor: u32| {
            let points = Points::new(poses);
            let topology = Topology::new(&points, &indices, &[], false);
            assert_eq!(topology.along_border(0), Some([1, 4]));
            assert_eq!(topology.along_border(2).map(|ends| ends.contains(&1)), Some(true));
            deviation(&topology, &points, [0, neighbor], &mut 0).map(|square| square.sqrt() / points.scale())
        };
        for (notch, neighbor) in [(0.0, 1), (0.25, 4), (-0.25, 1), (-0.25, 4)] {
            let found = off(&[corners(notch)], neighbor);
            assert!(found.is_some_and(|off| (off - f64::from(notch.abs())).abs() < 1e-9), "{found:?}");
        }
        // With several poses, the largest distance counts.
        let found = off(&[corners(0.0), corners(-0.125)], 1);
        assert!(found.is_some_and(|off| (off - 0.125).abs() < 1e-9), "{found:?}");
    }
}
