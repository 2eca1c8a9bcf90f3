//! The topology of every level of detail.

use relievo::ops::mesh::{Cost, Simplified, SimplifyOptions, Stopped, simplify};

use crate::measure::{Topology, area, topology};
use crate::shapes::{Shape, bare, bumps, cube, ground, shuffled, sphere, torus};

const COSTS: [Cost; 3] =
    [Cost::Quadric, Cost::Melax { check_normals: false }, Cost::Melax { check_normals: true }];

/// Checks a shape that is simplified with texture coordinates and without.
fn each_way(shape: &Shape, mut check: impl FnMut(&Simplified, Cost)) {
    for cost in COSTS {
        let options = SimplifyOptions { cost, prune: false, ..SimplifyOptions::default() };
        check(&shape.simplified(&options), cost);
        check(&simplify(&shape.with_uv(), &options).expect("valid"), cost);
    }
}

/// The topology of every level equals the mesh's, and triangles are as announced.
fn keeps_topology(shape: &Shape, expected: Topology) {
    assert_eq!(topology(shape, &shape.indices), expected);
    each_way(shape, |simplified, cost| {
        for collapses in 0..=simplified.collapses().len() {
            let level = simplified.triangles(&shape.indices, collapses);
            assert_eq!(topology(shape, &level), expected, "{cost:?} after {collapses}");
            let left = collapses.checked_sub(1).map(|last| simplified.collapses()[last].triangles as usize);
            assert_eq!(level.len() / 3, left.unwrap_or(shape.triangles()));
        }
    });
}

#[test]
fn spheres_stay_closed() {
    let shape = sphere(16, 10);
    keeps_topology(&shape, Topology { is_manifold: true, most_uses: 1, border: 0, euler: 2 });
    each_way(&shape, |simplified, cost| {
        assert_eq!((simplified.triangles_left(), simplified.stopped()), (4, Stopped::Topology), "{cost:?}");
    });
}

#[test]
fn tori_keep_their_hole() {
    keeps_topology(&torus(18, 12), Topology { is_manifold: true, most_uses: 1, border: 0, euler: 0 });
}

#[test]
fn charts_stay_together() {
    let shape = cube(6);
    keeps_topology(&shape, Topology { is_manifold: true, most_uses: 1, border: 0, euler: 2 });
    let chart = |vertex: u32| vertex / 49;
    each_way(&shape, |simplified, _| {
        assert_eq!(simplified.triangles_left(), 12);
        let all = (0..simplified.collapses().len()).flat_map(|at| simplified.moved(at));
        for [from, to] in all {
            assert_eq!(chart(*from), chart(*to), "{from} became {to}");
        }
        // The charts are flat, so the area does not change.
        let left = simplified.triangles(&shape.indices, simplified.collapses().len());
        assert!((area(&shape, 0, &left) - area(&shape, 0, &shape.indices)).abs() < 1e-5);
        assert_eq!(left.chunks_exact(3).filter(|corners| chart(corners[0]) != chart(corners[1])).count(), 0);
    });
}

#[test]
fn open_meshes_stay_discs() {
    let shape = ground(12, bumps);
    each_way(&shape, |simplified, _| {
        for collapses in 0..=simplified.collapses().len() {
            let level = topology(&shape, &simplified.triangles(&shape.indices, collapses));
            assert!(level.is_manifold && level.euler == 1, "{level:?} after {collapses}");
        }
    });
}

#[test]
fn tetrahedra_have_no_legal_collapse() {
    let places = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let tetrahedron = bare(places, vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]);
    each_way(&tetrahedron, |simplified, _| {
        assert_eq!((simplified.collapses().len(), simplified.stopped()), (0, Stopped::Topology));
        assert_eq!(simplified.triangles(&tetrahedron.indices, 0), tetrahedron.indices);
    });
    // Two tetrahedra with a common face: an edge of that face has both peaks and the third corner as
    // neighbours. A peak may collapse into a corner of the face if nothing turns around.
    let places =
        vec![[1.0, 0.0, 0.0], [-0.5, 0.0, 0.9], [-0.5, 0.0, -0.9], [0.0, 0.1, 0.0], [0.0, -2.0, 0.0]];
    let double = bare(places, vec![0, 3, 1, 1, 3, 2, 2, 3, 0, 1, 4, 0, 2, 4, 1, 0, 4, 2]);
    keeps_topology(&double, Topology { is_manifold: true, most_uses: 1, border: 0, euler: 2 });
    let simplified = double.simplified(&SimplifyOptions::default());
    assert_eq!(simplified.collapses().len(), 1);
    assert_eq!(simplified.moved(0)[0][0], 3);
    assert_eq!(simplified.triangles_left(), 4);
}

