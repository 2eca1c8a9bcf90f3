//! Thin features: fingers, ears and blades are there at every error that claims it, as the tests' own measure finds.

use relievo::ops::mesh::{SimplifyOptions, simplify, simplify_within};

use crate::measure::distances;
use crate::shapes::{Shape, bumps, ground, sheet};

/// A closed tube of this length and radius, from `from` upwards, that ends in a point.
fn finger(from: [f64; 3], length: f64, radius: f64) -> Shape {
    sheet([8, 24], |column, row| {
        let turn = std::f64::consts::TAU * (column % 8) as f64 / 8.0;
        let along = row as f64 / 24.0;
        let width = if row == 24 { 0.0 } else { radius * (1.0 - along * along) };
        [from[0] + width * turn.cos(), from[1] + length * along, from[2] - width * turn.sin()]
    })
}

/// Two triangles wide and thirty long, open, and tapering to nothing.
fn blade(from: [f64; 3]) -> Shape {
    sheet([2, 30], |column, row| {
        let along = row as f64 / 30.0;
        let side = (column as f64 - 1.0) * 0.01 * (1.0 - along);
        [from[0] + side, from[1] + along, from[2] + 0.2 * along * along]
    })
}

/// A ground with five fingers and ten blades, and the vertices at their tips.
fn meadow() -> (Shape, Vec<u32>) {
    let mut shape = ground(24, bumps);
    let mut tips = Vec::new();
    for at in 0..15 {
        let place = [0.1 + 0.2 * (at % 5) as f64, 0.2, 0.2 + 0.25 * (at / 5) as f64];
        let other = if at < 5 { finger(place, 0.5, 0.02) } else { blade(place) };
        shape.append(&other);
        tips.push(shape.uv.len() as u32 - 1);
    }
    (shape, tips)
}

/// The largest distance of some vertices from a level.
fn off(shape: &Shape, vertices: &[u32], level: &[u32]) -> f64 {
    let place = |vertex: &u32| shape.poses[0][*vertex as usize];
    let indices: Vec<u32> = (1..=level.len() as u32).collect();
    let distance = |vertex: &u32| {
        let places = std::iter::once(vertex).chain(level).map(place).collect();
        let alone = Shape { poses: vec![places], uv: vec![[0.0; 2]], indices: indices.clone() };
        distances(&alone, 0, &indices)[1]
    };
    vertices.iter().map(distance).fold(0.0, f64::max)
}

#[test]
fn they_survive_the_distance_that_claims_it() {
    let (shape, tips) = meadow();
    let claimed = [0.002, 0.01, 0.03];
    let found = simplify_within(&shape.bare(), &SimplifyOptions::default(), &claimed).expect("valid");
    let mut last = shape.triangles();
    for distance in claimed {
        let level = found.triangles(&shape.indices, found.collapses_near(distance));
        let [_, most] = distances(&shape, 0, &level);
        assert!(most <= f64::from(distance) * 1.001, "{most} of {distance}");
        assert!(off(&shape, &tips, &level) <= f64::from(distance) * 1.001);
        assert!(level.len() / 3 < last, "{} triangles within {distance}", level.len() / 3);
        last = level.len() / 3;
    }
    assert!(4 * last < shape.triangles(), "{last} are left");
}

/// An error is a mean, but no tip is off by more than a few times as much.
#[test]
fn they_survive_the_error_that_claims_it() {
    let (shape, tips) = meadow();
    let found = simplify(&shape.bare(), &SimplifyOptions::default()).expect("valid");
    for error in [0.0005, 0.002, 0.005] {
        let collapses = found.collapses_within(error);
        let level = found.triangles(&shape.indices, collapses);
        let most = off(&shape, &tips, &level);
        assert!(most <= 6.0 * f64::from(error), "{most} of {error}");
        assert!(2 * level.len() < shape.indices.len(), "{} triangles within {error}", level.len() / 3);
    }
    // The measure sees a tip that is gone.
    let rest = found.triangles(&shape.indices, found.collapses().len());
    assert!(off(&shape, &tips, &rest) > 0.02);
}
