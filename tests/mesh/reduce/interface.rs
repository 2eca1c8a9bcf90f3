//! What holds for every reducer: names, limits, and what is refused.

use relievo::ops::mesh::{Cost, Seams, SimplifyOptions, Stopped, Surface, simplify};
use relievo_lab::reduce::{Limits, Reducer};

use crate::shapes::{bare, bumps, cube, ground, sphere};

#[test]
fn names_are_read_back() {
    for (name, reducer) in Reducer::ALL {
        assert_eq!((name.parse::<Reducer>(), reducer.name()), (Ok(reducer), name));
    }
    let names = Reducer::ALL.map(|(name, _)| name).join(", ");
    let refused = "quadrics".parse::<Reducer>().expect_err("no name").to_string();
    assert_eq!(refused, format!("reducer = quadrics: must be one of {names}"));
}

#[test]
fn bad_input_is_refused_by_all() {
    let shape = ground(3, bumps);
    for (name, reducer) in Reducer::ALL {
        let refused = |surface, error| {
            let limits = Limits { triangles: 4, error };
            reducer.reduce(&surface, &limits).expect_err(name).to_string()
        };
        let good = shape.with_uv();
        assert_eq!(refused(good, -1.0), "limits[0].error = -1: must be at least 0", "{name}");
        assert_eq!(refused(good, f32::NAN), "limits[0].error = NaN: must be at least 0", "{name}");
        let bad = Surface { indices: &[0, 1, 99], ..good };
        assert_eq!(refused(bad, 1.0), "indices[2] = 99: must be below 16, the number of vertices", "{name}");
        let bad = Surface { poses: &[], ..good };
        assert_eq!(refused(bad, 1.0), "poses.len = 0: must be at least 1", "{name}");
    }
}

#[test]
fn nothing_to_do_is_fine_for_all() {
    for (name, reducer) in Reducer::ALL {
        let empty = reducer.reduce(&bare(Vec::new(), Vec::new()).bare(), &Limits::default()).expect("valid");
        assert_eq!((empty.indices.len(), empty.poses[0].len(), empty.error), (0, 0, 0.0), "{name}");
        assert!(reducer.reduce_each(&cube(2).bare(), &[]).expect("valid").is_empty());
        let loose = bare(vec![[1.0, 2.0, 3.0]; 5], vec![0, 1, 2]);
        let reduced = reducer.reduce(&loose.bare(), &Limits::default()).expect("valid");
        assert_eq!(reduced.indices.len(), 0, "{name}: triangles without area are dropped");
    }
}

/// Each result of several limits is that of its limit alone, and keeps it.
#[test]
fn several_limits_give_what_each_gives_alone() {
    let shape = sphere(20, 12);
    let limits = [(200, f32::INFINITY), (40, f32::INFINITY), (120, 0.02), (0, 0.1), (0, 0.0), (90, 9.0)];
    let limits = limits.map(|(triangles, error)| Limits { triangles, error });
    for (name, reducer) in Reducer::ALL {
        let all = reducer.reduce_each(&shape.with_uv(), &limits).expect("valid");
        for (limit, reduced) in limits.iter().zip(all) {
            let alone = reducer.reduce(&shape.with_uv(), limit).expect("valid");
            assert!(alone == reduced, "{name} {limit:?}");
            assert!(reduced.error <= limit.error, "{name} {limit:?}: {}", reduced.error);
            let is_reached = reduced.indices.len() / 3 <= limit.triangles;
            assert_eq!(reduced.stopped == Stopped::Triangles, is_reached, "{name} {limit:?}");
        }
    }
}

#[test]
fn half_edges_are_those_of_simplify() {
    let shape = cube(5);
    for cost in [Cost::Quadric, Cost::Melax { check_normals: true }] {
        let simplified = simplify(&shape.with_uv(), &SimplifyOptions { cost, ..SimplifyOptions::default() })
            .expect("valid");
        let reduced = Reducer::HalfEdge { cost, seams: Seams::Held }
            .reduce(&shape.with_uv(), &Limits { triangles: 50, ..Limits::default() })
            .expect("valid");
        let expected = simplified.triangles(&shape.indices, simplified.collapses_to(50));
        let corners: Vec<u32> = reduced.indices.iter().map(|at| reduced.vertices[*at as usize]).collect();
        assert_eq!(corners, expected);
        for (at, vertex) in reduced.vertices.iter().enumerate() {
            assert_eq!(reduced.poses[0][at], shape.poses[0][*vertex as usize]);
            assert_eq!(reduced.attributes[at * 2..][..2], shape.uv[*vertex as usize]);
        }
    }
}
