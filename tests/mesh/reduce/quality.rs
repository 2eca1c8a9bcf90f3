//! How far reduced meshes are from the original, and that they are the same everywhere.

use relievo::ops::terrain::export::sha256;
use relievo_lab::reduce::{Limits, Reducer};

use super::{shape_of, to};
use crate::measure::distances_between;
use crate::shapes::{Shape, bumps, ground, sheet, torus};

/// Every reducer gets as small as it is asked to, and stays near; contractions to the best place are the nearest.
#[test]
fn the_surface_stays_near() {
    let shape = ground(40, bumps);
    let mut rms = Vec::new();
    for (name, reducer) in Reducer::ALL {
        let reduced = reducer.reduce(&shape.bare(), &to(320)).expect("valid");
        let count = reduced.triangles.len();
        // Clusters leave fewer by chance.
        assert!((200..=320).contains(&count), "{name}: {count}");
        let found = distances_between(&shape, &shape_of(&reduced));
        assert!(found[0] < 0.02 && found[1] < 0.12, "{name}: {found:?}");
        rms.push((name, found[0]));
    }
    let of = |name: &str| rms.iter().find(|(other, _)| *other == name).expect("there").1;
    for other in ["melax", "uniform-clustering", "importance-clustering", "vertex-removal"] {
        assert!(of("full-edge") < of(other), "{rms:?}");
    }
    assert!(of("full-edge") < 1.1 * of("quadric"), "{rms:?}");
}

/// Where the error is an estimated mean, it is that of the surface within a factor.
#[test]
fn estimates_are_those_of_the_surface() {
    for (shape, size) in [(ground(40, bumps), 1.0), (torus(48, 24), 3.0)] {
        for reducer in [Reducer::FullEdge, Reducer::VertexPair { distance: 0.02 }, Reducer::VertexRemoval] {
            for triangles in [1000, 400, 200] {
                let reduced = reducer.reduce(&shape.bare(), &to(triangles)).expect("valid");
                let [rms, most] = distances_between(&shape, &shape_of(&reduced));
                let error = f64::from(reduced.error);
                let figures = format!("{} {triangles}: {rms} {most} {error}", reducer.name());
                // Average planes are those of what is left, so that errors add up.
                let more = if reducer == Reducer::VertexRemoval { 2.0 } else { 1.0 };
                assert!(rms < more * error && most < 8.0 * more * error && error < 0.08 * size, "{figures}");
            }
        }
    }
}

/// Heights and sizes are made without functions that differ between machines.
fn exact() -> Shape {
    sheet([24, 24], |column, row| {
        let [x, z] = [column, row].map(|at| at as f64 / 24.0 - 0.5);
        let noise = ((column * 7919 + row * 104_729) % 31) as f64 / 31.0;
        [x, 0.4 * x * x - 0.3 * z * z * x + 0.02 * noise, -z]
    })
}

/// Debug and release builds, and all machines, give the same meshes.
#[test]
fn results_are_alike_everywhere() {
    let shape = exact();
    let mut found = Vec::new();
    for (name, reducer) in Reducer::ALL {
        let mut words = Vec::new();
        for triangles in [800, 300, 50] {
            let reduced = reducer.reduce(&shape.with_uv(), &to(triangles)).expect("valid");
            words.extend(reduced.poses[0].as_flattened().iter().map(|x| x.to_bits() as i32));
            words.extend(reduced.attributes.iter().map(|x| x.to_bits() as i32));
            words.extend(reduced.indices.iter().chain(&reduced.triangles).map(|index| *index as i32));
            words.push(reduced.error.to_bits() as i32);
        }
        found.push((name, sha256(&words)[..16].to_owned()));
    }
    let found: Vec<_> = found.iter().map(|(name, hash)| (*name, hash.as_str())).collect();
    // Those of half-edge collapses are in tests/mesh/creature.rs.
    assert_eq!(found[2..], HASHES);
}

const HASHES: [(&str, &str); 5] = [
    ("full-edge", "9c67a05e582d5cf6"),
    ("vertex-pair", "68aeb4eb1b4bf4aa"),
    ("uniform-clustering", "937b38038a9fb22c"),
    ("importance-clustering", "1c50aa777e571ffd"),
    ("vertex-removal", "0689a289b1f800f7"),
];

/// A mesh of another size is reduced alike; the sizes are powers of two, so that nothing is rounded.
#[test]
fn size_does_not_matter() {
    let shape = ground(12, bumps);
    for (name, reducer) in Reducer::ALL {
        let whole = reducer.reduce(&shape.bare(), &to(60)).expect("valid");
        for exponent in [-90, 100] {
            let scale = 2.0_f32.powi(exponent);
            let mut other = shape.clone();
            other.poses[0].as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
            let scaled = reducer.reduce(&other.bare(), &to(60)).expect("valid");
            assert!(
                scaled.indices == whole.indices && scaled.vertices == whole.vertices,
                "{name} {exponent}"
            );
            assert_eq!(scaled.error, whole.error * scale, "{name} {exponent}");
        }
    }
}

#[test]
fn an_error_is_not_exceeded() {
    let shape = torus(30, 18);
    for (name, reducer) in Reducer::ALL {
        for error in [0.0, 0.001, 0.01, 0.2] {
            let reduced = reducer.reduce(&shape.bare(), &Limits { triangles: 0, error }).expect("valid");
            assert!(reduced.error <= error, "{name}: {} beyond {error}", reduced.error);
            if error == 0.2 {
                assert!(reduced.triangles.len() < 800, "{name}: {}", reduced.triangles.len());
            }
        }
    }
}
