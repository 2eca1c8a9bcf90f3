//! The quadtree of an endless terrain: which nodes a view draws, and which nodes are missing (thesis B sections 4.4 and 5.1.2).
//!
//! A node is a square window of the plane. A node of level 0 has the terrain's finest samples; a node of level l has every 2^l-th
//! sample and covers 4^l nodes of level 0. Its four children cover the same square. Neighbours that are drawn differ by one level at
//! most, so that a border can be morphed onto the coarser neighbour's.

use std::collections::BTreeSet;

/// A node: its level, and its column and row among the nodes of this level. Node (0, 0) of every level begins at the first sample
/// of patch (0, 0).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Node {
    /// The level; 0 is the finest.
    pub level: u32,
    /// Column and row, counted in edges of nodes of this level to the east and to the south.
    pub at: [i32; 2],
}

/// The sides of a node, in the order of [`Leaf::sides`].
pub const SIDES: [[i32; 2]; 4] = [[-1, 0], [1, 0], [0, -1], [0, 1]];

/// The neighbour beyond a side of a node that is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beside {
    /// Nothing: the terrain ends there.
    Nothing,
    /// A node of the same level.
    Same(Node),
    /// A node that is one level coarser.
    Coarser,
    /// Two nodes that are one level finer.
    Finer,
}

/// A node that is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Leaf {
    /// The node.
    pub node: Node,
    /// The neighbours: west, east, north, south.
    pub sides: [Beside; 4],
}

/// The nodes that a view draws. They cover the roots, each place once.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Cover {
    /// The nodes, in ascending order.
    pub leaves: Vec<Leaf>,
    /// The nodes that are drawn as their children.
    pub splits: BTreeSet<Node>,
    /// The nodes whose children are wanted, and are not there.
    pub missing: Vec<Node>,
    /// The splits that are wanted: those of `splits`, and those that are not possible yet.
    pub wanted: Vec<Node>,
}

impl Node {
    /// The node that covers this one, one level coarser.
    #[must_use]
    pub fn parent(self) -> Self {
        Self { level: self.level + 1, at: self.at.map(|at| at.div_euclid(2)) }
    }

    /// The four nodes of the next finer level: north-west, north-east, south-west, south-east. Level 0 has none that exist.
    pub fn children(self) -> [Self; 4] {
        let [column, row] = self.at.map(|at| 2 * at);
        let level = self.level.saturating_sub(1);
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| Self { level, at: [column + x, row + y] })
    }

    /// The node of the same level beside this one.
    #[must_use]
    pub fn beside(self, side: [i32; 2]) -> Self {
        Self {
            level: self.level,
            at: [self.at[0].saturating_add(side[0]), self.at[1].saturating_add(side[1])],
        }
    }

    /// The node of a coarser level that covers this one.
    #[must_use]
    pub fn ancestor(self, level: u32) -> Self {
        let shift = level.saturating_sub(self.level);
        Self { level: self.level.max(level), at: self.at.map(|at| at >> shift) }
    }
}

impl Cover {
    /// Covers `roots`, which have one level, as a view needs it. `is_wanted` is whether a node is too coarse for the view; it is
    /// asked about nodes that are there. `is_there` is whether a node can be drawn; roots always can.
    ///
    /// A node that is wanted finer is drawn as its children if they are there and if no neighbour would differ by two levels.
    /// Neighbours are refined for that, too.
    pub fn new(
        roots: &BTreeSet<Node>,
        mut is_wanted: impl FnMut(Node) -> bool,
        is_there: impl Fn(Node) -> bool,
    ) -> Self {
        let top = roots.first().map_or(0, |root| root.level);
        let has_children = |node: Node| node.children().iter().all(|child| is_there(*child));
        // The splits that are wanted, by level.
        let mut wanted = vec![BTreeSet::new(); top as usize + 2];
        let mut open: Vec<Node> = roots.iter().copied().collect();
        while let Some(node) = open.pop() {
            if node.level > 0 && is_wanted(node) {
                wanted[node.level as usize].insert(node);
                if has_children(node) {
                    open.extend(node.children());
                }
            }
        }
        // A split needs the splits of its own parent and of the parents of its neighbours.
        for level in 1..=top {
            let needed: Vec<Node> = wanted[level as usize].iter().flat_map(|node| needs(*node)).collect();
            let is_covered = |node: &Node| node.level <= top && roots.contains(&node.ancestor(top));
            wanted[level as usize + 1].extend(needed.into_iter().filter(is_covered));
        }
        let mut cover = Self { wanted: wanted.iter().flatten().copied().collect(), ..Self::default() };
        for node in wanted.iter().rev().flatten() {
            if !has_children(*node) {
                cover.missing.push(*node);
                continue;
            }
            let is_split = |other: &Node| {
                other.level > top || !roots.contains(&other.ancestor(top)) || cover.splits.contains(other)
            };
            if needs(*node).iter().all(is_split) {
                cover.splits.insert(*node);
            }
        }
        let mut open: Vec<Node> = roots.iter().copied().collect();
        let mut leaves = Vec::new();
        while let Some(node) = open.pop() {
            match cover.splits.contains(&node) {
                true => open.extend(node.children()),
                false => leaves.push(Leaf { node, sides: SIDES.map(|side| cover.beside(roots, node, side)) }),
            }
        }
        leaves.sort_unstable_by_key(|leaf| leaf.node);
        Self { leaves, ..cover }
    }

