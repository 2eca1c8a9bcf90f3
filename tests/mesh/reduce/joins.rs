//! Which reducers join separate parts, and contractions of points that no edge joins.

use std::collections::HashSet;

use relievo_lab::reduce::{Limits, Reduced, Reducer};

use super::{shape_of, to};
use crate::shapes::{Shape, sphere};

/// Spheres in a row, with gaps of `gap` between them.
fn row(gap: f32) -> Shape {
    let mut all = sphere(12, 9);
    for at in 1..4 {
        let mut other = sphere(12, 9);
        other.poses[0].iter_mut().for_each(|place| place[1] += at as f32 * (2.0 + gap));
        all.append(&other);
    }
    all
}

/// Number of parts that edges connect.
fn parts(reduced: &Reduced) -> usize {
    let shape = shape_of(reduced);
    let points = shape.points();
    let mut parts = points.clone();
    loop {
        let mut is_done = true;
        for triangle in shape.indices.chunks_exact(3) {
            let least = triangle.iter().map(|at| parts[points[*at as usize] as usize]).min().expect("three");
            for at in triangle {
                let part = &mut parts[points[*at as usize] as usize];
                is_done &= *part == least;
                *part = least;
            }
        }
        if is_done {
            let used = shape.indices.iter().map(|at| parts[points[*at as usize] as usize]);
            return used.collect::<HashSet<_>>().len();
        }
    }
}

#[test]
fn vertex_pairs_join_parts_that_are_near() {
    let shape = row(0.1);
    let reduce = |reducer: Reducer| reducer.reduce(&shape.with_uv(), &to(60)).expect("valid");
    assert_eq!(parts(&reduce(Reducer::FullEdge)), 4);
    // The diagonal is 8.7: pairs may lie 0.09 or 0.26 apart.
    assert_eq!(parts(&reduce(Reducer::VertexPair { distance: 0.01 })), 4);
    assert_eq!(parts(&reduce(Reducer::VertexPair { distance: 0.03 })), 1);
}

#[test]
fn bad_distances_and_poses_are_refused() {
    let shape = row(0.1);
    for distance in [-0.1, 1.5, f32::NAN] {
        let refused = Reducer::VertexPair { distance }.reduce(&shape.bare(), &Limits::default());
        assert_eq!(refused.expect_err("bad").to_string(), format!("distance = {distance}: must be 0 to 1"));
    }
    let mut posed = shape.clone();
    posed.poses.push(posed.poses[0].clone());
    for (name, reducer) in Reducer::ALL {
        let result = reducer.reduce(&posed.bare(), &to(100));
        match reducer {
            Reducer::HalfEdge { .. } => assert_eq!(result.expect("valid").poses.len(), 2),
            _ => {
                let expected = format!("poses.len = 2: must be 1 for the reducer {name}");
                assert_eq!(result.expect_err("two poses").to_string(), expected);
            }
        }
    }
}
