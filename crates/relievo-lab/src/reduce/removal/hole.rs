//! Triangulation of the hole that a removed point leaves, by splitting its loop again and again.

use glam::DVec3;

use crate::reduce::mesh::{Corner, Mesh, normal};
use crate::reduce::removal::Loop;

/// The triangles that fill a loop: none for two points. Each split is at the chord with the best aspect ratio: the distance
/// of the nearest point of the loop from the plane through the chord and across the average plane, divided by the chord's
/// length. `None` if no chord separates the loop's points, if one is an edge of the mesh already, or if a triangle would turn
/// by 90° or more from the average plane.
pub(super) fn triangulated(
    mesh: &Mesh,
    places: &[DVec3],
    removed: u32,
    of: &Loop,
) -> Option<Vec<[Corner; 3]>> {
    let hole = Hole { mesh, places, removed, normal: of.normal };
    if of.corners.len() == 2 {
        return Some(Vec::new());
    }
    // The loop of a part closes with a chord of its own; a loop of three points may be another triangle's back.
    let first = of.corners[0].point;
    let last = of.corners[of.corners.len() - 1].point;
    let is_closed = mesh.ring(removed).any(|ring| ring.next.point == last && ring.last.point == first);
    if !is_closed && hole.has_edge(last, first) {
        return None;
    }
    let mut triangles = Vec::new();
    hole.fill(&of.corners, &mut triangles).then_some(triangles)
}

struct Hole<'a> {
    mesh: &'a Mesh,
    places: &'a [DVec3],
    removed: u32,
    normal: DVec3,
}

impl Hole<'_> {
    /// Fills a loop of three points or more.
    fn fill(&self, corners: &[Corner], triangles: &mut Vec<[Corner; 3]>) -> bool {
        if let [a, b, c] = *corners {
            let stands = normal([a, b, c].map(|corner| self.place(corner)))
                .is_some_and(|normal| normal.dot(self.normal) > 0.0);
            triangles.push([a, b, c]);
            return stands && !self.has_triangle([a, b, c]);
        }
        let mut best: Option<(f64, [usize; 2])> = None;
        let count = corners.len();
        for from in 0..count - 2 {
            for to in from + 2..count {
                if to - from == count - 1 {
                    continue;
                }
                let ratio = self.ratio(corners, [from, to]);
                if let Some(ratio) = ratio
                    && best.is_none_or(|(least, _)| ratio > least)
                    && !self.has_edge(corners[from].point, corners[to].point)
                {
                    best = Some((ratio, [from, to]));
                }
            }
        }
        let Some((_, [from, to])) = best else { return false };
        let rest: Vec<Corner> = corners[to..].iter().chain(&corners[..=from]).copied().collect();
        self.fill(&corners[from..=to], triangles) && self.fill(&rest, triangles)
    }

    /// The aspect ratio of a split. `None` if it does not separate the points on its two sides.
    fn ratio(&self, corners: &[Corner], [from, to]: [usize; 2]) -> Option<f64> {
        let start = self.place(corners[from]);
        let chord = self.place(corners[to]) - start;
        // To the left of the chord, seen against the normal, lie the points that follow its end.
        let left = self.normal.cross(chord);
        let length = left.length();
        if length <= 0.0 {
            return None;
        }
        let mut least = f64::INFINITY;
        for (at, corner) in corners.iter().enumerate().filter(|(at, _)| *at != from && *at != to) {
            let side = left.dot(self.place(*corner) - start) / length;
            let side = if at > from && at < to { -side } else { side };
            least = least.min(side);
        }
        (least > 0.0).then(|| least / chord.length())
    }

    fn place(&self, corner: Corner) -> DVec3 {
        self.places[corner.point as usize]
    }

    /// Whether two points share a triangle that stays.
    fn has_edge(&self, a: u32, b: u32) -> bool {
        self.mesh.ring(a).any(|ring| ring.has(b) && !ring.has(self.removed))
    }

    /// Whether three points are corners of a triangle.
    fn has_triangle(&self, [a, b, c]: [Corner; 3]) -> bool {
        self.mesh.ring(a.point).any(|ring| ring.has(b.point) && ring.has(c.point))
    }
}
