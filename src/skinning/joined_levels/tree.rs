//! A tree of boxes around triangles, for the distance of a point from the nearest triangle. The tree is built once, in one
//! pose. In every other pose, only its boxes are computed again.

use std::ops::ControlFlow;

use glam::DVec3;

use crate::mesh::nearest::precise_nearest_on_triangle;

/// Largest number of triangles of a leaf.
const LEAF: usize = 4;

/// A tree of triangles. Every node comes before its children. The first child of an inner node follows it.
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// The triangles as vertex indices, in the order of the leaves.
    triangles: Vec<[u32; 3]>,
}

#[derive(Clone, Copy)]
struct Node {
    /// Index of the first triangle of a leaf, or of the second child of an inner node.
    at: u32,
    /// Number of triangles of a leaf; 0 for an inner node.
    count: u32,
}

/// The box of a node: its lowest and its highest corner.
type Corners = [DVec3; 2];

/// A tree in one pose.
pub(super) struct Posed<'a> {
    tree: &'a Tree,
    points: &'a [DVec3],
    boxes: Vec<Corners>,
}

impl Tree {
    /// Builds the tree of at least one triangle. Each node is divided at the median along the longest side of its box.
    /// `points` are the positions of the vertices.
    pub fn new(mut triangles: Vec<[u32; 3]>, points: &[DVec3]) -> Self {
        let middle =
            |triangle: &[u32; 3]| triangle.map(|vertex| points[vertex as usize]).into_iter().sum::<DVec3>();
        let mut nodes: Vec<Node> = Vec::with_capacity(triangles.len());
        // Ranges of triangles whose nodes are missing, each with the parent of which it is the second child.
        let mut waiting = vec![(0..triangles.len(), None)];
        while let Some((range, parent)) = waiting.pop() {
            let at = nodes.len() as u32;
            if let Some(parent) = parent {
                let parent: &mut Node = &mut nodes[parent];
                parent.at = at;
            }
            if range.len() <= LEAF {
                nodes.push(Node { at: range.start as u32, count: range.len() as u32 });
                continue;
            }
            nodes.push(Node { at: 0, count: 0 });
            let own = &mut triangles[range.clone()];
            let [low, high] = around(own, points);
            let axis = (high - low).max_position();
            let half = own.len() / 2;
            own.select_nth_unstable_by(half, |a, b| {
                middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(b))
            });
            waiting.push((range.start + half..range.end, Some(at as usize)));
            waiting.push((range.start..range.start + half, None));
        }
        Self { nodes, triangles }
    }

    /// The tree in the pose in which the vertices are at `points`.
    pub fn posed<'a>(&'a self, points: &'a [DVec3]) -> Posed<'a> {
        let mut boxes = vec![[DVec3::ZERO; 2]; self.nodes.len()];
        for (at, Node { at: other, count }) in self.nodes.iter().enumerate().rev() {
            boxes[at] = match count {
                0 => {
                    let [one, other] = [boxes[at + 1], boxes[*other as usize]];
                    [one[0].min(other[0]), one[1].max(other[1])]
                }
                count => around(&self.triangles[*other as usize..][..*count as usize], points),
            };
        }
        Posed { tree: self, points, boxes }
    }
}

/// The box around triangles.
fn around(triangles: &[[u32; 3]], points: &[DVec3]) -> Corners {
    let corners = triangles.as_flattened().iter().map(|vertex| points[*vertex as usize]);
    corners
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], point| [low.min(point), high.max(point)])
}

impl Posed<'_> {
    /// The positions of the vertices.
    pub fn points(&self) -> &[DVec3] {
        self.points
    }

    /// The squared distance of a point from a triangle, given by its index in the tree.
    pub fn squared_to(&self, triangle: u32, point: DVec3) -> f64 {
        let corners = self.tree.triangles[triangle as usize].map(|vertex| self.points[vertex as usize]);
        precise_nearest_on_triangle(point, corners).distance_squared(point)
    }

    /// The triangle nearest to a point, as its index in the tree.
    pub fn nearest(&self, point: DVec3) -> u32 {
        let (mut best, mut least) = (0, f64::INFINITY);
        self.search(point, f64::INFINITY, |triangle, squared| {
            if squared < least {
                (best, least) = (triangle, squared);
            }
            ControlFlow::Continue(least)
        });
        best
    }

    /// Whether a triangle lies within a distance of a point. If none does, the result is the squared distance of the
    /// nearest triangle. `known` is the squared distance of any triangle, and `within` that of the sphere.
    pub fn beyond(&self, point: DVec3, known: f64, within: f64) -> Option<f64> {
        let mut least = known;
        self.search(point, known, |_, squared| {
            least = least.min(squared);
            if least <= within { ControlFlow::Break(()) } else { ControlFlow::Continue(least) }
        });
        (least > within).then_some(least)
    }

    /// Visits triangles that may be nearer than `least`, a squared distance. `visit` gets a triangle and its squared
    /// distance, and returns the new value of `least`.
    fn search(&self, point: DVec3, mut least: f64, mut visit: impl FnMut(u32, f64) -> ControlFlow<(), f64>) {
        let squared = |node: usize| {
            let [low, high] = self.boxes[node];
            point.distance_squared(point.clamp(low, high))
        };
        // The depth of the tree is at most 32, and each level waits with one node.
        let mut waiting = [(0_usize, 0.0_f64); 64];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (at, distance) = waiting[count];
            if distance >= least {
                continue;
            }
            let Node { at: other, count: triangles } = self.tree.nodes[at];
            if triangles > 0 {
                for triangle in other..other + triangles {
                    match visit(triangle, self.squared_to(triangle, point)) {
                        ControlFlow::Continue(new) => least = new,
                        ControlFlow::Break(()) => return,
                    }
                }
                continue;
            }
            let [near, far] = [at + 1, other as usize].map(|node| (node, squared(node)));
            let [near, far] = if near.1 <= far.1 { [near, far] } else { [far, near] };
            waiting[count] = far;
            waiting[count + 1] = near;
            count += 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tree finds the triangle that a search of all triangles finds, in the pose in which it was built and in another.
    #[test]
    fn trees_find_the_nearest_triangle() {
        let point = |at: u32, turn: f64| {
            let at = f64::from(at);
            DVec3::new(libm::sin(turn * at), libm::cos(1.7 * turn * at), libm::sin(0.3 + 2.9 * turn * at))
        };
        let points = |turn: f64| (0..300).map(|at| point(at, turn)).collect::<Vec<_>>();
        let triangles: Vec<[u32; 3]> = (0..298).map(|at| [at, at + 1, at + 2]).collect();
        let first = points(0.37);
        let tree = Tree::new(triangles, &first);
        for points in [&first, &points(1.1)] {
            let posed = tree.posed(points);
            for at in 0..200 {
                let wanted = 1.5 * point(at, 0.77);
                let all = (0..298).map(|triangle| posed.squared_to(triangle, wanted));
                let least = all.fold(f64::INFINITY, f64::min);
                assert_eq!(posed.squared_to(posed.nearest(wanted), wanted), least);
                let known = posed.squared_to(at, wanted);
                assert_eq!(posed.beyond(wanted, known, 0.99 * least), (known > 0.0).then_some(least));
                assert_eq!(posed.beyond(wanted, known, 1.01 * least), None);
            }
        }
    }
}
