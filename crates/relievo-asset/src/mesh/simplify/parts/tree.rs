//! A bounding volume tree over the parts of a mesh in one pose.

use glam::DVec3;

/// A node of the tree: a leaf with one part, or an inner node with two children.
struct Node {
    low: DVec3,
    high: DVec3,
    /// Number of parts in this subtree that have not been removed.
    there: u32,
    parent: u32,
    /// For an inner node, the index of the first of two consecutive children; for a leaf, the part.
    first: u32,
    is_leaf: bool,
}

/// A binary tree of bounding boxes. A node's parts are divided along the axis on which their centers are farthest apart.
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// For each part, the index of its leaf.
    leaves: Vec<u32>,
}

impl Tree {
    pub(super) fn new(boxes: &[[DVec3; 2]]) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(2 * boxes.len()), leaves: vec![0; boxes.len()] };
        let all: Vec<u32> = (0..boxes.len() as u32).collect();
        tree.nodes.push(node(boxes, &all, 0));
        let mut open = vec![(0_u32, all)];
        while let Some((at, mut parts)) = open.pop() {
            if let &[part] = parts.as_slice() {
                let leaf = &mut tree.nodes[at as usize];
                (leaf.first, leaf.is_leaf) = (part, true);
                tree.leaves[part as usize] = at;
                continue;
            }
            let middle = |part: &u32| boxes[*part as usize][0] + boxes[*part as usize][1];
            let low = parts.iter().map(middle).fold(DVec3::INFINITY, DVec3::min);
            let high = parts.iter().map(middle).fold(DVec3::NEG_INFINITY, DVec3::max);
            let axis = (high - low).max_position();
            parts.sort_by(|a, b| middle(a)[axis].total_cmp(&middle(b)[axis]));
            let first = tree.nodes.len() as u32;
            tree.nodes[at as usize].first = first;
            let half = parts.split_off(parts.len() / 2);
            for (child, parts) in (first..).zip([parts, half]) {
                tree.nodes.push(node(boxes, &parts, at));
                open.push((child, parts));
            }
        }
        tree
    }

    /// Removes a part from the tree.
    pub(super) fn remove(&mut self, part: u32) {
        let mut at = self.leaves[part as usize];
        loop {
            let node = &mut self.nodes[at as usize];
            node.there -= 1;
            if at == 0 {
                return;
            }
            at = node.parent;
        }
    }

    /// Starts a search from the position `from`. `open` becomes the stack of boxes to visit, with the nearest on top.
    pub(super) fn start(&self, from: DVec3, open: &mut Vec<(f64, u32)>) {
        open.clear();
        self.open(0, from, open);
    }

    /// Continues a search: the next part whose box is nearer than the squared distance `best`.
    pub(super) fn next(&self, from: DVec3, best: f64, open: &mut Vec<(f64, u32)>) -> Option<u32> {
        while let Some((squared, at)) = open.pop() {
            let node = &self.nodes[at as usize];
            if squared >= best {
                continue;
            }
            if node.is_leaf {
                return Some(node.first);
            }
            let start = open.len();
            self.open(node.first, from, open);
            self.open(node.first + 1, from, open);
            // The nearer child is visited first, so it must be last on the stack.
            if open.len() == start + 2 && open[start].0 < open[start + 1].0 {
                open.swap(start, start + 1);
            }
        }
        None
    }

    fn open(&self, at: u32, from: DVec3, open: &mut Vec<(f64, u32)>) {
        let node = &self.nodes[at as usize];
        if node.there > 0 {
            open.push((from.clamp(node.low, node.high).distance_squared(from), at));
        }
    }
}

/// A node around the given parts, without children.
fn node(boxes: &[[DVec3; 2]], parts: &[u32], parent: u32) -> Node {
    let of = |part: &u32| boxes[*part as usize];
    let low = parts.iter().map(|part| of(part)[0]).fold(DVec3::INFINITY, DVec3::min);
    let high = parts.iter().map(|part| of(part)[1]).fold(DVec3::NEG_INFINITY, DVec3::max);
    Node { low, high, there: parts.len() as u32, parent, first: 0, is_leaf: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tree finds the same part as a linear search, while parts are removed one after the other.
    #[test]
    fn the_nearest_box_is_found() {
        let number = |at: u32| f64::from((at.wrapping_mul(0x9e37_79b9) >> 8) % 1000) / 100.0;
        let corner = |at: u32| DVec3::new(number(3 * at), number(3 * at + 1), number(3 * at + 2));
        let boxes: Vec<[DVec3; 2]> =
            (0..60).map(|at| [corner(at), corner(at) + corner(at + 100) * 0.05]).collect();
        let mut tree = Tree::new(&boxes);
        let mut open = Vec::new();
        for gone in 0..60_usize {
            for from in (200..240).map(corner) {
                let squared = |part: usize| from.clamp(boxes[part][0], boxes[part][1]).distance_squared(from);
                let expected = (gone..60).map(squared).fold(f64::INFINITY, f64::min);
                let mut best = f64::INFINITY;
                tree.start(from, &mut open);
                while let Some(part) = tree.next(from, best, &mut open) {
                    assert!(part as usize >= gone, "{part} has gone");
                    best = best.min(squared(part as usize));
                }
                assert_eq!(best, expected);
            }
            tree.remove(gone as u32);
        }
    }
}
