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
pub(crate) fn normal([a, b, c]: [DVec3; 3]) -> Result<DVec3, Flat> {
    let (first, second) = (b - a, c - a);
    let normal = first.cross(second);
    let least = NO_AREA * first.length_squared() * second.length_squared();
    if normal.length_squared() > least { Ok(normal) } else { Err(Flat) }
}

/// Whether a collapse turns a triangle of the point by 90° or more, or takes its area away, in any pose.
/// Triangles that have no area before may turn.
pub(crate) fn turns_any(topology: &Topology, points: &Points, point: u32, neighbor: u32) -> bool {
    let stays = |pose: usize, [from, to]: [DVec3; 2], others: [u32; 2]| {
        let [next, last] = others.map(|other| points.position(other, pose));
        match (normal([from, next, last]), normal([to, next, last])) {
            (Err(Flat), _) => true,
            (_, Err(Flat)) => false,
            (Ok(before), Ok(after)) => before.dot(after) > 0.0,
        }
    };
    let one_ring =
        || topology.one_ring(point).filter(|ring| ![ring.next.point, ring.last.point].contains(&neighbor));
    (0..points.poses()).any(|pose| {
        let ends = [point, neighbor].map(|point| points.position(point, pose));
        one_ring().any(|ring| !stays(pose, ends, [ring.next.point, ring.last.point]))
    })
}
