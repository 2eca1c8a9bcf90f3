//! Divides polygons into triangles: a convex polygon by a fan, any other polygon by ear clipping (Meisters, "Polygons Have
//! Ears", 1975). Every corner stays, even on a straight line between its neighbours. Polygons that share an edge thus still
//! share all points of that edge.

use glam::{DVec2, DVec3};

/// Largest number of corners of a concave polygon. The time of ear clipping grows with the square of this number.
pub(super) const MAX_CONCAVE: usize = 4096;

/// Divides a polygon into triangles, each with three indices into `corners`. There are two fewer triangles than corners, and
/// all have the polygon's orientation. `None` for a concave polygon with too many corners.
pub(super) fn triangles(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let count = corners.len();
    let fan = || (1..count.saturating_sub(1)).map(|at| [0, at, at + 1]).collect();
    if count <= 3 {
        return Some(fan());
    }
    let flat = projected(corners);
    let turn = |at: usize| area(flat[(at + count - 1) % count], flat[at], flat[(at + 1) % count]);
    let least = (0..count).map(turn).fold(f64::INFINITY, f64::min);
    if least > 0.0 {
        return Some(fan());
    }
    // Where a convex polygon has straight angles, a fan has degenerate triangles. Ear clipping avoids these, at a cost that is
    // low up to MAX_CONCAVE corners.
    match count <= MAX_CONCAVE {
        true => Some(clipped(&flat)),
        false => (least == 0.0).then(fan),
    }
}

/// Projects the polygon onto the axis-aligned plane where its area is largest, and makes it counter-clockwise.
fn projected(corners: &[DVec3]) -> Vec<DVec2> {
    // Twice the area of the projection onto each plane (Newell). Differences to the first corner avoid cancellation when
    // coordinates are large.
    let from = corners[0];
    let edges = corners.windows(2).map(|pair| (pair[0] - from).cross(pair[1] - from));
    let normal: DVec3 = edges.sum();
    let size = normal.abs();
    let (keep, sign): (fn(DVec3) -> DVec2, f64) = if size.z >= size.x && size.z >= size.y {
        (|p| DVec2::new(p.x, p.y), normal.z)
    } else if size.y >= size.x {
        (|p| DVec2::new(p.z, p.x), normal.y)
    } else {
        (|p| DVec2::new(p.y, p.z), normal.x)
    };
    let turned = |p: DVec2| if sign < 0.0 { DVec2::new(p.y, p.x) } else { p };
    corners.iter().map(|corner| turned(keep(*corner - from))).collect()
}

/// Twice the signed area of a triangle, positive if it is counter-clockwise.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Cuts ears off. An ear is a corner that turns left and whose triangle contains no other corner. If there is no ear, because
/// of rounding or a self-intersecting polygon, any corner is cut off.
fn clipped(flat: &[DVec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    let mut at = 0;
    let mut tried = 0;
    while left.len() > 3 {
        let count = left.len();
        let ear = [(at + count - 1) % count, at, (at + 1) % count].map(|place| left[place]);
        if tried < count && !is_ear(flat, &left, ear) {
            (at, tried) = ((at + 1) % count, tried + 1);
            continue;
        }
        triangles.push(ear);
        left.remove(at);
        // Both neighbours of the ear have changed, so all corners are tried again. The next corner is skipped, so that the
        // triangles are less thin than in a fan.
        (at, tried) = ((at + 1) % left.len(), 0);
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}

fn is_ear(flat: &[DVec2], left: &[usize], ear: [usize; 3]) -> bool {
    let [a, b, c] = ear.map(|corner| flat[corner]);
    if area(a, b, c) <= 0.0 {
        return false;
    }
    let is_inside = |p: DVec2| area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
    // Corners at the positions of a, b and c do not count. Bridges to holes have such corners.
    let is_corner = |p: DVec2| p == a || p == b || p == c;
    !left.iter().map(|corner| flat[*corner]).any(|p| is_inside(p) && !is_corner(p))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area covered by a polygon's triangles in the plane z = 0; each triangle must have the polygon's orientation.
    fn covered(corners: &[[f64; 2]]) -> f64 {
        let corners: Vec<DVec3> = corners.iter().map(|[x, y]| DVec3::new(*x, *y, 7.0)).collect();
        let triangles = triangles(&corners).expect("small");
        assert_eq!(triangles.len(), corners.len() - 2);
        let areas = triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|corner| corners[corner].truncate());
            area(a, b, c) / 2.0
        });
        areas.inspect(|area| assert!(*area >= 0.0, "{area}")).sum()
    }

    #[test]
    fn polygons_are_covered_once() {
        assert_eq!(covered(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]), 2.0);
        // An arrowhead, listed from each of its corners in turn. A triangle fan from three of these corners leaves the polygon.
        let arrow = [[0.0, 0.0], [2.0, 3.0], [0.0, 2.0], [-2.0, 3.0]];
        for turn in 0..4 {
            let mut arrow = arrow;
            arrow.rotate_left(turn);
            assert_eq!(covered(&arrow), 4.0);
        }
        // A comb, with a corner on a straight edge.
        let comb =
            [[0.0, 0.0], [3.0, 0.0], [6.0, 0.0], [6.0, 4.0], [4.0, 1.0], [3.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        assert_eq!(covered(&comb), 15.0);
        // A square with a square hole, joined by a bridge of two equal edges.
        let outer = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let hole = [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0]];
        assert_eq!(covered(&[outer, hole].concat()), 15.0);
    }

    #[test]
    fn polygons_in_space_turn_as_given() {
        let arrow = [[0.0, 0.0], [2.0, 3.0], [0.0, 2.0], [-2.0, 3.0]];
        let spaces: [fn(f64, f64) -> DVec3; 3] = [
            |x, y| DVec3::new(x, y, 0.1 * x),
            |x, y| DVec3::new(x, 0.2 * y, -y),
            |x, y| DVec3::new(1e3 + 0.1 * x, x, y),
        ];
        for space in spaces {
            for backwards in [false, true] {
                let mut corners: Vec<_> = arrow.iter().map(|[x, y]| space(*x, *y)).collect();
                if backwards {
                    corners.reverse();
                }
                let of = |all: &[DVec3]| -> DVec3 {
                    all.windows(2).map(|p| (p[0] - all[0]).cross(p[1] - all[0])).sum()
                };
                let normal = of(&corners);
                for triangle in triangles(&corners).expect("small") {
                    let turned = of(&triangle.map(|corner| corners[corner]));
                    assert!(turned.dot(normal) > 0.0, "{backwards}");
                }
            }
        }
    }

    #[test]
    fn only_large_ones_that_are_not_convex_are_refused() {
        let circle = |count: usize, dent: f64| -> Vec<DVec3> {
            let angle = |at: usize| at as f64 * std::f64::consts::TAU / count as f64;
            let corner = |at: usize| DVec3::new(libm::cos(angle(at)), libm::sin(angle(at)), 0.0);
            (0..count).map(|at| corner(at) * if at == 5 { dent } else { 1.0 }).collect()
        };
        assert_eq!(triangles(&circle(10_000, 1.0)).map(|all| all.len()), Some(9998));
        assert_eq!(triangles(&circle(10_000, 0.5)), None);
        assert_eq!(triangles(&circle(300, 0.5)).map(|all| all.len()), Some(298));
        assert_eq!(triangles(&[DVec3::ZERO; 5]).map(|all| all.len()), Some(3));
    }
}
