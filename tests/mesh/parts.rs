//! Parts of a mesh vanish where the others are near enough, and only there.

use relievo::ops::mesh::{Cost, Simplified, SimplifyOptions, simplify_within};

use crate::measure::{distances, distances_between};
use crate::shapes::{Shape, sphere};

/// A sphere of this radius around a point.
fn ball(radius: f32, around: [f32; 3]) -> Shape {
    let mut shape = sphere(12, 8);
    for place in &mut shape.poses[0] {
        *place = [0, 1, 2].map(|axis| place[axis] * radius + around[axis]);
    }
    shape
}

fn all(shapes: &[Shape]) -> Shape {
    let mut all = shapes[0].clone();
    shapes[1..].iter().for_each(|shape| all.append(shape));
    all
}

/// The triangles that are left of each shape, after a number of collapses.
fn left(shapes: &[Shape], simplified: &Simplified, collapses: usize) -> Vec<usize> {
    let indices = simplified.triangles(&all(shapes).indices, collapses);
    let mut first = 0;
    let mut part = |shape: &Shape| {
        let range = first..first + shape.uv.len() as u32;
        first = range.end;
        indices.chunks_exact(3).filter(|triangle| range.contains(&triangle[0])).count()
    };
    shapes.iter().map(&mut part).collect()
}

/// A knob on a ball, and a ball of the knob's size far away.
fn knob() -> [Shape; 3] {
    [ball(1.0, [0.0; 3]), ball(0.1, [1.05, 0.0, 0.0]), ball(0.1, [6.0, 0.0, 0.0])]
}

#[test]
fn a_part_vanishes_where_another_is_near() {
    let shapes = knob();
    let simplified = all(&shapes).simplified(&SimplifyOptions::default());
    let known = |part: usize| {
        (0..=simplified.collapses().len()).find(|at| left(&shapes, &simplified, *at)[part] == 0)
    };
    let [knob, far] = [known(1), known(2)];
    let error = |at: usize| simplified.collapses()[at - 1].error;
    // The knob sticks out by 0.15 at most, and the ball is 4.9 away.
    let (knob, far) = (knob.expect("it vanishes"), far.expect("it vanishes in the end"));
    assert!((0.02..0.15).contains(&error(knob)), "{}", error(knob));
    assert!(error(far) > 2.0, "{}", error(far));
    // Only it went, as a whole, and the others are as they were.
    let [before, after] = [knob - 1, knob].map(|at| left(&shapes, &simplified, at));
    assert!(before[1] >= 4 && after == [before[0], 0, before[2]], "{before:?} {after:?}");
    let last = left(&shapes, &simplified, simplified.collapses().len());
    assert!(last[0] >= 4 && last[1..] == [0, 0], "{last:?}");
}

/// Neighbours that went first do not count: a row of balls does not vanish from end to end at the price of one.
#[test]
fn the_distance_is_that_of_what_is_left() {
    let mut shapes = vec![ball(1.0, [0.0; 3])];
    shapes.extend((0..12).map(|at| ball(0.1, [1.15 + 0.25 * at as f32, 0.0, 0.0])));
    let shape = all(&shapes);
    let simplified = shape.simplified(&SimplifyOptions::default());
    let mut vanished = 0;
    for at in 1..=simplified.collapses().len() {
        let parts = left(&shapes, &simplified, at);
        let gone = parts.iter().filter(|triangles| **triangles == 0).count();
        if gone > vanished {
            let level = simplified.triangles(&shape.indices, at);
            let [_, most] = distances(&shape, 0, &level);
            let error = f64::from(simplified.collapses()[at - 1].error);
            // A distance counts by half, and parts had collapsed before.
            assert!(most < 2.5 * error, "{gone} have gone: {most} at {error}");
        }
        vanished = gone;
    }
    assert_eq!(vanished, 12);
}

/// The distance is that of the worst pose.
#[test]
fn poses_may_part_what_is_near_at_rest() {
    let mut shape = all(&knob()[..2]);
    let mut away = shape.poses[0].clone();
    let first = knob()[0].uv.len();
    away[first..].iter_mut().for_each(|place| place[0] += 3.0);
    shape.poses.push(away);
    let simplified = shape.simplified(&SimplifyOptions::default());
    let last = simplified.collapses().last().expect("some");
    assert!(
        simplified.moved(simplified.collapses().len() - 1).len() > 1 && last.error > 1.4,
        "{}",
        last.error
    );
}

#[test]
fn parts_stay_where_that_is_asked_for() {
    let shapes = knob();
    let shape = all(&shapes);
    let stays = |simplified: &Simplified| {
        let left = left(&shapes, simplified, simplified.collapses().len());
        left.iter().all(|triangles| *triangles >= 4)
    };
    assert!(stays(&shape.simplified(&SimplifyOptions { prune: false, ..SimplifyOptions::default() })));
    assert!(!stays(&shape.simplified(&SimplifyOptions::default())));
    // Costs of Melax are no distances, and limited distances are those of each part.
    let cost = Cost::Melax { check_normals: false };
    assert!(stays(&shape.simplified(&SimplifyOptions { cost, ..SimplifyOptions::default() })));
    let limited = simplify_within(&shape.bare(), &SimplifyOptions::default(), &[0.5, 100.0]).expect("valid");
    assert!(stays(&limited));
}

/// With attributes, the loss of a part costs what its attributes vary, over its area.
#[test]
fn attributes_keep_parts_longer() {
    let shapes = &knob()[..2];
    let shape = all(shapes);
    let error = |weight: f32| {
        let mut surface = shape.with_uv();
        let uv: Vec<f32> = surface.attributes.iter().map(|value| value * weight).collect();
        surface.attributes = &uv;
        let simplified = relievo::ops::mesh::simplify(&surface, &SimplifyOptions::default()).expect("valid");
        let count = simplified.collapses().len();
        let at = (0..=count).find(|at| left(shapes, &simplified, *at)[1] == 0).expect("it vanishes");
        simplified.collapses()[at - 1].error
    };
    let [plain, weighted] = [error(1e-3), error(2.0)];
    assert!(weighted > 1.5 * plain, "{plain} {weighted}");
}

/// What is left of a level, beside what was there: the level of a knobbed ball without its knob is that ball's.
#[test]
fn what_is_left_is_a_mesh() {
    let shapes = &knob()[..2];
    let shape = all(shapes);
    let simplified = shape.simplified(&SimplifyOptions::default());
    let at = (0..=simplified.collapses().len()).find(|at| left(shapes, &simplified, *at)[1] == 0);
    let indices = simplified.triangles(&shape.indices, at.expect("it vanishes"));
    let level = Shape { indices, ..shape.clone() };
    let [_, most] = distances_between(&level, &shapes[0]);
    assert!(most < 0.2, "{most}");
    let used = crate::measure::topology(&shape, &level.indices);
    assert!(used.is_manifold && used.border == 0 && used.euler == 2, "{used:?}");
}
