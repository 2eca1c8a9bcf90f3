//! Clustering: what cells and their representatives are.

use std::collections::HashMap;

use glam::DVec3;
use relievo_lab::reduce::cluster::Grid;
use relievo_lab::reduce::cluster::reference::cluster;
use relievo_lab::reduce::{Limits, Reducer};

use super::to;
use crate::shapes::{Shape, bumps, cube, ground, shuffled, sphere, torus};

fn places(shape: &Shape) -> Vec<DVec3> {
    shape.poses[0].iter().map(|place| glam::Vec3::from(*place).as_dvec3()).collect()
}

/// Cells, means and sources equal those that f64 gives for exact coordinates; a mean differs by its rounding to quanta, which
/// are 2⁻²⁹ of the largest coordinate or finer, twice, and to f32.
#[test]
fn representatives_are_means() {
    for (seed, cells) in [1, 3, 8, 50, 400, 1024].into_iter().enumerate() {
        // Coordinates are multiples of 2⁻⁹, so that cells of f64 have no rounding.
        let order = shuffled(1 << 20, seed as u64);
        let place =
            |at: usize| [0, 10, 5].map(|shift| (((order[at] >> shift) & 1023) as f32 - 512.0) / 512.0);
        let positions: Vec<[f32; 3]> = (0..3000).map(place).collect();
        let grid = Grid { low: [-1.0; 3], high: [1.0; 3], cells };
        let clustered = cluster(&positions, &[], &grid).expect("valid");
        // From −2³⁰ to 2³⁰ quanta, an edge is a whole number of them.
        let size = f64::from((1_u32 << 31) / cells + 1) / f64::from(1_u32 << 30);
        let mut sums: HashMap<[i64; 3], (Vec<usize>, DVec3)> = HashMap::new();
        for (vertex, position) in positions.iter().enumerate() {
            let at = glam::Vec3::from(*position).as_dvec3();
            let cell = ((at + 1.0) / size).floor().as_i64vec3().to_array();
            let sum = sums.entry(cell).or_default();
            sum.0.push(vertex);
            sum.1 += at;
        }
        assert_eq!(clustered.representatives.len(), sums.len());
        for (vertices, sum) in sums.values() {
            let mean = *sum / vertices.len() as f64;
            let slot = clustered.remap[vertices[0]];
            assert!(vertices.iter().all(|vertex| clustered.remap[*vertex] == slot));
            let found = clustered.representatives[slot as usize];
            let apart = glam::Vec3::from(found.position).as_dvec3() - mean;
            assert!(apart.abs().max_element() < 1.2e-7, "{cells}: {apart}");
            assert!(vertices.contains(&(found.source as usize)));
            let far =
                |vertex: usize| (glam::Vec3::from(positions[vertex]).as_dvec3() - mean).abs().max_element();
            assert!(vertices.iter().all(|vertex| far(*vertex) > far(found.source as usize) - 1e-8));
        }
        // Representatives are in the order of the first vertices of their cells.
        let mut next = 0;
        for slot in &clustered.remap {
            assert!(*slot <= next);
            next = next.max(*slot + 1);
        }
    }
}

/// No vertex moves farther than a cell's diagonal; triangles that stay keep their order and their corners' cells.
#[test]
fn triangles_keep_three_cells() {
    for shape in [sphere(30, 20), torus(30, 20), ground(30, bumps)] {
        for cells in [2, 5, 9, 30] {
            let grid = Grid::around(&shape.poses[0], cells);
            let clustered = cluster(&shape.poses[0], &shape.indices, &grid).expect("valid");
            let longest = (0..3).map(|axis| grid.high[axis] - grid.low[axis]).fold(0.0, f32::max);
            let diagonal = f64::from(longest) / f64::from(cells) * 3.0_f64.sqrt();
            for (vertex, at) in places(&shape).into_iter().enumerate() {
                let to = clustered.representatives[clustered.remap[vertex] as usize].position;
                assert!(at.distance(glam::Vec3::from(to).as_dvec3()) < diagonal * 1.000_001);
            }
            let kept = |triangle: &&[u32]| {
                let [a, b, c] = [0, 1, 2].map(|at| clustered.remap[triangle[at] as usize]);
                a != b && b != c && c != a
            };
            let expected: Vec<u32> = (shape.indices.chunks_exact(3).filter(kept).flatten())
                .map(|vertex| clustered.remap[*vertex as usize])
                .collect();
            assert!(clustered.indices == expected && (cells < 9 || !expected.is_empty()));
            assert_eq!(clustered.triangles.len(), expected.len() / 3);
        }
    }
}

