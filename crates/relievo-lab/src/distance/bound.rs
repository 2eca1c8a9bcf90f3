//! The largest distance, by branch and bound.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;
use rayon::prelude::*;

use crate::distance::Surface;
use crate::distance::pieces::{Corner, Piece};
use crate::distance::tree::Tree;

/// The number of pieces that are divided at a time, the furthest first, whatever the number of threads.
const BATCH: usize = 1024;

/// The number of triangles whose corners are measured one after another.
const CHUNK: usize = 256;

/// Distances below this fraction of the surfaces' extent count as rounding.
const ROUNDING: f64 = 1e-9;

/// The most divisions, of each triangle and of all together.
const DIVISIONS: [usize; 2] = [64, 1 << 20];

/// A piece with its upper bound, in the order of the bounds, then of their making.
struct Open {
    bound: f64,
    made: usize,
    piece: Piece,
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.made.cmp(&self.made))
    }
}

/// The distance of a point of the surface from the triangles of the tree, and an upper bound of the distance of all points.
/// `seen` is the distance of some point.
pub(super) fn largest(surface: &Surface, tree: &Tree, seen: f64, tolerance: f64, extent: f64) -> (f64, f64) {
    let chunks: Vec<Vec<Piece>> =
        surface.corners.par_chunks(CHUNK).map(|triangles| whole(triangles, tree)).collect();
    let pieces = chunks.concat();
    let squares = pieces.iter().flat_map(|piece| piece.corners).map(|corner| corner.near.squared);
    let reached = squares.fold(seen * seen, f64::max).sqrt();
    let mut search =
        Search { tree, tolerance, extent, reached, closed: reached, made: 0, open: BinaryHeap::new() };
    for batch in pieces.chunks(BATCH * 64) {
        search.add(batch);
    }
    let most = DIVISIONS[0] * pieces.len() + DIVISIONS[1];
    let mut divided = 0;
    while search.open.peek().is_some_and(|open| open.bound > search.limit()) && divided < most {
        divided += search.divide();
    }
    let left = search.open.peek().map_or(0.0, |open| open.bound);
    (search.reached, search.closed.max(left))
}

/// Triangles as pieces. Neighbours in the list are often neighbours in space: each search begins where the last ended.
fn whole(triangles: &[[DVec3; 3]], tree: &Tree) -> Vec<Piece> {
    let mut hint = 0;
    let mut corner = |place: DVec3| {
        let corner = Corner::new(place, tree, hint);
        hint = corner.near.triangle;
        corner
    };
    triangles.iter().map(|triangle| Piece { corners: triangle.map(&mut corner) }).collect()
}

struct Search<'a> {
    tree: &'a Tree,
    tolerance: f64,
    extent: f64,
    /// The largest distance of a point so far.
    reached: f64,
    /// The largest bound of pieces that need no division.
    closed: f64,
    made: usize,
    open: BinaryHeap<Open>,
}

impl Search<'_> {
    /// The largest bound that needs no division.
    fn limit(&self) -> f64 {
        (self.reached * (1.0 + self.tolerance)).max(self.reached + ROUNDING * self.extent)
    }

    /// Bounds pieces, and keeps those that have to be divided.
    fn add(&mut self, pieces: &[Piece]) {
        let enough = self.reached * self.reached;
        let bounds: Vec<f64> =
            (pieces.par_iter()).map(|piece| piece.bound(self.tree, enough).squared.sqrt()).collect();
        let limit = self.limit();
        for (piece, bound) in pieces.iter().zip(bounds) {
            if bound <= limit {
                self.closed = self.closed.max(bound);
            } else {
                self.open.push(Open { bound, made: self.made, piece: *piece });
                self.made += 1;
            }
        }
    }

    /// Divides the pieces with the largest bounds; returns their number.
    fn divide(&mut self) -> usize {
        let limit = self.limit();
        let mut batch = Vec::new();
        while batch.len() < BATCH
            && let Some(open) = self.open.peek()
            && open.bound > limit
        {
            batch.extend(self.open.pop());
        }
        let parts: Vec<_> = batch.par_iter().map(|open| open.piece.divided(self.tree)).collect();
        let (pieces, middles): (Vec<_>, Vec<f64>) = parts.into_iter().unzip();
        let pieces = pieces.concat();
        let corners = pieces.iter().flat_map(|piece| piece.corners).map(|corner| corner.near.squared);
        self.reached =
            corners.chain(middles).fold(self.reached * self.reached, f64::max).sqrt().max(self.reached);
        self.add(&pieces);
        batch.len()
    }
}
