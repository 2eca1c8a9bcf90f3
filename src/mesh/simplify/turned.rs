//! Normals of triangles, and whether a collapse turns one around (A section 4.1).

use glam::DVec3;

use super::points::Points;
use super::topology::Topology;

/// The largest squared sine of an angle between two edges of a triangle that has no area. Coordinates are rounded to
/// 2⁻²⁴ of their size, so smaller ones are noise.
const NO_AREA: f64 = 1e-12;

/// A triangle has no area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Flat;

/// Of a triangle's corners: as long as twice its area, to the side from which they are counter-clockwise.
pub fn normal([a, b, c]: [DVec3; 3]) -> Result<DVec3, Flat> {
    let (first, second) = (b - a, c - a);
    let normal = first.cross(second);
    let least = NO_AREA * first.length_squared() * second.length_squared();
    if normal.length_squared() > least { Ok(normal) } else { Err(Flat) }
}

/// Whether a triangle of a point turns by 90° or more, or loses its area, in any pose, where the point becomes its
/// neighbour. Triangles without area may turn.
pub fn turns_any(topology: &Topology, points: &Points, point: u32, neighbor: u32) -> bool {
    let stays = |pose: usize, [from, to]: [DVec3; 2], others: [u32; 2]| {
        let [next, last] = others.map(|other| points.place(other, pose));
        match (normal([from, next, last]), normal([to, next, last])) {
            (Err(Flat), _) => true,
            (_, Err(Flat)) => false,
            (Ok(before), Ok(after)) => before.dot(after) > 0.0,
        }
    };
    let one_ring =
        || topology.one_ring(point).filter(|ring| ![ring.next.point, ring.last.point].contains(&neighbor));
    (0..points.poses()).any(|pose| {
        let ends = [point, neighbor].map(|point| points.place(point, pose));
        one_ring().any(|ring| !stays(pose, ends, [ring.next.point, ring.last.point]))
    })
}
