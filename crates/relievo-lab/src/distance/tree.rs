//! A tree of boxes around triangles, for the nearest triangle of points.

use glam::DVec3;
use relievo::ops::mesh::nearest::precise_nearest_on_triangle;

/// The most triangles of a leaf.
const LEAF: usize = 4;

/// Triangles in a tree of boxes.
pub(crate) struct Tree {
    nodes: Vec<Node>,
    /// In the order of the leaves.
    triangles: Vec<[DVec3; 3]>,
}

/// A box, and what lies in it.
#[derive(Clone, Copy)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// The first triangle of a leaf; the second child of an inner node, whose first child follows it.
    at: u32,
    /// The number of triangles of a leaf; 0 for inner nodes.
    count: u32,
}

impl Node {
    /// The square of the distance of a point from the box.
    fn distance_squared(&self, point: DVec3) -> f64 {
        point.distance_squared(point.clamp(self.low, self.high))
    }
}

/// A triangle of a tree, and the square of a distance from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Near {
    pub triangle: u32,
    pub squared: f64,
}

impl Tree {
    /// A tree of at least one triangle, divided at the median along the longest side of each box.
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let middles: Vec<DVec3> = triangles.iter().map(|[a, b, c]| *a + *b + *c).collect();
        let mut nodes = Vec::with_capacity(triangles.len());
        // Ranges of triangles whose nodes are still to come, with the parents whose second children they are.
        let mut waiting = vec![(0, triangles.len(), None)];
        while let Some((start, end, parent)) = waiting.pop() {
            let at = nodes.len();
            if let Some(parent) = parent {
                let parent: &mut Node = &mut nodes[parent];
                parent.at = at as u32;
            }
            let here = &mut order[start..end];
            let corners = || here.iter().flat_map(|triangle| triangles[*triangle as usize]);
            let low = corners().fold(DVec3::INFINITY, DVec3::min);
            let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
            if here.len() <= LEAF {
                nodes.push(Node { low, high, at: start as u32, count: here.len() as u32 });
                continue;
            }
            nodes.push(Node { low, high, at: 0, count: 0 });
            let size = high - low;
            let axis = (1..3).fold(0, |most, axis| if size[axis] > size[most] { axis } else { most });
            let half = here.len() / 2;
            here.select_nth_unstable_by(half, |a, b| {
                let of = |triangle: &u32| middles[*triangle as usize][axis];
                of(a).total_cmp(&of(b)).then(a.cmp(b))
            });
            waiting.push((start + half, end, Some(at)));
            waiting.push((start, start + half, None));
        }
        let triangles = order.iter().map(|triangle| triangles[*triangle as usize]).collect();
        Self { nodes, triangles }
    }

    /// The corners of a triangle.
    pub fn triangle(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize]
    }

    /// The triangle that is nearest to a point. `hint` is any triangle; the search is shorter if it is near.
    pub fn nearest(&self, point: DVec3, hint: u32) -> Near {
        let squared = |triangle: u32| self.squared(point, self.triangle(triangle));
        let best = Near { triangle: hint, squared: squared(hint) };
        self.search(best, 0.0, |node| node.distance_squared(point), squared)
    }

    /// The point on any triangle that is nearest to a point. `known` is one that lies on a triangle, if any is known; the
    /// search is shorter if it is near.
    pub fn nearest_point(&self, point: DVec3, known: Option<DVec3>) -> DVec3 {
        // No triangle yet.
        let triangle = u32::MAX;
        let squared = known.map_or(f64::INFINITY, |known| known.distance_squared(point));
        let squared_to = |triangle: u32| self.squared(point, self.triangle(triangle));
        let found =
            self.search(Near { triangle, squared }, 0.0, |node| node.distance_squared(point), squared_to);
        let corners = self.triangles.get(found.triangle as usize);
        corners.map(|corners| precise_nearest_on_triangle(point, *corners)).or(known).unwrap_or(point)
    }

    /// A triangle, and the distance of the point from it that is furthest from it.
    pub fn furthest(&self, points: &[DVec3], triangle: u32) -> Near {
        let corners = self.triangle(triangle);
        let squared = |point: &DVec3| self.squared(*point, corners);
        Near { triangle, squared: points.iter().map(squared).fold(0.0, f64::max) }
    }

    /// The triangle from which the furthest of `points` is least far, beginning with `best`. The search ends early where a
    /// triangle is found within a distance whose square is `enough`.
    pub fn nearest_to_all(&self, points: &[DVec3], best: Near, enough: f64) -> Near {
        let bound =
            |node: &Node| points.iter().map(|point| node.distance_squared(*point)).fold(0.0, f64::max);
        self.search(best, enough, bound, |triangle| self.furthest(points, triangle).squared)
    }

    fn squared(&self, point: DVec3, corners: [DVec3; 3]) -> f64 {
        point.distance_squared(precise_nearest_on_triangle(point, corners))
    }

    /// The triangle for which `squared` is least, which is at least `bound` of every node that has it; as
    /// [`Tree::nearest_to_all`]. One point has a search of its own, without loops over points: it takes most of the time of a
    /// measurement.
    #[inline(always)]
    fn search(
        &self,
        mut best: Near,
        enough: f64,
        bound: impl Fn(&Node) -> f64,
        squared: impl Fn(u32) -> f64,
    ) -> Near {
        let mut waiting = [(0_u32, 0.0_f64); 64];
        let mut count = 1;
        waiting[0] = (0, bound(&self.nodes[0]));
        while count > 0 && best.squared > enough {
            count -= 1;
            let (at, least) = waiting[count];
            if least >= best.squared {
                continue;
            }
            let node = self.nodes[at as usize];
            if node.count > 0 {
                for triangle in node.at..node.at + node.count {
                    let found = squared(triangle);
                    if found < best.squared {
                        best = Near { triangle, squared: found };
                    }
                }
                continue;
            }
            let [near, far] = [at + 1, node.at].map(|child| (child, bound(&self.nodes[child as usize])));
            let [near, far] = if near.1 <= far.1 { [near, far] } else { [far, near] };
            // What is further away than the best needs no turn. Medians keep the depth below 32: each level waits with one
            // node at most.
            for child in [far, near].into_iter().filter(|child| child.1 < best.squared) {
                waiting[count] = child;
                count += 1;
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(seed: u32, count: usize) -> Vec<DVec3> {
        let mut state = u64::from(seed);
        let mut next = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        (0..count).map(|_| DVec3::new(next(), next(), next())).collect()
    }

    #[test]
    fn searches_find_what_a_loop_finds() {
        let corners = noise(1, 3 * 200);
        let triangles: Vec<[DVec3; 3]> = (corners.chunks_exact(3))
            .map(|all| [all[0], all[0] + 0.1 * all[1], all[0] + 0.1 * all[2]])
            .collect();
        let tree = Tree::new(&triangles);
        for points in noise(2, 300).chunks_exact(3) {
            let points = points.iter().map(|point| 2.0 * *point - 0.5).collect::<Vec<_>>();
            for some in [&points[..1], &points[..]] {
                let start = tree.furthest(some, 0);
                let found = tree.nearest_to_all(some, start, 0.0);
                let all = (0..200).map(|triangle| tree.furthest(some, triangle).squared);
                assert_eq!(found.squared, all.fold(f64::INFINITY, f64::min));
                assert_eq!(tree.furthest(some, found.triangle).squared, found.squared);
            }
            let start = tree.furthest(&points, 0);
            let (least, early) =
                (tree.nearest_to_all(&points, start, 0.0), tree.nearest_to_all(&points, start, 0.5));
            assert!(early.squared <= least.squared.max(0.5), "{early:?} {least:?}");
        }
    }

    #[test]
    fn no_point_of_a_triangle_is_nearer() {
        let corner = |at: usize| {
            let turn = |rate: f64| 5.0 * libm::sin(rate * at as f64);
            DVec3::new(turn(1.3), turn(2.9), turn(4.7))
        };
        let triangles: Vec<_> = (0..97)
            .map(|at| {
                let place = 4.0 * corner(7 * at);
                [0, 1, 2].map(|next| place + corner(3 * at + next))
            })
            .collect();
        let tree = Tree::new(&triangles);
        for at in 0..300 {
            let point = 6.0 * corner(11 * at + 1);
            let least = (triangles.iter())
                .map(|corners| precise_nearest_on_triangle(point, *corners).distance(point))
                .fold(f64::INFINITY, f64::min);
            assert_eq!(tree.nearest_point(point, None).distance(point), least, "{at}");
            let known = triangles[at % 97].iter().sum::<DVec3>() / 3.0;
            assert_eq!(tree.nearest_point(point, Some(known)).distance(point), least, "{at}");
        }
        let one = Tree::new(&[[DVec3::X; 3]]);
        assert_eq!(one.nearest_point(DVec3::ZERO, None), DVec3::X);
        assert_eq!(one.nearest_point(DVec3::ZERO, Some(DVec3::X)), DVec3::X);
    }
}
