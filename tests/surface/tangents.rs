//! The reference's tangent frames agree with the derivatives of surfaces, and every mesh gets orthonormal frames without
//! NaN.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use relievo::ops::surface::tangent::reference::tangents;
use relievo::ops::surface::tangent::{TangentMesh, split_mirrored};

/// Random cases that are the same in every run.
fn settings() -> ProptestConfig {
    ProptestConfig {
        cases: 256,
        rng_seed: RngSeed::Fixed(2012),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

#[derive(Debug, Clone, Default)]
struct Owned {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uv: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl Owned {
    fn mesh(&self) -> TangentMesh<'_> {
        TangentMesh {
            positions: &self.positions,
            normals: &self.normals,
            uv: &self.uv,
            indices: &self.indices,
        }
    }

    /// Tangent, bitangent and handedness of every vertex.
    fn frames(&self) -> Vec<(DVec3, DVec3, f64)> {
        let tangents = tangents(&self.mesh()).expect("a valid mesh");
        (tangents.iter().zip(&self.normals))
            .map(|(tangent, normal)| {
                let [x, y, z, w] = tangent.map(f64::from);
                let (normal, tangent) = (vector(*normal).normalize(), DVec3::new(x, y, z));
                (tangent, w * normal.cross(tangent), w)
            })
            .collect()
    }

    /// The same mesh with other uv.
    fn with_uv(&self, change: impl Fn(DVec2) -> DVec2) -> Self {
        let change =
            |uv: &[f32; 2]| change(DVec2::from_array(uv.map(f64::from))).to_array().map(|along| along as f32);
        Self { uv: self.uv.iter().map(change).collect(), ..self.clone() }
    }
}

fn vector(components: [f32; 3]) -> DVec3 {
    DVec3::from_array(components.map(f64::from))
}

/// A surface over uv in 0..1: gives the position and the normal.
type Surface = fn(f64, f64) -> (DVec3, DVec3);

fn plane(u: f64, v: f64) -> (DVec3, DVec3) {
    (DVec3::new(2.0 * u + 0.5 * v, 1.0, -3.0 * v), DVec3::Y)
}

/// A sphere without the twentieth around each pole, where u has no direction.
fn sphere(u: f64, v: f64) -> (DVec3, DVec3) {
    let (turn, polar) = (TAU * u, TAU * 0.5 * (0.95 - 0.9 * v));
    let normal = DVec3::new(polar.sin() * turn.sin(), polar.cos(), polar.sin() * turn.cos());
    (5.0 * normal, normal)
}

fn torus(u: f64, v: f64) -> (DVec3, DVec3) {
    let (around, across) = (TAU * u, TAU * v);
    let middle = DVec3::new(around.sin(), 0.0, around.cos());
    let normal = across.cos() * middle + across.sin() * DVec3::Y;
    (3.0 * middle + normal, normal)
}

/// A grid of quads over a surface, its triangles counter-clockwise from outside.
fn tessellated(surface: Surface, columns: u32, rows: u32) -> Owned {
    let mut mesh = Owned::default();
    for (j, i) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (j, i))) {
        let (u, v) = (f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows));
        let (place, normal) = surface(u, v);
        mesh.positions.push(place.to_array().map(|component| component as f32));
        mesh.normals.push(normal.to_array().map(|component| component as f32));
        mesh.uv.push([u as f32, v as f32]);
    }
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let [a, b] = [j, j + 1].map(|row| row * (columns + 1) + i);
        mesh.indices.extend([a, a + 1, b + 1, a, b + 1, b]);
    }
    mesh
}

/// ∂P/∂u and ∂P/∂v of a surface, of unit length and orthogonal to each other by Gram–Schmidt.
fn analytic(surface: Surface, [u, v]: [f32; 2]) -> [DVec3; 2] {
    let (u, v, step) = (f64::from(u), f64::from(v), 1e-5);
    let along_u = (surface(u + step, v).0 - surface(u - step, v).0).normalize();
    let along_v = (surface(u, v + step).0 - surface(u, v - step).0).normalize();
    [along_u, (along_v - along_v.dot(along_u) * along_u).normalize()]
}

const SURFACES: [(&str, Surface); 3] = [("plane", plane), ("sphere", sphere), ("torus", torus)];

