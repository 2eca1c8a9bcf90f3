//! Damaged meshes give an error or a valid result.

use relievo::ops::mesh::Surface;
use relievo_lab::reduce::{Reduced, Reducer};

use super::{KEEPING, shape_of, to};
use crate::measure::topology;
use crate::shapes::{Shape, bumps, cube, ground, shuffled, sphere, torus};

/// One change of a mesh; which one depends on the seed.
fn damage(shape: &mut Shape, seed: u64) {
    let vertices = shape.uv.len();
    let picked = shuffled(vertices, seed);
    let triangle = 3 * shuffled(shape.triangles(), seed)[0] as usize;
    let other = shape.poses[0][picked[1] as usize];
    let place = &mut shape.poses[0][picked[0] as usize];
    match seed % 14 {
        0 => shape.indices.extend_from_within(triangle..triangle + 3),
        1 => shape.indices.swap(triangle, triangle + 1),
        2 => shape.indices[triangle] = shape.indices[triangle + 1],
        3 => shape.indices.extend(&picked[..3]),
        4 => shape.indices[triangle] = picked[1],
        5 => *place = [1e30, -1e30, 3e29],
        6 => *place = [1e-40, -1e-42, 0.0],
        7 => *place = other,
        8 => shape.indices.truncate(triangle),
        9 => shape.poses[0].iter_mut().for_each(|place| place[1] = 0.0),
        10 => *place = [f32::MAX, f32::MIN, f32::MAX],
        11 => place[0] = f32::NAN,
        12 => shape.indices[triangle] = vertices as u32,
        _ => shape.indices.extend([picked[0], picked[1], picked[2], picked[1], picked[0], picked[3]]),
    }
}

/// What is wrong with a result.
fn fault(reduced: &Reduced, input: &Surface<'_>) -> Option<&'static str> {
    let vertices = reduced.poses[0].len();
    let used = (0..vertices as u32).all(|vertex| reduced.indices.contains(&vertex));
    let apart = |triangle: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|at| reduced.poses[0][triangle[at] as usize]);
        a != b && b != c && c != a
    };
    let is_out = |(list, most): (&[u32], usize)| list.iter().any(|at| *at as usize >= most);
    let lists = [
        (reduced.indices.as_slice(), vertices),
        (&reduced.vertices, input.poses[0].len()),
        (&reduced.triangles, input.indices.len() / 3),
    ];
    match reduced {
        _ if lists.into_iter().any(is_out) => Some("an index out of range"),
        _ if reduced.indices.len() != 3 * reduced.triangles.len() => Some("another number of triangles"),
        _ if reduced.attributes.len() != vertices * input.stride => Some("another number of attributes"),
        _ if reduced.vertices.len() != vertices || !used => Some("a vertex without triangles"),
        _ if !reduced.poses[0].as_flattened().iter().all(|x| x.is_finite()) => Some("a place that is none"),
        _ if !reduced.attributes.iter().all(|x| x.is_finite()) => Some("an attribute that is none"),
        _ if !reduced.indices.chunks_exact(3).all(apart) => Some("a triangle with a corner twice"),
        _ if reduced.error.is_nan() || reduced.error < 0.0 => Some("an error that is none"),
        _ => None,
    }
}

#[test]
fn damaged_meshes_give_an_error_or_a_valid_result() {
    let shapes = [sphere(9, 6), torus(8, 6), cube(3), ground(6, bumps)];
    let (mut valid, mut refused) = (0, 0);
    for seed in 0..1000_u64 {
        let mut shape = shapes[seed as usize % shapes.len()].clone();
        for change in 0..1 + seed % 3 {
            // What is refused comes alone, since nothing can be done to it afterwards.
            let kind = seed.wrapping_mul(31).wrapping_add(change * 17);
            let kind = if change > 0 && [11, 12].contains(&(kind % 14)) { kind + 2 } else { kind };
            if shape.triangles() > 0 && !shape.indices.contains(&(shape.uv.len() as u32)) {
                damage(&mut shape, kind);
            }
        }
        let surface = if seed % 2 == 0 { shape.bare() } else { shape.with_uv() };
        let (_, reducer) = Reducer::ALL[seed as usize / 4 % Reducer::ALL.len()];
        let limits = [shape.triangles() / 2, shape.triangles() / 10, 0].map(to);
        let Ok(all) = reducer.reduce_each(&surface, &limits) else {
            refused += 1;
            continue;
        };
        valid += 1;
        for reduced in &all {
            assert_eq!(fault(reduced, &surface), None, "{} of {seed}", reducer.name());
            if KEEPING.iter().any(|keeping| keeping.name() == reducer.name()) {
                let whole = topology(&shape, &shape.indices);
                let level = shape_of(reduced);
                let found = topology(&level, &level.indices);
                assert!(found.most_uses <= whole.most_uses, "{} of {seed}", reducer.name());
                assert!(found.is_manifold || !whole.is_manifold, "{} of {seed}", reducer.name());
            }
        }
    }
    assert!(valid > 700 && refused > 100, "{valid} valid, {refused} refused");
}
