//! A thousand damaged meshes: each is refused, or its levels are valid.

use std::time::{Duration, Instant};

use relievo::ops::mesh::{Cost, SimplifyOptions, simplify};

use crate::measure::topology;
use crate::shapes::{Shape, bumps, ground, sphere, torus};

/// Numbers from a seed.
struct Random(u64);

impl Random {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        ((self.0 >> 33) as usize) % most.max(1)
    }
}

/// Damages a mesh in one of several ways.
fn damage(shape: &mut Shape, random: &mut Random) {
    let (triangles, vertices) = (shape.triangles(), shape.uv.len());
    let at = 3 * random.below(triangles);
    let vertex = random.below(vertices);
    let place = &mut shape.poses[0][vertex];
    match random.below(10) {
        // The same triangle twice, and its other side.
        0 => shape.indices.extend_from_within(at..at + 3),
        1 => shape.indices.extend([0, 2, 1].map(|corner| shape.indices[at + corner])),
        2 => shape.indices.swap(at, at + 1),
        // A corner twice; a corner far away, so that an edge or a point is not manifold.
        3 => shape.indices[at] = shape.indices[at + 1],
        4 => shape.indices[at] = vertex as u32,
        // A hole.
        5 => drop(shape.indices.drain(at..at + 3)),
        // Vertices that nothing uses, and places that are the same.
        6 => {
            shape.poses[0].push([random.below(9) as f32; 3]);
            shape.uv.push([0.0; 2]);
        }
        7 => shape.poses[0][vertex] = shape.poses[0][random.below(vertices)],
        // Huge, tiny and infinite coordinates.
        8 => place[random.below(3)] *= [1e30, 1e-30, 3e38, -1e20][random.below(4)],
        _ => place[random.below(3)] = [f32::MAX, f32::MIN_POSITIVE, 1e-42, f32::INFINITY][random.below(4)],
    }
}

#[test]
fn damaged_meshes_are_refused_or_valid() {
    let start = Instant::now();
    let (mut refused, mut collapses) = (0, 0);
    for seed in 0..1000 {
        let mut random = Random(seed);
        let mut shape = match seed % 3 {
            0 => ground(8, bumps),
            1 => sphere(10, 7),
            _ => torus(10, 7),
        };
        for _ in 0..1 + random.below(12) {
            damage(&mut shape, &mut random);
        }
        let is_finite = shape.poses[0].as_flattened().iter().all(|x| x.is_finite());
        let cost = [Cost::Quadric, Cost::Melax { check_normals: true }][(seed % 5 == 0) as usize];
        let surface = if seed % 2 == 0 { shape.bare() } else { shape.with_uv() };
        let Ok(found) = simplify(&surface, &SimplifyOptions { cost, ..SimplifyOptions::default() }) else {
            assert!(!is_finite, "{seed} was refused");
            refused += 1;
            continue;
        };
        assert!(is_finite, "{seed} was not refused");
        collapses += found.collapses().len();
        check(seed, &shape, &found);
    }
    assert!(refused > 20 && refused < 500 && collapses > 10_000, "{refused} refused, {collapses} collapses");
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
}

/// Levels have the triangles that they say, of vertices at three places, and no edge has more triangles or becomes open.
fn check(seed: u64, shape: &Shape, found: &relievo::ops::mesh::Simplified) {
    let whole = topology(shape, &found.triangles(&shape.indices, 0));
    let points = shape.points();
    let count = found.collapses().len();
    for collapses in [0, count / 3, count / 2, count] {
        let level = found.triangles(&shape.indices, collapses);
        let left = collapses.checked_sub(1).map(|last| found.collapses()[last].triangles as usize);
        assert!(left.is_none_or(|left| left == level.len() / 3), "{seed} after {collapses}");
        let are_apart = level.chunks_exact(3).all(|corners| {
            let [a, b, c] = [0, 1, 2].map(|at| points[corners[at] as usize]);
            a != b && b != c && c != a
        });
        assert!(are_apart, "{seed} after {collapses}");
        let now = topology(shape, &level);
        assert!(now.most_uses <= whole.most_uses && now.border <= whole.border, "{seed} after {collapses}");
        assert_eq!(now.euler, whole.euler, "{seed} after {collapses}");
    }
    assert!(found.collapses().iter().all(|collapse| collapse.error >= 0.0), "{seed}");
    assert!(found.collapses().iter().map(|collapse| collapse.error).is_sorted(), "{seed}");
}
