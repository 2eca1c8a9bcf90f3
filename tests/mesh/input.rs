//! Which input of simplification is refused, and which is accepted.

use relievo::ops::mesh::{Cost, SimplifyOptions, Stopped, Surface, simplify};

use crate::shapes::{bare, bumps, ground, shuffled, sphere};

fn refused(surface: Surface<'_>, options: &SimplifyOptions) -> String {
    simplify(&surface, options).expect_err("bad").to_string()
}

#[test]
fn bad_input_is_named() {
    let shape = ground(2, bumps);
    let good = shape.with_uv();
    let all = SimplifyOptions::default();
    assert_eq!(refused(Surface { poses: &[], ..good }, &all), "poses.len = 0: must be at least 1");
    let mut poses = vec![shape.poses[0].clone(), vec![[0.0; 3]; 8]];
    assert_eq!(
        refused(Surface { poses: &poses, ..good }, &all),
        "poses[1].len = 8: must be 9, as of the first pose"
    );
    poses[1] = vec![[0.0; 3]; 9];
    poses[1][7][2] = f32::NAN;
    assert_eq!(refused(Surface { poses: &poses, ..good }, &all), "poses[1][7][2] = NaN: must be finite");
    assert_eq!(
        refused(Surface { indices: &[0, 1, 2, 3], ..good }, &all),
        "indices.len = 4: must be a multiple of 3"
    );
    assert_eq!(
        refused(Surface { indices: &[0, 1, 9], ..good }, &all),
        "indices[2] = 9: must be below 9, the number of vertices"
    );
    assert_eq!(refused(Surface { stride: 3, ..good }, &all), "attributes.len = 18: must be 9 vertices × 3");
    let mut uv = shape.uv.as_flattened().to_vec();
    uv[5] = f32::INFINITY;
    assert_eq!(refused(Surface { attributes: &uv, ..good }, &all), "attributes[2][1] = inf: must be finite");
    for error in [-1.0, f32::NAN] {
        let options = SimplifyOptions { error, ..all };
        assert_eq!(refused(good, &options), format!("error = {error}: must be at least 0"));
    }
}

#[test]
fn nothing_to_do_is_fine() {
    let empty = bare(Vec::new(), Vec::new());
    let simplified = empty.simplified(&SimplifyOptions { triangles: 10, ..SimplifyOptions::default() });
    assert_eq!((simplified.stopped(), simplified.triangles(&[], 0)), (Stopped::Triangles, Vec::new()));
    let shape = ground(4, bumps);
    let simplified = shape.simplified(&SimplifyOptions { triangles: 32, ..SimplifyOptions::default() });
    assert_eq!((simplified.stopped(), simplified.collapses().len()), (Stopped::Triangles, 0));
    assert_eq!(simplified.triangles(&shape.indices, 0), shape.indices);
    let loose = bare(vec![[0.0; 3]; 5], Vec::new());
    assert_eq!(loose.simplified(&SimplifyOptions::default()).remap(0), [0, 1, 2, 3, 4]);
}

#[test]
fn triangles_without_area_do_no_harm() {
    for cost in [Cost::Quadric, Cost::Melax { check_normals: true }] {
        let mut shape = ground(8, bumps);
        // A triangle with one corner twice, one with all corners at one place, and three points in line on a
        // split edge.
        shape.indices.extend([3, 3, 4]);
        shape.poses[0].extend([[0.5; 3]; 3]);
        shape.uv.extend([[0.5; 2]; 3]);
        shape.indices.extend([81, 82, 83]);
        shape.indices.extend([0, 1, 0]);
        let simplified = shape.simplified(&SimplifyOptions { cost, ..SimplifyOptions::default() });
        assert!(simplified.triangles_left() < 16, "{cost:?}");
        assert_eq!(simplified.triangles(&shape.indices, 0).len(), 128 * 3);
        // All vertices are at one place in one pose.
        let poses = [vec![[1.0; 3]; 84], shape.poses[0].clone()];
        let surface = Surface { poses: &poses, ..shape.bare() };
        let simplified =
            simplify(&surface, &SimplifyOptions { cost, ..SimplifyOptions::default() }).expect("valid");
        assert!(simplified.triangles_left() < 16, "{cost:?}");
    }
    let line: Vec<[f32; 3]> = (0..9).map(|at| [at as f32, at as f32 * 2.0, 0.1]).collect();
    let indices = (0..7).flat_map(|at| [at, at + 1, at + 2]).collect();
    let simplified = bare(line, indices).simplified(&SimplifyOptions::default());
    assert_eq!(simplified.error(), 0.0);
}

