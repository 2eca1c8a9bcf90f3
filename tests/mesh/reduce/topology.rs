//! What reducers promise of topology and seams.

use std::collections::HashMap;

use relievo::ops::mesh::Stopped;
use relievo_lab::reduce::{Reduced, Reducer};

use super::{CHANGING, KEEPING, levels, shape_of};
use crate::measure::topology;
use crate::shapes::{Shape, bumps, cube, ground, shuffled, sphere, torus};

/// A torus and a sphere of which one in some triangles is missing.
fn tattered(seed: u64) -> Shape {
    let mut shape = if seed.is_multiple_of(2) { sphere(10, 7) } else { torus(12, 8) };
    let left = shape.triangles() * (5 + seed as usize % 5) / 10;
    let kept = &shuffled(shape.triangles(), seed)[..left];
    shape.indices = kept.iter().flat_map(|at| shape.indices[*at as usize * 3..][..3].to_vec()).collect();
    shape
}

#[test]
fn closed_stays_closed() {
    for (shape, least) in [(sphere(24, 14), 100), (torus(24, 12), 60), (cube(7), 12)] {
        let whole = topology(&shape, &shape.indices);
        assert!(whole.is_manifold && whole.border == 0);
        for reducer in KEEPING {
            for surface in [shape.bare(), shape.with_uv()] {
                for reduced in levels(&reducer, &surface) {
                    let level = shape_of(&reduced);
                    let found = topology(&level, &level.indices);
                    assert_eq!(found, whole, "{} at {}", reducer.name(), level.triangles());
                }
                let last = levels(&reducer, &surface).pop().expect("levels");
                assert!(![Stopped::Triangles, Stopped::Error].contains(&last.stopped), "{:?}", last.stopped);
                assert!(
                    last.triangles.len() <= least,
                    "{}: {} of {}",
                    reducer.name(),
                    last.triangles.len(),
                    shape.triangles()
                );
            }
        }
    }
}

#[test]
fn open_and_tattered_meshes_keep_their_topology() {
    let mut shapes: Vec<Shape> = (0..20).map(tattered).collect();
    shapes.push(ground(14, bumps));
    for shape in &shapes {
        let whole = topology(shape, &shape.indices);
        for reducer in KEEPING {
            for surface in [shape.bare(), shape.with_uv()] {
                for reduced in levels(&reducer, &surface) {
                    let level = shape_of(&reduced);
                    let found = topology(&level, &level.indices);
                    let name = format!("{} at {}", reducer.name(), level.triangles());
                    assert_eq!((found.most_uses, found.euler), (1, whole.euler), "{name}");
                    assert!(found.is_manifold == whole.is_manifold && found.border <= whole.border, "{name}");
                }
            }
        }
    }
}

/// For each edge the number of triangles on one side less that on the other.
fn one_sided(reduced: &Reduced) -> usize {
    let shape = shape_of(reduced);
    let points = shape.points();
    let mut sides: HashMap<[u32; 2], i32> = HashMap::new();
    for triangle in shape.indices.chunks_exact(3) {
        for at in 0..3 {
            let [a, b] = [at, (at + 1) % 3].map(|corner| points[triangle[corner] as usize]);
            *sides.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    sides.values().filter(|side| **side != 0).count()
}

#[test]
fn where_topology_changes_edges_have_as_many_triangles_on_either_side() {
    for shape in [sphere(24, 14), torus(24, 12), cube(7)] {
        for reducer in KEEPING.iter().chain(&CHANGING) {
            for reduced in levels(reducer, &shape.with_uv()) {
                assert_eq!(one_sided(&reduced), 0, "{} at {}", reducer.name(), reduced.triangles.len());
            }
        }
    }
    // The check sees a missing triangle.
    let mut open = levels(&Reducer::FullEdge, &sphere(8, 6).bare()).swap_remove(2);
    open.indices.truncate(open.indices.len() - 3);
    assert_eq!(one_sided(&open), 3);
}

/// Each chart of the cube is flat and square. Where seams stay, no triangle has vertices of two charts, and the charts keep
/// their areas; the texture coordinates of the charts are linear in positions, and stay so if they are interpolated.
#[test]
fn seams_stay_seams() {
    let shape = cube(6);
    let chart = |vertex: &u32| vertex / 49;
    let reducers = KEEPING.iter().chain(&[Reducer::VertexPair { distance: 0.02 }]);
    for reducer in reducers {
        for reduced in levels(reducer, &shape.with_uv()) {
            let name = format!("{} at {}", reducer.name(), reduced.triangles.len());
            for (triangle, corners) in reduced.triangles.iter().zip(reduced.indices.chunks_exact(3)) {
                let own = chart(&shape.indices[*triangle as usize * 3]);
                for corner in corners {
                    let vertex = reduced.vertices[*corner as usize];
                    assert_eq!(chart(&vertex), own, "{name}");
                    if reducer.name() != "vertex-pair" {
                        let uv = uv_at(own, reduced.poses[0][*corner as usize]);
                        let found = &reduced.attributes[*corner as usize * 2..][..2];
                        let apart = (uv[0] - found[0]).abs().max((uv[1] - found[1]).abs());
                        assert!(apart < 2e-3, "{name}: {uv:?} and {found:?}");
                    }
                }
            }
        }
        let last = levels(reducer, &shape.with_uv()).pop().expect("levels");
        assert!(last.triangles.len() <= 12, "{}: {}", reducer.name(), last.triangles.len());
    }
}

/// The texture coordinates of a place on a face of the cube of [`cube`].
fn uv_at(face: u32, place: [f32; 3]) -> [f32; 2] {
    let (axis, side) = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)][face as usize];
    [(place[(axis + 1) % 3] * side + 1.0) / 2.0, (place[(axis + 2) % 3] + 1.0) / 2.0]
}