#[test]
fn frames_are_those_of_the_surface() {
    for (name, surface) in SURFACES {
        let worst = |fineness: u32| {
            let mesh = tessellated(surface, 4 * fineness, 3 * fineness);
            let frames = mesh.frames();
            let errors = frames.into_iter().zip(&mesh.uv).map(|((tangent, bitangent, w), uv)| {
                assert_eq!(w, 1.0, "{name} at {uv:?}");
                let [along_u, along_v] = analytic(surface, *uv);
                tangent.distance(along_u).max(bitangent.distance(along_v))
            });
            errors.fold(0.0, f64::max)
        };
        // At a border of the mesh a tangent is off by half of the angle that an edge spans, because no second triangle
        // compensates for it.
        let (coarse, fine) = (worst(6), worst(24));
        assert!(coarse < 0.14, "{name}: {coarse}");
        assert!(fine < 0.035 && (fine < 0.3 * coarse || fine < 1e-6), "{name}: {coarse}, then {fine}");
    }
}

#[test]
fn mirrored_uv_turn_handedness() {
    for (name, surface) in SURFACES {
        let mesh = tessellated(surface, 12, 9);
        let plain = mesh.frames();
        for signs in [[-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]] {
            let mirrored = mesh.with_uv(|uv| uv * DVec2::from_array(signs));
            for (mirrored, plain) in mirrored.frames().iter().zip(&plain) {
                assert!(mirrored.0.distance(signs[0] * plain.0) < 1e-5, "{name}: tangent of uv × {signs:?}");
                assert_eq!(mirrored.2, signs[0] * signs[1], "{name}: uv × {signs:?}");
            }
        }
    }
}

/// A plane of which one half has u mirrored at the seam.
fn folded() -> Owned {
    tessellated(plane, 8, 4).with_uv(|uv| DVec2::new((uv.x - 0.5).abs(), uv.y))
}

#[test]
fn opposite_tangents_leave_the_fallback() {
    // Two right triangles that mirror each other at their common edge: u grows away from the edge, and v along it.
    let mesh = Owned {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        uv: vec![[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 0.0]],
        indices: vec![0, 1, 2, 0, 3, 1],
    };
    let frames: Vec<_> = mesh.frames().into_iter().map(|(tangent, _, w)| (tangent, w)).collect();
    assert_eq!(frames, [(DVec3::X, 1.0), (DVec3::X, 1.0), (DVec3::Y, -1.0), (DVec3::NEG_Y, 1.0)]);
}

#[test]
fn split_mirror_seams_have_a_frame_on_each_side() {
    let mesh = folded();
    let seam = (0..mesh.uv.len() as u32).filter(|vertex| mesh.uv[*vertex as usize][0] == 0.0);
    let split = split_mirrored(&mesh.uv, &mesh.indices).expect("a valid mesh");
    let mut copies = split.copies.clone();
    copies.sort_unstable();
    assert!(copies.len() == 5 && copies.into_iter().eq(seam));
    let mut whole = Owned { indices: split.indices, ..mesh.clone() };
    for copy in split.copies {
        let copy = copy as usize;
        whole.positions.push(mesh.positions[copy]);
        whole.normals.push(mesh.normals[copy]);
        whole.uv.push(mesh.uv[copy]);
    }
    let frames = whole.frames();
    for triangle in whole.indices.chunks_exact(3) {
        let [first, ..] = [0, 1, 2].map(|corner| frames[triangle[corner] as usize]);
        let mirrored = first.2 < 0.0;
        for corner in triangle {
            let frame = frames[*corner as usize];
            assert_eq!(frame.2, first.2, "a triangle with two handednesses");
            let expected = if mirrored { DVec3::NEG_X } else { DVec3::X };
            assert!(frame.0.distance(expected) < 1e-5, "{} at {corner}", frame.0);
        }
    }
}

#[test]
fn cutting_a_face_in_two_hardly_turns_the_tangent() {
    // Three faces meet at right angles in a corner, each with its own tangent. The first face is one triangle, then two.
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.0]];
    let normals = vec![[1.0, 1.0, 1.0]; 5];
    let uv = vec![[0.0; 2], [1.0, 0.0], [0.0, 1.0], [-1.0, -0.5], [0.5, 0.5]];
    let faces = [0, 2, 3, 0, 3, 1];
    let whole = Owned { positions, normals, uv, indices: [&[0, 1, 2], &faces[..]].concat() };
    let cut = Owned { indices: [&[0, 1, 4, 0, 4, 2], &faces[..]].concat(), ..whole.clone() };
    let angle = whole.frames()[0].0.angle_between(cut.frames()[0].0);
    assert!(angle < 0.06, "turned by {angle}");
}

