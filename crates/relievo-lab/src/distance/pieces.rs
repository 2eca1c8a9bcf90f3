//! Pieces of triangles, and how they are divided.

use glam::DVec3;

use crate::distance::tree::{Near, Tree};

/// A cut leaves at least this fraction of the piece's extent across it on either side.
const LEAST_PART: f64 = 0.05;

/// A point of a surface, with the nearest triangle of the other.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub place: DVec3,
    pub near: Near,
}

impl Corner {
    /// A point, and its distance. `hint` is a triangle that may be near.
    pub fn new(place: DVec3, tree: &Tree, hint: u32) -> Self {
        Self { place, near: tree.nearest(place, hint) }
    }
}

/// A part of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub corners: [Corner; 3],
}

impl Piece {
    /// The triangle from which the piece's furthest corner is least far: no point of the piece is further from the surface.
    /// Any triangle will do that is within a distance whose square is `enough`.
    pub fn bound(&self, tree: &Tree, enough: f64) -> Near {
        let places = self.corners.map(|corner| corner.place);
        let near = self.corners.map(|corner| tree.furthest(&places, corner.near.triangle));
        let best = near.into_iter().min_by(|a, b| a.squared.total_cmp(&b.squared)).unwrap_or(near[0]);
        tree.nearest_to_all(&places, best, enough)
    }

    /// The parts of the piece, and the square of the distance of its middle.
    pub fn divided(&self, tree: &Tree) -> (Vec<Piece>, f64) {
        let [a, b, c] = self.corners.map(|corner| corner.place);
        let middle = Corner::new((a + b + c) / 3.0, tree, self.corners[0].near.triangle);
        let sides = self.side(tree.triangle(middle.near.triangle)).unwrap_or_else(|| self.halves());
        (self.cut(sides, tree), middle.near.squared)
    }

    /// How far the corners lie inside of the side of a triangle that cuts the piece where it reaches out furthest. The
    /// side is the plane through an edge, along the triangle's normal. `None` if no side divides the piece.
    fn side(&self, triangle: [DVec3; 3]) -> Option<[f64; 3]> {
        let [a, b, c] = triangle;
        let normal = (b - a).cross(c - a);
        let mut found = None;
        let mut furthest = 0.0;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let inwards = normal.cross(to - from).normalize_or_zero();
            let inside = self.corners.map(|corner| inwards.dot(corner.place - from));
            let low = inside.into_iter().fold(f64::INFINITY, f64::min);
            let high = inside.into_iter().fold(f64::NEG_INFINITY, f64::max);
            if -low > furthest && high.min(-low) > LEAST_PART * (high - low) {
                (found, furthest) = (Some(inside), -low);
            }
        }
        found
    }

    /// As [`Piece::side`], for a plane through a corner and the middle of the longest edge.
    fn halves(&self) -> [f64; 3] {
        let [a, b, c] = self.corners.map(|corner| corner.place);
        let [ab, bc, ca] = [a.distance_squared(b), b.distance_squared(c), c.distance_squared(a)];
        if ab >= bc && ab >= ca {
            [1.0, -1.0, 0.0]
        } else if bc >= ca {
            [0.0, 1.0, -1.0]
        } else {
            [-1.0, 0.0, 1.0]
        }
    }

    /// Divides the piece where `inside`, linear between the corners, is 0.
    fn cut(&self, inside: [f64; 3], tree: &Tree) -> Vec<Piece> {
        let mut sides: [Vec<Corner>; 2] = Default::default();
        for at in 0..3 {
            let (here, next) = (self.corners[at], self.corners[(at + 1) % 3]);
            let (own, other) = (inside[at], inside[(at + 1) % 3]);
            if own >= 0.0 {
                sides[0].push(here);
            }
            if own <= 0.0 {
                sides[1].push(here);
            }
            if own * other < 0.0 {
                let place = here.place + (next.place - here.place) * (own / (own - other));
                let between = Corner::new(place, tree, here.near.triangle);
                sides.iter_mut().for_each(|side| side.push(between));
            }
        }
        sides.iter().flat_map(|side| Self::of_polygon(side)).collect()
    }

    /// A triangle, or a quadrangle along its shorter diagonal.
    fn of_polygon(corners: &[Corner]) -> Vec<Piece> {
        match *corners {
            [a, b, c] => vec![Piece { corners: [a, b, c] }],
            [a, b, c, d] => match a.place.distance_squared(c.place) <= b.place.distance_squared(d.place) {
                true => vec![Piece { corners: [a, b, c] }, Piece { corners: [a, c, d] }],
                false => vec![Piece { corners: [a, b, d] }, Piece { corners: [b, c, d] }],
            },
            _ => Vec::new(),
        }
    }
}