    fn beside(&self, roots: &BTreeSet<Node>, node: Node, side: [i32; 2]) -> Beside {
        let (other, top) = (node.beside(side), roots.first().map_or(0, |root| root.level));
        if !roots.contains(&other.ancestor(top)) {
            Beside::Nothing
        } else if self.splits.contains(&other) {
            Beside::Finer
        } else if node.level == top || self.splits.contains(&other.parent()) {
            Beside::Same(other)
        } else {
            Beside::Coarser
        }
    }
}

/// The splits that a split needs: of its parent, and of its neighbours' parents.
fn needs(node: Node) -> [Node; 5] {
    let [west, east, north, south] = SIDES.map(|side| node.beside(side).parent());
    [node.parent(), west, east, north, south]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roots() -> BTreeSet<Node> {
        let at = (-1..1).flat_map(|row| (-1..1).map(move |column| [column, row]));
        at.map(|at| Node { level: 5, at }).collect()
    }

    /// The distance between a point and a node, in edges of level 0.
    fn distance(node: Node, point: [f64; 2]) -> f64 {
        let edge = f64::from(1 << node.level);
        let beyond = |axis: usize| {
            let low = f64::from(node.at[axis]) * edge;
            (low - point[axis]).max(point[axis] - low - edge).max(0.0)
        };
        beyond(0).hypot(beyond(1))
    }

    fn covered(is_there: impl Fn(Node) -> bool, point: [f64; 2], reach: f64) -> Cover {
        let is_wanted = |node: Node| distance(node, point) < reach * f64::from(1 << node.level);
        Cover::new(&roots(), is_wanted, is_there)
    }

    /// Each place is drawn once, neighbours differ by one level at most, and sides tell what lies beside.
    fn check(cover: &Cover) {
        let mut owner = std::collections::BTreeMap::new();
        for leaf in &cover.leaves {
            let edge = 1 << leaf.node.level;
            let [column, row] = leaf.node.at.map(|at| at * edge);
            for at in (0..edge).flat_map(|y| (0..edge).map(move |x| [column + x, row + y])) {
                assert_eq!(owner.insert(at, leaf.node), None, "{at:?} is drawn twice");
            }
        }
        assert_eq!(owner.len(), 64 * 64, "a place is not drawn");
        for leaf in &cover.leaves {
            let edge = 1 << leaf.node.level;
            let [column, row] = leaf.node.at.map(|at| at * edge);
            for (side, [x, y]) in leaf.sides.iter().zip(SIDES) {
                for along in 0..edge {
                    let across = |side: i32| if side < 0 { -1 } else { edge };
                    let at = match x {
                        0 => [column + along, row + across(y)],
                        _ => [column + across(x), row + along],
                    };
                    let expected = match owner.get(&at) {
                        None => Beside::Nothing,
                        Some(other) if other.level == leaf.node.level => Beside::Same(*other),
                        Some(other) if other.level == leaf.node.level + 1 => Beside::Coarser,
                        Some(other) if other.level + 1 == leaf.node.level => Beside::Finer,
                        Some(other) => panic!("{other:?} beside {:?}", leaf.node),
                    };
                    assert_eq!(*side, expected, "{:?} {at:?}", leaf.node);
                }
            }
        }
    }

    #[test]
    fn a_cover_is_whole_and_restricted() {
        for (point, reach) in
            [([0.3, 0.7], 0.01), ([7.5, -3.2], 0.6), ([-31.9, 31.9], 1.5), ([90.0, 0.0], 1.0)]
        {
            let cover = covered(|_| true, point, reach);
            check(&cover);
            assert!(cover.missing.is_empty() && cover.wanted.len() == cover.splits.len());
            let finest = cover.leaves.iter().any(|leaf| leaf.node.level == 0);
            assert_eq!(finest, point[0] < 90.0, "{point:?}");
        }
    }

    /// While nodes are missing, the cover is whole too. It names them; as soon as they are there, it equals the cover of a tree that
    /// has all nodes.
    #[test]
    fn what_is_missing_is_named_until_nothing_is() {
        let (point, reach) = ([7.5, -3.2], 0.6);
        let mut there = roots();
        let mut rounds = 0;
        loop {
            let cover = covered(|node| there.contains(&node), point, reach);
            check(&cover);
            let Some(next) = cover.missing.first() else { break };
            assert!(cover.splits.len() < cover.wanted.len());
            assert!(
                cover.missing.iter().all(|node| !node.children().iter().all(|child| there.contains(child)))
            );
            there.extend(next.children());
            rounds += 1;
        }
        assert!(rounds > 10, "{rounds}");
        assert_eq!(covered(|node| there.contains(&node), point, reach), covered(|_| true, point, reach));
        assert!(there.len() < 300, "{}", there.len());
    }

    #[test]
    fn parents_and_children_agree_on_both_sides_of_the_origin() {
        for at in [[0, 0], [-1, 3], [-8, -7], [5, 1]] {
            let node = Node { level: 3, at };
            assert!(node.children().iter().all(|child| child.parent() == node && child.level == 2));
            assert_eq!(node.children()[3].ancestor(5), node.ancestor(5));
            assert_eq!(node.parent().parent(), node.ancestor(5));
        }
    }
}
