//! Triangles in a tree of boxes, for the point on any of them that is nearest to another.

use glam::DVec3;
use relievo::mesh::nearest::precise_nearest_on_triangle;

/// The most triangles of a leaf.
const LEAF: usize = 4;

/// Triangles in a tree of boxes.
pub(super) struct Tree {
    nodes: Vec<Node>,
    triangles: Vec<[DVec3; 3]>,
}

/// A box around triangles. An inner node has two children, one after the other.
struct Node {
    low: DVec3,
    high: DVec3,
    /// The first triangle of a leaf, or the first child.
    first: usize,
    /// Triangles of a leaf; 0 for an inner node.
    count: usize,
}

impl Tree {
    /// A tree of at least one triangle.
    pub fn new(mut triangles: Vec<[DVec3; 3]>) -> Self {
        let mut nodes = vec![Node::around(&triangles)];
        split(&mut nodes, 0, &mut triangles, 0);
        Self { nodes, triangles }
    }

    /// The point on any triangle that is nearest to `point`. `known` is one that lies on a triangle, if any is known; the nearer
    /// it is, the less is searched.
    pub fn nearest(&self, point: DVec3, known: Option<DVec3>) -> DVec3 {
        let mut best = known.map_or((f64::INFINITY, point), |known| (known.distance_squared(point), known));
        self.visit(0, point, &mut best);
        best.1
    }

    fn visit(&self, at: usize, point: DVec3, best: &mut (f64, DVec3)) {
        let node = &self.nodes[at];
        if node.count > 0 {
            for corners in &self.triangles[node.first..][..node.count] {
                let found = precise_nearest_on_triangle(point, *corners);
                let distance = found.distance_squared(point);
                if distance < best.0 {
                    *best = (distance, found);
                }
            }
            return;
        }
        let mut children =
            [node.first, node.first + 1].map(|child| (self.nodes[child].distance(point), child));
        if children[1].0 < children[0].0 {
            children.reverse();
        }
        for (distance, child) in children {
            if distance < best.0 {
                self.visit(child, point, best);
            }
        }
    }
}

impl Node {
    fn around(triangles: &[[DVec3; 3]]) -> Self {
        let corners = || triangles.iter().flatten();
        let low = corners().fold(DVec3::INFINITY, |low, corner| low.min(*corner));
        let high = corners().fold(DVec3::NEG_INFINITY, |high, corner| high.max(*corner));
        Self { low, high, first: 0, count: triangles.len() }
    }

    /// The square of the distance of a point from the box.
    fn distance(&self, point: DVec3) -> f64 {
        point.clamp(self.low, self.high).distance_squared(point)
    }
}

/// Splits a leaf, whose triangles begin at `first`, in the middle of its longest side.
fn split(nodes: &mut Vec<Node>, at: usize, triangles: &mut [[DVec3; 3]], first: usize) {
    nodes[at].first = first;
    if triangles.len() <= LEAF {
        return;
    }
    let size = nodes[at].high - nodes[at].low;
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
    let center = |corners: &[DVec3; 3]| corners.iter().map(|corner| corner[axis]).sum::<f64>();
    let half = triangles.len() / 2;
    triangles.select_nth_unstable_by(half, |a, b| center(a).total_cmp(&center(b)));
    let (below, above) = triangles.split_at_mut(half);
    let children = nodes.len();
    (nodes[at].first, nodes[at].count) = (children, 0);
    nodes.extend([Node::around(below), Node::around(above)]);
    split(nodes, children, below, first);
    split(nodes, children + 1, above, first + half);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_triangle_is_nearer() {
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
        let tree = Tree::new(triangles.clone());
        for at in 0..300 {
            let point = 6.0 * corner(11 * at + 1);
            let least = (triangles.iter())
                .map(|corners| precise_nearest_on_triangle(point, *corners).distance(point))
                .fold(f64::INFINITY, f64::min);
            assert_eq!(tree.nearest(point, None).distance(point), least, "{at}");
            let known = triangles[at % 97].iter().sum::<DVec3>() / 3.0;
            assert_eq!(tree.nearest(point, Some(known)).distance(point), least, "{at}");
        }
        let one = Tree::new(vec![[DVec3::X; 3]]);
        assert_eq!(one.nearest(DVec3::ZERO, None), DVec3::X);
        assert_eq!(one.nearest(DVec3::ZERO, Some(DVec3::X)), DVec3::X);
    }
}