#[test]
fn bad_grids_are_refused() {
    let shape = cube(2);
    let good = Grid::around(&shape.poses[0], 4);
    let refused = |grid: Grid| cluster(&shape.poses[0], &shape.indices, &grid).expect_err("bad").to_string();
    assert_eq!(refused(Grid { cells: 0, ..good }), "grid.cells = 0: must be 1 to 1024");
    assert_eq!(refused(Grid { cells: 1025, ..good }), "grid.cells = 1025: must be 1 to 1024");
    assert_eq!(refused(Grid { low: [0.0, f32::NAN, 0.0], ..good }), "grid.low[1] = NaN: must be finite");
    assert_eq!(
        refused(Grid { high: [1.0, 1.0, -2.0], ..good }),
        "grid.high[2] = -2: must be at least -1, as low"
    );
    let cells = Reducer::UniformClustering { cells: 0 }.reduce(&shape.bare(), &Limits::default());
    assert_eq!(cells.expect_err("bad").path, "grid.cells");
}

/// Without a limit of triangles, uniform clustering is that of the grid that is asked for.
#[test]
fn the_finest_grid_is_taken_where_it_is_fine_enough() {
    let shape = torus(30, 20);
    for cells in [8, 15, 40] {
        let limits = Limits { triangles: usize::MAX, ..Limits::default() };
        let reduced = Reducer::UniformClustering { cells }.reduce(&shape.bare(), &limits).expect("valid");
        let clustered =
            cluster(&shape.poses[0], &shape.indices, &Grid::around(&shape.poses[0], cells)).expect("valid");
        assert_eq!(reduced.triangles, clustered.triangles);
        for (index, slot) in reduced.indices.iter().zip(&clustered.indices) {
            let representative = clustered.representatives[*slot as usize];
            assert_eq!(reduced.poses[0][*index as usize], representative.position);
            assert_eq!(reduced.vertices[*index as usize], representative.source);
        }
        let limits = to(clustered.triangles.len() - 1);
        let fewer = Reducer::UniformClustering { cells }.reduce(&shape.bare(), &limits).expect("valid");
        assert!(fewer.triangles.len() < clustered.triangles.len());
    }
}

/// Vertices of importance clusters are the mesh's own. The corners of a cube have the highest grades and stay; every vertex
/// is as near to one of those that are left as the error says.
#[test]
fn importance_keeps_what_counts() {
    let shape = cube(8);
    let reduced = Reducer::ImportanceClustering.reduce(&shape.bare(), &to(160)).expect("valid");
    let left = &reduced.poses[0];
    for (at, vertex) in left.iter().zip(&reduced.vertices) {
        assert_eq!(*at, shape.poses[0][*vertex as usize]);
    }
    for corner in 0..8 {
        let place = [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 1.0 } else { -1.0_f32 });
        assert!(left.contains(&place), "{place:?}");
    }
    let far = |at: DVec3| {
        let distances = left.iter().map(|other| at.distance(glam::Vec3::from(*other).as_dvec3()));
        distances.fold(f64::INFINITY, f64::min)
    };
    let farthest = places(&shape).into_iter().map(far).fold(0.0, f64::max);
    let error = f64::from(reduced.error);
    assert!((farthest - error).abs() < 1e-6 && error > 0.2, "{farthest} {error}");
}