#[test]
fn the_last_triangle_of_a_border_stays() {
    let places = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    each_way(&bare(places, vec![0, 1, 2]), |simplified, _| {
        assert_eq!((simplified.triangles_left(), simplified.stopped()), (1, Stopped::Topology));
    });
}

/// Three sheets that meet in a line, and two that meet in a point.
#[test]
fn points_that_are_not_manifold_stay() {
    let mut fans = ground(6, |_, _| 0.0);
    for turn in 1..3 {
        let mut other = fans.clone();
        other.indices.truncate(6 * 6 * 6);
        let (sin, cos) = (f64::from(turn) * 2.0).sin_cos();
        for place in &mut other.poses[0] {
            *place = [(f64::from(place[0]) * cos) as f32, (f64::from(place[0]) * sin) as f32, place[2]];
        }
        other.poses[0].truncate(49);
        other.uv.truncate(49);
        fans.append(&other);
    }
    let mut tip = ground(6, |_, _| 0.0);
    tip.poses[0].iter_mut().for_each(|place| place[0] += 1.0);
    tip.poses[0].iter_mut().for_each(|place| place[2] += 1.0);
    fans.append(&tip);
    let line = |vertex: u32| fans.poses[0][vertex as usize][0] == 0.0;
    let point = |vertex: u32| fans.poses[0][vertex as usize] == [1.0, 0.0, 1.0];
    each_way(&fans, |simplified, _| {
        assert!(simplified.triangles_left() < fans.triangles() / 2, "{}", simplified.triangles_left());
        for [from, _] in (0..simplified.collapses().len()).flat_map(|at| simplified.moved(at)) {
            assert!(!line(*from) && !point(*from), "{from} went");
        }
    });
}

/// Spheres and tori with triangles missing anywhere: holes, islands, strips, and fans that meet in a point.
#[test]
fn tattered_meshes_keep_their_topology() {
    for seed in 0..60 {
        let mut shape = if seed % 2 == 0 { sphere(10, 7) } else { torus(12, 8) };
        let left = shape.triangles() * (3 + seed as usize % 7) / 10;
        let kept = &shuffled(shape.triangles(), seed)[..left];
        shape.indices = kept.iter().flat_map(|at| shape.indices[*at as usize * 3..][..3].to_vec()).collect();
        let whole = topology(&shape, &shape.indices);
        each_way(&shape, |simplified, cost| {
            let mut border = whole.border;
            for collapses in 0..=simplified.collapses().len() {
                let level = topology(&shape, &simplified.triangles(&shape.indices, collapses));
                assert_eq!(level.most_uses, 1, "{cost:?} {seed} after {collapses}");
                assert_eq!(level.euler, whole.euler, "{cost:?} {seed} after {collapses}");
                assert_eq!(level.is_manifold, whole.is_manifold, "{cost:?} {seed} after {collapses}");
                assert!(level.border <= border);
                border = level.border;
            }
        });
    }
}

/// Triangles with arbitrary corners, where most edges have three triangles or more.
#[test]
fn any_triangles_will_do() {
    let mut collapses = 0;
    for seed in 0..200 {
        let points = 6 + seed as usize % 20;
        let place = |at: u32| [(at * 7 % 5) as f32, (at * 3 % 7) as f32, (at * 5 % 11) as f32];
        let places = (0..points as u32).map(place).collect();
        let indices = (0..4 + seed % 9).flat_map(|at| shuffled(points, seed * 100 + at)[..3].to_vec());
        let shape = bare(places, indices.collect());
        let whole = topology(&shape, &shape.indices);
        each_way(&shape, |simplified, _| {
            collapses += simplified.collapses().len();
            let level = simplified.triangles(&shape.indices, simplified.collapses().len());
            assert_eq!(level.len() / 3, simplified.triangles_left());
            let level = topology(&shape, &level);
            assert!(level.most_uses <= whole.most_uses && level.border <= whole.border);
        });
    }
    assert!(collapses > 100, "{collapses}");
}
