//! How far simplified meshes are from the original.

use relievo::ops::mesh::{Cost, SimplifyOptions, Stopped, Surface, simplify};

use crate::measure::{area, distances, normal};
use crate::shapes::{Shape, bumps, ground, sheet, torus};

#[test]
fn a_flat_square_becomes_two_triangles() {
    // The ground is level, and then askew, where rounding leaves 1e-7 of its size.
    let level = ground(20, |_, _| 0.25);
    let askew = sheet([20, 12], |column, row| {
        let [x, y] = [column as f64 * 0.1, row as f64 * 0.1];
        [0.6 * x, 0.8 * x, y + 0.3 * x]
    });
    for (shape, error) in [(level, 0.0), (askew, 1e-6)] {
        let simplified = shape.simplified(&SimplifyOptions { error, ..SimplifyOptions::default() });
        assert_eq!((simplified.triangles_left(), simplified.stopped()), (2, Stopped::Error));
        assert!(simplified.error() <= error);
        let whole = area(&shape, 0, &shape.indices);
        for collapses in 0..=simplified.collapses().len() {
            let level = simplified.triangles(&shape.indices, collapses);
            assert!((area(&shape, 0, &level) - whole).abs() < 1e-5 * whole, "after {collapses}");
        }
    }
}

#[test]
fn a_strip_of_squares_is_one_in_the_end() {
    let strip = sheet([50, 1], |column, row| [column as f64, row as f64, 0.0]);
    let simplified = strip.simplified(&SimplifyOptions { error: 0.0, ..SimplifyOptions::default() });
    assert_eq!((simplified.triangles_left(), simplified.error()), (2, 0.0));
}

#[test]
fn quadrics_leave_less_error_than_melax() {
    let shape = ground(48, bumps);
    let [quadric, melax] = [Cost::Quadric, Cost::Melax { check_normals: false }]
        .map(|cost| shape.simplified(&SimplifyOptions { cost, ..SimplifyOptions::default() }));
    for triangles in [2304, 920, 460, 230] {
        let [[rms, most], [melax_rms, melax_most]] = [&quadric, &melax].map(|simplified| {
            let collapses = simplified.collapses_to(triangles);
            distances(&shape, 0, &simplified.triangles(&shape.indices, collapses))
        });
        let figures = format!("{triangles}: {rms} {most} against {melax_rms} {melax_most}");
        assert!(melax_rms > 1.2 * rms && melax_most > 1.3 * most, "{figures}");
    }
}

/// The error is what a root mean square of distances is, within a factor.
#[test]
fn errors_ascend_and_are_those_of_the_surface() {
    for (shape, size) in [(ground(40, bumps), 1.0), (torus(48, 24), 3.0)] {
        let simplified = shape.simplified(&SimplifyOptions::default());
        let errors = simplified.collapses().iter().map(|collapse| collapse.error);
        assert!(errors.is_sorted());
        for triangles in [1000, 400, 200] {
            let collapses = simplified.collapses_to(triangles);
            let [rms, most] = distances(&shape, 0, &simplified.triangles(&shape.indices, collapses));
            let error = f64::from(simplified.collapses()[collapses - 1].error);
            assert!(rms < error && most < 6.0 * error && error < 0.05 * size, "{rms} {most} {error}");
        }
    }
}

/// An arm of ten units that bends by 90° at 3, straight in the first pose.
fn arm() -> Shape {
    let sides = 12;
    let rings = 80;
    let place = |column: usize, row: usize| {
        let turn = std::f64::consts::TAU * (column % sides) as f64 / sides as f64;
        [row as f64 * 10.0 / rings as f64, turn.sin(), -turn.cos()]
    };
    let mut shape = sheet([sides, rings], place);
    let bent = shape.poses[0].iter().map(|&[along, y, z]| {
        let angle = ((f64::from(along) - 2.0) / 2.0).clamp(0.0, 1.0) * std::f64::consts::FRAC_PI_2;
        let radius = 4.0 / std::f64::consts::PI;
        let beyond = (f64::from(along) - 4.0).max(0.0) + (f64::from(along) - 2.0).min(0.0);
        let reach = radius * 2.0 + f64::from(y);
        let (sin, cos) = angle.sin_cos();
        [reach * sin + beyond * cos, reach * cos - beyond * sin, f64::from(z)].map(|x| x as f32)
    });
    let bent = bent.collect();
    shape.poses.push(bent);
    shape
}

#[test]
fn all_poses_count() {
    let shape = arm();
    let rest = Surface { poses: &shape.poses[..1], ..shape.bare() };
    let in_rest = simplify(&rest, &SimplifyOptions::default()).expect("valid");
    let in_both = shape.simplified(&SimplifyOptions::default());
    for triangles in [600, 300, 150] {
        let [rest, both] = [&in_rest, &in_both].map(|simplified| {
            let collapses = simplified.collapses_to(triangles);
            distances(&shape, 1, &simplified.triangles(&shape.indices, collapses))
        });
        assert!(both[0] * 2.0 < rest[0] && both[1] * 2.0 < rest[1], "{triangles}: {both:?} against {rest:?}");
    }
}

/// No triangle turns around or loses its area from a level to the next, in any pose.
#[test]
fn no_triangle_turns_around() {
    for shape in [arm(), ground(16, bumps), ground(10, |_, _| 0.0)] {
        let points = shape.points();
        let simplified = shape.simplified(&SimplifyOptions::default());
        let mut corners = shape.indices.clone();
        for collapse in 0..simplified.collapses().len() {
            let before = corners.clone();
            for [from, to] in simplified.moved(collapse) {
                corners.iter_mut().filter(|corner| *corner == from).for_each(|corner| *corner = *to);
            }
            for (before, after) in before.chunks_exact(3).zip(corners.chunks_exact(3)) {
                let [a, b, c] = [0, 1, 2].map(|at| points[after[at] as usize]);
                let is_left = a != b && b != c && c != a;
                for pose in 0..shape.poses.len() {
                    let [before, after] = [before, after].map(|triangle| normal(&shape, pose, triangle));
                    assert!(!is_left || before.dot(after) > 0.0, "{collapse}: {before} {after}");
                }
            }
        }
    }
}