#[test]
fn the_limits_are_kept() {
    let shape = ground(24, bumps);
    let all = shape.simplified(&SimplifyOptions::default());
    for triangles in [1151, 700, 301, 40] {
        let some = shape.simplified(&SimplifyOptions { triangles, ..SimplifyOptions::default() });
        assert!((triangles - 1..=triangles).contains(&some.triangles_left()));
        assert_eq!(some.stopped(), Stopped::Triangles);
        // The shorter list of collapses is the beginning of the longer one.
        assert_eq!(some.collapses(), &all.collapses()[..all.collapses_to(triangles)]);
    }
    for error in [2e-3, 5e-3, 1e-2] {
        let some = shape.simplified(&SimplifyOptions { error, ..SimplifyOptions::default() });
        assert_eq!(some.stopped(), Stopped::Error);
        let within = all.collapses_within(error);
        assert_eq!(some.collapses(), &all.collapses()[..within]);
        assert!(some.error() <= error && all.collapses()[within].error > error);
    }
}

#[test]
fn levels_agree_with_heirs() {
    let shape = sphere(12, 8);
    let points = shape.points();
    for surface in [shape.bare(), shape.with_uv()] {
        let simplified = simplify(&surface, &SimplifyOptions::default()).expect("valid");
        let mut remap: Vec<u32> = (0..shape.uv.len() as u32).collect();
        for collapses in 0..=simplified.collapses().len() {
            if let Some(last) = collapses.checked_sub(1) {
                for [from, to] in simplified.moved(last) {
                    assert_eq!(remap[*from as usize], *from, "it went before");
                    assert_eq!(remap[*to as usize], *to, "it is gone");
                    remap.iter_mut().filter(|target| *target == from).for_each(|target| *target = *to);
                }
            }
            assert_eq!(simplified.remap(collapses), remap);
            let level =
                shape.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|at| remap[corners[at] as usize]));
            let is_left = |corners: &[u32; 3]| {
                let [a, b, c] = corners.map(|corner| points[corner as usize]);
                a != b && b != c && c != a
            };
            let level: Vec<u32> = level.filter(is_left).flatten().collect();
            assert_eq!(simplified.triangles(&shape.indices, collapses), level);
        }
    }
}

/// The order of triangles decides nothing but ties.
#[test]
fn the_same_mesh_gives_the_same_collapses() {
    let shape = ground(24, |x, z| bumps(x, z) + 0.01 * (x * x * 31.0 + z * 17.0).sin());
    let whole = shape.simplified(&SimplifyOptions::default());
    assert_eq!(shape.simplified(&SimplifyOptions::default()), whole);
    let mut other = shape.clone();
    let order = shuffled(shape.triangles(), 3);
    other.indices = order.iter().flat_map(|at| shape.indices[*at as usize * 3..][..3].to_vec()).collect();
    let again = other.simplified(&SimplifyOptions { triangles: 300, ..SimplifyOptions::default() });
    for (at, collapse) in again.collapses().iter().enumerate() {
        assert_eq!(again.moved(at), whole.moved(at));
        assert!((collapse.error - whole.collapses()[at].error).abs() <= 1e-5 * collapse.error);
    }
}

/// The sizes are powers of two, so that nothing is rounded.
#[test]
fn size_does_not_matter() {
    let shape = ground(12, bumps);
    for cost in [Cost::Quadric, Cost::Melax { check_normals: true }] {
        let options = SimplifyOptions { cost, ..SimplifyOptions::default() };
        let whole = shape.simplified(&options);
        for exponent in [-100, 120] {
            let scale = 2.0_f32.powi(exponent);
            let mut other = shape.clone();
            other.poses[0].as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
            let scaled = other.simplified(&options);
            assert_eq!(scaled.collapses().len(), whole.collapses().len());
            for (at, [a, b]) in
                scaled.collapses().iter().zip(whole.collapses()).map(|(a, b)| [a, b]).enumerate()
            {
                assert_eq!((scaled.moved(at), a.error), (whole.moved(at), b.error * scale), "{exponent}");
            }
        }
    }
}
