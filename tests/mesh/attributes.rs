//! Attributes of simplified meshes, and their seams.

use relievo::ops::mesh::{Cost, SimplifyOptions, Surface, simplify};

use crate::measure::topology;
use crate::shapes::{Shape, cube, ground, sheet, sphere, torus};

/// Twice the area of all triangles on the texture.
fn uv_area(shape: &Shape, indices: &[u32]) -> f64 {
    let corner = |index: u32| glam::Vec2::from(shape.uv[index as usize]).as_dvec2();
    let area = |triangle: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|at| corner(triangle[at]));
        (b - a).perp_dot(c - a)
    };
    indices.chunks_exact(3).map(area).sum()
}

/// The texture is one square whose border is the seam. As long as the seam stays in place, and no triangle
/// takes corners from both sides, signed areas sum to the square's.
#[test]
fn seams_hold() {
    let shape = torus(20, 12);
    for cost in [Cost::Quadric, Cost::Melax { check_normals: false }] {
        for surface in [shape.bare(), shape.with_uv()] {
            let simplified =
                simplify(&surface, &SimplifyOptions { cost, ..SimplifyOptions::default() }).expect("valid");
            assert!(simplified.triangles_left() < 40, "{cost:?} {}", simplified.triangles_left());
            for collapses in 0..=simplified.collapses().len() {
                let area = uv_area(&shape, &simplified.triangles(&shape.indices, collapses));
                assert!((area - 2.0).abs() < 1e-5, "{area} after {collapses}");
            }
        }
    }
}

/// Every wedge of a collapsed point becomes one of its neighbour's. Wedges with triangles become one with which
/// they share an edge, except those around a pole.
#[test]
fn every_wedge_finds_an_heir() {
    for (shape, poles) in [(torus(14, 8), 0), (sphere(14, 8), 2), (cube(4), 0)] {
        let points = shape.points();
        let simplified = simplify(&shape.with_uv(), &SimplifyOptions::default()).expect("valid");
        let mut strangers = 0;
        for collapse in 0..simplified.collapses().len() {
            let before = simplified.triangles(&shape.indices, collapse);
            let moved = simplified.moved(collapse);
            let [from, to] = moved[0].map(|vertex| points[vertex as usize]);
            let wedges = points.iter().filter(|point| **point == from).count();
            assert_eq!(moved.len(), wedges);
            assert!(moved.iter().all(|pair| pair.map(|vertex| points[vertex as usize]) == [from, to]));
            let share = |pair: &&[u32; 2]| {
                let has = |vertex: u32| move |triangle: &&[u32]| triangle.contains(&vertex);
                before.chunks_exact(3).filter(has(pair[0])).any(|triangle| triangle.contains(&pair[1]))
            };
            let is_used = |pair: &&[u32; 2]| before.contains(&pair[0]);
            let stranger = moved.iter().filter(is_used).any(|pair| !share(&pair));
            strangers += usize::from(stranger);
        }
        assert!(strangers <= poles, "{strangers}");
    }
}

/// A disc in polar coordinates: its middle has a wedge per sector, each with a texture coordinate of its own.
#[test]
fn poles_go_too() {
    let shape = sheet([12, 3], |column, row| {
        let turn = std::f64::consts::TAU * (column % 12) as f64 / 12.0;
        let radius = row as f64;
        [radius * turn.cos(), radius * turn.sin(), 0.0]
    });
    let simplified = shape.simplified(&SimplifyOptions { error: 1e-6, ..SimplifyOptions::default() });
    assert_eq!(simplified.triangles_left(), 10);
    let gone =
        (0..simplified.collapses().len()).map(|at| simplified.moved(at)).find(|moved| moved[0][0] < 13);
    assert_eq!(gone.map(<[_]>::len), Some(13));
}

#[test]
fn what_attributes_say_counts() {
    let flat = ground(16, |_, _| 0.0);
    let simplified = |values: &[f32], stride, error| {
        let surface = Surface { attributes: values, stride, ..flat.bare() };
        simplify(&surface, &SimplifyOptions { error, ..SimplifyOptions::default() }).expect("valid")
    };
    // The attribute is linear over the surface, so that two triangles represent it.
    let linear: Vec<f32> =
        flat.poses[0].iter().flat_map(|place| [3.0 * place[0] + place[2], 1.0 - place[2]]).collect();
    let done = simplified(&linear, 2, 1e-6);
    assert_eq!(done.triangles_left(), 2);
    // A dark square on bright ground keeps its outline.
    let is_dark = |place: &[f32; 3]| (0.3..0.7).contains(&place[0]) && (0.3..0.7).contains(&place[2]);
    let spot: Vec<f32> = flat.poses[0].iter().map(|place| f32::from(is_dark(place))).collect();
    let done = simplified(&spot, 1, 0.02);
    assert!((10..200).contains(&done.triangles_left()), "{}", done.triangles_left());
    let left = done.triangles(&flat.indices, done.collapses().len());
    // The mean over the ground does not change.
    let mean = |indices: &[u32]| -> f64 {
        let whole = |triangle: &[u32]| {
            let dark = triangle.iter().map(|corner| f64::from(spot[*corner as usize])).sum::<f64>();
            uv_area(&flat, triangle) * dark / 6.0
        };
        indices.chunks_exact(3).map(whole).sum()
    };
    let [before, after] = [mean(&flat.indices), mean(&left)];
    assert!((before - after).abs() < 0.03 * before, "{before} {after}");
    // Scaled to a thousandth, the attribute no longer matters.
    let faint: Vec<f32> = spot.iter().map(|value| value * 0.001).collect();
    assert_eq!(simplified(&faint, 1, 0.02).triangles_left(), 2);
    assert_eq!(topology(&flat, &left).euler, 1);
}
