//! What is decided where thesis B contradicts itself on simplification (`docs/sources.md`).

use glam::DVec3;
use relievo::ops::mesh::{Cost, Seams, Simplified, SimplifyOptions};
use relievo_lab::reduce::{Limits, Reducer};

use crate::shapes::{Shape, sphere};

/// A sphere that is drawn out into spikes of many widths, so that triangles around a point differ in size and direction.
fn spiky() -> Shape {
    let mut shape = sphere(28, 20);
    for position in &mut shape.poses[0] {
        let [x, y, z] = position.map(f64::from);
        let turn = (5.0 * x).sin() * (7.0 * y + 1.0).cos() + (6.0 * z + 2.0).sin();
        let stretch = 0.35 + 0.9 * (0.5 + 0.25 * turn).powi(3);
        *position = [x * stretch, 0.6 * y * stretch, z * stretch].map(|axis| axis as f32);
    }
    shape
}

fn simplified(shape: &Shape, check_normals: bool) -> Simplified {
    shape.simplified(&SimplifyOptions { cost: Cost::Melax { check_normals }, ..SimplifyOptions::default() })
}

/// For each collapse, the cosines between the normals of its two points as it found them: with triangles that weigh equally,
/// and with triangles that weigh by area.
fn cosines(shape: &Shape, record: &Simplified) -> Vec<[f64; 2]> {
    let points = shape.points();
    let place = |vertex: u32| DVec3::from(shape.poses[0][vertex as usize].map(f64::from));
    let at = |collapse: usize| {
        let triangles = record.triangles(&shape.indices, collapse);
        let [from, to] = record.moved(collapse)[0].map(|vertex| points[vertex as usize]);
        let sums = |point: u32| {
            let mut sums = [DVec3::ZERO; 2];
            for triangle in triangles.chunks_exact(3) {
                if triangle.iter().any(|corner| points[*corner as usize] == point) {
                    let [a, b, c] = [0, 1, 2].map(|corner| place(triangle[corner]));
                    let normal = (b - a).cross(c - a);
                    sums = [sums[0] + normal.normalize_or_zero(), sums[1] + normal];
                }
            }
            sums.map(DVec3::normalize_or_zero)
        };
        let [from, to] = [from, to].map(sums);
        [from[0].dot(to[0]), from[1].dot(to[1])]
    };
    (0..record.collapses().len()).map(at).collect()
}

#[test]
fn the_check_of_normals_weights_triangles_equally() {
    let shape = spiky();
    let unchecked = cosines(&shape, &simplified(&shape, false));
    let refused =
        |cosines: &[[f64; 2]], which: usize| cosines.iter().filter(|both| both[which] < -1e-9).count();
    assert!(refused(&unchecked, 0) > 0, "no collapse needs the check");
    let checked = cosines(&shape, &simplified(&shape, true));
    assert_eq!(refused(&checked, 0), 0, "a collapse between normals more than 90° apart");
    assert!(refused(&checked, 1) > 0, "weights by area refuse the same");
}

#[test]
fn melax_among_all_reducers_is_without_the_check() {
    let reducer: Reducer = "melax".parse().expect("a reducer");
    assert_eq!(reducer, Reducer::HalfEdge { cost: Cost::Melax { check_normals: false }, seams: Seams::Held });
    let shape = spiky();
    let limits = Limits { triangles: 40, ..Limits::default() };
    let reduced = |reducer: Reducer| reducer.reduce(&shape.bare(), &limits).expect("valid").indices;
    let checked = Reducer::HalfEdge { cost: Cost::Melax { check_normals: true }, seams: Seams::Held };
    assert!(reduced(reducer) != reduced(checked), "the check changes nothing");
}
