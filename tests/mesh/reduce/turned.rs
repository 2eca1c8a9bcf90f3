//! What reducers promise of the sides to which triangles face, step by step.

use std::collections::{HashMap, HashSet};

use glam::DVec3;
use relievo_lab::reduce::{Reduced, Reducer};

use super::to;
use crate::measure::{area, normal};
use crate::shapes::{Shape, bumps, ground, sphere, torus};

/// The normals of a level's triangles, with their corners' origins.
fn normals(reduced: &Reduced) -> Vec<(u32, [u32; 3], DVec3)> {
    let shape = super::shape_of(reduced);
    (reduced.triangles.iter().zip(reduced.indices.chunks_exact(3)))
        .map(|(origin, corners)| {
            let vertices = [0, 1, 2].map(|at| reduced.vertices[corners[at] as usize]);
            (*origin, vertices, normal(&shape, 0, corners))
        })
        .collect()
}

/// Every level of a mesh: a limit for each number of triangles.
fn every_level(reducer: &Reducer, shape: &Shape) -> Vec<Reduced> {
    let limits: Vec<_> = (0..=shape.triangles()).rev().map(to).collect();
    reducer.reduce_each(&shape.bare(), &limits).expect("valid")
}

/// The number of triangles that face another way after a step than before it.
fn turned(levels: &[Reduced]) -> usize {
    let mut turned = 0;
    for two in levels.windows(2).filter(|two| two[0].triangles.len() > two[1].triangles.len()) {
        let before: HashMap<u32, DVec3> =
            normals(&two[0]).into_iter().map(|(origin, _, normal)| (origin, normal)).collect();
        turned +=
            normals(&two[1]).iter().filter(|(origin, _, normal)| normal.dot(before[origin]) <= 0.0).count();
    }
    turned
}

#[test]
fn no_contraction_turns_a_triangle() {
    for reducer in [Reducer::FullEdge, Reducer::VertexPair { distance: 0.1 }] {
        let mut two = sphere(9, 7);
        let mut other = two.clone();
        other.poses[0].iter_mut().for_each(|place| place[0] += 2.05);
        two.append(&other);
        for shape in [ground(12, bumps), ground(9, |_, _| 0.0), torus(14, 9), two] {
            let levels = every_level(&reducer, &shape);
            assert_eq!(turned(&levels), 0, "{}", reducer.name());
        }
    }
    // The check sees a triangle that turns around.
    let mut levels = every_level(&Reducer::FullEdge, &ground(4, bumps));
    levels[8].indices.swap(0, 1);
    assert!(turned(&levels) > 0);
}

/// The new triangles of a hole face the side to which those that were there face on average.
#[test]
fn holes_are_filled_on_the_side_of_their_average_plane() {
    for shape in [ground(12, bumps), sphere(14, 9), torus(14, 9)] {
        let levels = every_level(&Reducer::VertexRemoval, &shape);
        let mut filled = 0;
        for two in levels.windows(2).filter(|two| two[0].triangles.len() > two[1].triangles.len()) {
            let [before, after] = [&two[0], &two[1]].map(normals);
            let known: HashSet<[u32; 3]> = before.iter().map(|(_, corners, _)| *corners).collect();
            let left: HashSet<[u32; 3]> = after.iter().map(|(_, corners, _)| *corners).collect();
            let gone = before.iter().filter(|(_, corners, _)| !left.contains(corners));
            let new: Vec<_> = after.iter().filter(|(_, corners, _)| !known.contains(corners)).collect();
            // Along a seam, each side has an average plane of its own: only that of the whole hole is checked.
            let average: DVec3 = gone.map(|(_, _, normal)| *normal).sum();
            let is_flat = new.iter().all(|(_, _, normal)| normal.dot(average) > 0.0);
            let is_line = new.iter().map(|(origin, ..)| origin).collect::<HashSet<_>>().len() > 1;
            assert!(is_flat || is_line, "{filled}");
            filled += 1;
        }
        assert!(filled > 30, "{filled}");
    }
}

#[test]
fn flat_ground_stays_flat_and_covered() {
    let shape = ground(10, |_, _| 0.5);
    for reducer in [Reducer::FullEdge, Reducer::VertexRemoval, Reducer::VertexPair { distance: 0.0 }] {
        for reduced in every_level(&reducer, &shape).iter().step_by(9) {
            let level = super::shape_of(reduced);
            let whole = area(&shape, 0, &shape.indices);
            let found = area(&level, 0, &level.indices);
            // Corners of the ground are not contracted without an error; until then nothing is lost.
            assert!(reduced.error > 1e-6 || (found - whole).abs() < 1e-5 * whole, "{}", reducer.name());
            assert!(normals(reduced).iter().all(|(_, _, normal)| normal.y > 0.0), "{}", reducer.name());
        }
        let limits = relievo_lab::reduce::Limits { triangles: 0, error: 1e-6 };
        let last = reducer.reduce(&shape.bare(), &limits).expect("valid");
        assert_eq!(last.triangles.len(), 2, "{}", reducer.name());
    }
}