/// Floats with random bits, and often ordinary or troublesome values.
fn floats() -> impl Strategy<Value = f32> {
    let troublesome = [0.0, -0.0, 1.0, -1.0, 1e-45, 1e-38, 1e-30, 1e18, -1e18, 1e30, f32::MAX, f32::NAN];
    prop_oneof![
        4 => -1.0..1.0_f32,
        1 => prop::sample::select(troublesome.to_vec()),
        1 => any::<u32>().prop_map(f32::from_bits),
    ]
}

/// The ranges of positions and uv.
fn coordinates() -> impl Strategy<Value = f32> {
    floats().prop_map(|value| if value.is_nan() { 0.0 } else { value.clamp(-1e18, 1e18) })
}

fn garbage() -> impl Strategy<Value = Owned> {
    (1..12_usize).prop_flat_map(|vertices| {
        let position = [coordinates(), coordinates(), coordinates()];
        let normal = [floats(), floats(), floats()];
        (
            prop::collection::vec(position, vertices),
            prop::collection::vec(normal, vertices),
            prop::collection::vec([coordinates(), coordinates()], vertices),
            prop::collection::vec([0..vertices as u32, 0..vertices as u32, 0..vertices as u32], 0..24),
        )
            .prop_map(|(positions, normals, uv, triangles)| Owned {
                positions,
                normals,
                uv,
                indices: triangles.concat(),
            })
    })
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn every_frame_is_orthonormal(mesh in garbage()) {
        let tangents = tangents(&mesh.mesh()).expect("a valid mesh");
        prop_assert_eq!(tangents.len(), mesh.positions.len());
        for (tangent, normal) in tangents.iter().zip(&mesh.normals) {
            let [x, y, z, w] = tangent.map(f64::from);
            let tangent = DVec3::new(x, y, z);
            prop_assert!((tangent.length() - 1.0).abs() < 1e-6, "{} of normal {:?}", tangent, normal);
            prop_assert!(w.abs() == 1.0);
            let largest = normal.iter().map(|component| component.abs()).fold(0.0, f32::max);
            let finite = normal.iter().all(|component| component.is_finite());
            if finite && ((-100.0_f32).exp2()..=100.0_f32.exp2()).contains(&largest) {
                let normal = vector(*normal).normalize();
                prop_assert!(tangent.dot(normal).abs() < 1e-6, "{} along {}", tangent, normal);
            } else {
                prop_assert_eq!((tangent, w), (DVec3::X, 1.0));
            }
        }
    }

    /// Frames do not depend on the units of positions and uv.
    #[test]
    fn units_do_not_matter(mesh in garbage(), size in -20..20_i32, texture in -20..20_i32) {
        // The values are moderate, so that they stay in the range of f32 in other units.
        let moderate = |at: f32| if at.abs() < 1e-20 { 0.0 } else { at.clamp(-9.0, 9.0) };
        let mesh = Owned {
            positions: mesh.positions.iter().map(|place| place.map(moderate)).collect(),
            uv: mesh.uv.iter().map(|uv| uv.map(moderate)).collect(),
            ..mesh
        };
        let mut other = mesh.clone();
        other.positions.iter_mut().flatten().for_each(|at| *at *= (size as f32).exp2());
        other.uv.iter_mut().flatten().for_each(|at| *at *= (texture as f32).exp2());
        prop_assert_eq!(tangents(&other.mesh()), tangents(&mesh.mesh()));
    }

    #[test]
    fn splitting_leaves_no_vertex_to_both_sides(mesh in garbage()) {
        let split = split_mirrored(&mesh.uv, &mesh.indices).expect("valid indices");
        let source = |index: u32| match (index as usize).checked_sub(mesh.uv.len()) {
            None => index,
            Some(copy) => split.copies[copy],
        };
        let sources: Vec<u32> = split.indices.iter().map(|index| source(*index)).collect();
        prop_assert_eq!(&sources, &mesh.indices, "triangles changed");
        let mut sides = std::collections::HashMap::new();
        for triangle in split.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| mesh.uv[source(triangle[corner]) as usize].map(f64::from));
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
            for vertex in triangle.iter().filter(|_| area != 0.0) {
                let side = *sides.entry(*vertex).or_insert(area > 0.0);
                prop_assert_eq!(side, area > 0.0, "vertex {} is on both sides", vertex);
            }
        }
    }
}
