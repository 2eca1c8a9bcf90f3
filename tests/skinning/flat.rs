//! Flat-shaded models, in which every triangle has vertices of its own: they get levels, and look flat at each of them.

use std::collections::HashMap;

use glam::Vec3;
use relievo::asset::material::{Sampling, Texture};
use relievo::asset::{Material, Mesh, Model};
use relievo::ops::mesh::{Cost, Seams, SimplifyOptions, Stopped, Surface, simplify};
use relievo::ops::skinning::add_levels;
use relievo_lab::reduce::{Limits, Reducer};
use relievo_lab::reduce::{Normals, ReducedModel, reduce_model};

/// A sphere of 20 · 4² triangles, whose points `shape` moves.
fn ball(shape: impl Fn(Vec3) -> Vec3) -> Vec<[Vec3; 3]> {
    let golden = (1.0 + 5.0_f32.sqrt()) / 2.0;
    let corners: Vec<Vec3> = (0..12)
        .map(|at| {
            let [a, b] = [1, 2].map(|bit| if at & bit == 0 { 1.0 } else { -1.0 });
            let corner = Vec3::new(0.0, a, b * golden);
            [corner, Vec3::new(corner.y, corner.z, 0.0), Vec3::new(corner.z, 0.0, corner.y)][at / 4]
        })
        .collect();
    let is_edge = |a: Vec3, b: Vec3| (a.distance(b) - 2.0).abs() < 1e-3;
    let mut all = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [a, b, c] = [corners[a], corners[b], corners[c]];
                if is_edge(a, b) && is_edge(b, c) && is_edge(c, a) {
                    let is_outside = (b - a).cross(c - a).dot(a) > 0.0;
                    all.push(if is_outside { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    let parts = 4;
    let mut small = Vec::new();
    for [a, b, c] in all {
        let at = |i: usize, j: usize| {
            let [i, j] = [i, j].map(|one| one as f32 / parts as f32);
            // Faces that share a point compute it in different ways.
            (4096.0 * shape((a + (b - a) * i + (c - a) * j).normalize())).round() / 4096.0
        };
        for i in 0..parts {
            for j in 0..parts - i {
                small.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < parts {
                    small.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    small
}

/// A golf ball with dimples.
fn golf_ball() -> Vec<[Vec3; 3]> {
    ball(|at| at * (1.0 - 0.04 * ((7.0 * at.x).sin() * (7.0 * at.y).sin() * (7.0 * at.z).sin()).abs()))
}

/// A head with a chin and a forehead, in centimetres.
fn alien() -> Vec<[Vec3; 3]> {
    ball(|at| {
        let wide = 1.0 + 0.5 * at.y.max(0.0) - 0.45 * (-at.y).max(0.0);
        Vec3::new(11.0 * wide * at.x, 16.0 * at.y, 12.0 * wide * at.z + 2.0 * (3.0 * at.y).cos())
    })
}

/// What a flat-shaded model is textured with.
#[derive(Clone, Copy, PartialEq)]
enum Charts {
    /// No material.
    None,
    /// Each triangle has a chart of its own, and no texture shows it.
    Unseen,
    /// Each triangle has a chart of its own.
    Seen,
}

fn model(triangles: &[[Vec3; 3]], charts: Charts) -> Model {
    let (mut text, side) = (String::new(), (triangles.len() as f32).sqrt().ceil());
    for (at, corners) in triangles.iter().enumerate() {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a).normalize();
        let [column, row] = [at as f32 % side, (at as f32 / side).floor()];
        for (corner, [u, v]) in corners.iter().zip([[0.1, 0.1], [0.9, 0.1], [0.1, 0.9]]) {
            let [u, v] =
                if charts == Charts::None { [0.0; 2] } else { [(column + u) / side, (row + v) / side] };
            text += &format!(
                "v {} {} {}\nvt {u} {v}\nvn {} {} {}\n",
                corner.x, corner.y, corner.z, normal.x, normal.y, normal.z
            );
        }
        let first = 3 * at + 1;
        let corner = |at: usize| format!("{at}/{at}/{at}");
        text += &format!("f {} {} {}\n", corner(first), corner(first + 1), corner(first + 2));
    }
    let mut model = Model::from_obj(text.as_bytes(), None).expect("valid");
    if charts != Charts::None {
        let mut material = Material::opaque("paint", [0.9, 0.9, 0.85, 1.0]);
        if charts == Charts::Seen {
            model.images.push(image::RgbaImage::new(4, 4).into());
            material.texture = Some(Texture { image: 0, sampling: Sampling::default() });
        }
        model.materials.push(material);
        model.meshes[0].material = Some(0);
    }
    assert_eq!(model.meshes[0].vertices(), 3 * triangles.len());
    model
}

fn reduced(model: &Model, share: f64, seams: Seams) -> ReducedModel {
    let triangles = (share * (model.meshes[0].indices.len() / 3) as f64) as usize;
    let limits = [Limits { triangles, ..Limits::default() }];
    let reducer = Reducer::HalfEdge { cost: Cost::Quadric, seams };
    reduce_model(model, &reducer, &limits, Normals::Carry).expect("valid").remove(0)
}

/// The angles between triangles and the normals of their corners, in degrees.
fn angles(mesh: &Mesh, indices: &[u32]) -> Vec<f32> {
    let of = |triangle: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|at| Vec3::from(mesh.positions[triangle[at] as usize]));
        let face = (b - a).cross(c - a).normalize();
        let normals = triangle.iter().map(|at| Vec3::from(mesh.normals[*at as usize]));
        normals.map(|normal| face.dot(normal).clamp(-1.0, 1.0).acos().to_degrees()).collect::<Vec<_>>()
    };
    indices.chunks_exact(3).flat_map(of).collect()
}

#[test]
fn reduced_models_stay_flat() {
    for triangles in [golf_ball(), alien()] {
        assert_eq!(triangles.len(), 320);
        let whole = model(&triangles, Charts::None);
        for charts in [Charts::None, Charts::Unseen, Charts::Seen] {
            let own = model(&triangles, charts);
            for share in [0.5, 0.2, 0.1] {
                let seams = if charts == Charts::Seen { Seams::AllCrossed } else { Seams::Held };
                let found = reduced(&own, share, seams);
                let wanted = (share * 320.0) as usize;
                assert!(
                    found.triangles() <= wanted && found.triangles() + 2 > wanted,
                    "{}",
                    found.triangles()
                );
                let mesh = &found.model.meshes[0];
                let worst = angles(mesh, &mesh.indices).into_iter().fold(0.0, f32::max);
                assert!(worst < 2.6, "{worst}° at {share}");
                let off = found.distance(&whole, &Default::default()).expect("valid").max();
                let free = reduced(&whole, share, Seams::Held);
                let least = free.distance(&whole, &Default::default()).expect("valid").max();
                // Texture that slips has a price, so that collapses which move the surface further come first.
                let most = if charts == Charts::Seen { 5.0 } else { 1.5 };
                assert!(off <= most * least, "{off} {least} at {share}");
            }
        }
    }
}

#[test]
fn seams_are_told_as_what_hinders() {
    let own = model(&golf_ball(), Charts::Seen);
    let found = reduced(&own, 0.2, Seams::Held);
    assert_eq!((found.triangles(), found.stopped, found.stopped.name()), (320, Stopped::Seams, "seams"));
    let found = reduced(&own, 0.2, Seams::AllCrossed);
    assert_eq!(found.stopped, Stopped::Triangles);
}

#[test]
fn levels_of_flat_shaded_models_look_flat() {
    for triangles in [golf_ball(), alien()] {
        for charts in [Charts::None, Charts::Unseen] {
            let mut own = model(&triangles, charts);
            let found = add_levels(&mut own, &[], 1).expect("valid").remove(0);
            assert!(found.levels.len() >= 5, "{}", found.levels.len());
            let (mesh, last) = (&own.meshes[0], found.levels.last().expect("levels"));
            assert!(last.indices.len() / 3 < 60, "{}", last.indices.len() / 3);
            for level in found.levels.iter().filter(|level| level.indices.len() / 3 >= 80) {
                let all = angles(mesh, &level.indices);
                let mean = all.iter().sum::<f32>() / all.len() as f32;
                assert!(mean < 12.0, "{mean}° at {}", level.indices.len() / 3);
            }
        }
        // Where textures show the charts, seams hold.
        let mut own = model(&triangles, Charts::Seen);
        assert!(add_levels(&mut own, &[], 1).expect("valid")[0].levels.is_empty());
    }
}

/// Two flat squares at an angle, of 8 × 8 quads each, that share positions along an edge but no vertex. The second number of
/// attributes tells them apart.
fn fold(second: [f32; 2]) -> (Vec<[f32; 3]>, Vec<u32>, Vec<f32>) {
    let (mut positions, mut indices, mut attributes) = (Vec::new(), Vec::new(), Vec::new());
    for part in 0..2_u32 {
        for y in 0..9_u32 {
            for x in 0..9_u32 {
                let [x, y] = [x as f32, y as f32];
                positions.push(if part == 0 { [-x, y, 0.0] } else { [x, y, 0.2 * x] });
                attributes.extend([part as f32, second[part as usize]]);
            }
        }
        for at in 0..64 {
            let corner = |x: u32, y: u32| 81 * part + 9 * (at / 8 + y) + at % 8 + x;
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            indices.extend(if part == 0 { [a, c, b, a, d, c] } else { [a, b, c, a, c, d] });
        }
    }
    (positions, indices, attributes)
}

/// Crossing the seam of the first attribute is legal and has its price; a seam of the second one is held then.
#[test]
fn seams_of_some_attributes_are_crossed() {
    let run = |second: [f32; 2], seams: Seams| {
        let (positions, indices, attributes) = fold(second);
        let surface = Surface { poses: &[positions], indices: &indices, attributes: &attributes, stride: 2 };
        let found =
            simplify(&surface, &SimplifyOptions { seams, ..SimplifyOptions::default() }).expect("valid");
        let left = found.triangles(&indices, found.collapses().len());
        // The first attribute at corners, by the part from which a triangle comes: mixed where a seam was crossed.
        let mixed = left
            .chunks_exact(3)
            .filter(|corners| corners.iter().any(|at| at / 81 != corners[0] / 81))
            .count();
        let free = found.collapses_within(1e-3);
        (left.len() / 3, mixed, found.triangles(&indices, free).len() / 3, found.error())
    };
    // Held: both squares keep their own vertices. What is free is two triangles each.
    let held = run([0.0, 0.0], Seams::Held);
    assert_eq!((held.1, held.2), (0, 4), "{held:?}");
    // Crossed: as far at no price, and on for that of the attribute's difference.
    let crossed = run([0.0, 0.0], Seams::Crossed { attributes: 1 });
    assert_eq!(crossed.2, 4, "{crossed:?}");
    assert!(crossed.3 > 0.1, "{crossed:?}");
    // The second attribute differs: its seam holds.
    let other = run([0.0, 1.0], Seams::Crossed { attributes: 1 });
    assert_eq!(other.1, 0, "{other:?}");
    let all = run([0.0, 1.0], Seams::AllCrossed);
    assert!(all.1 > 0 || all.0 <= 2, "{all:?}");
    let (positions, indices, attributes) = fold([0.0; 2]);
    let surface = Surface { poses: &[positions], indices: &indices, attributes: &attributes, stride: 2 };
    let seams = Seams::Crossed { attributes: 3 };
    let refused =
        simplify(&surface, &SimplifyOptions { seams, ..SimplifyOptions::default() }).expect_err("refused");
    assert_eq!(refused.to_string(), "seams.attributes = 3: must be at most 2, the stride");
}

/// Each corner has a vertex of its own, and no attribute differs: nothing is paid for crossing.
#[test]
fn vertices_that_differ_in_nothing_are_no_seam() {
    let triangles = golf_ball();
    let positions: Vec<[f32; 3]> = triangles.iter().flatten().map(Vec3::to_array).collect();
    let indices: Vec<u32> = (0..positions.len() as u32).collect();
    let mut known = HashMap::new();
    let mut places = Vec::new();
    let welded: Vec<u32> = positions
        .iter()
        .map(|place| {
            *known.entry(place.map(f32::to_bits)).or_insert_with(|| {
                places.push(*place);
                places.len() as u32 - 1
            })
        })
        .collect();
    let run = |positions: &[[f32; 3]], indices: &[u32], seams: Seams| {
        let surface = Surface { poses: &[positions.to_vec()], indices, attributes: &[], stride: 0 };
        let found =
            simplify(&surface, &SimplifyOptions { seams, ..SimplifyOptions::default() }).expect("valid");
        (found.triangles_left(), found.stopped(), found.collapses_to(160), found.error())
    };
    let held = run(&positions, &indices, Seams::Held);
    assert_eq!((held.0, held.1), (320, Stopped::Seams));
    let crossed = run(&positions, &indices, Seams::AllCrossed);
    let plain = run(&places, &welded, Seams::Held);
    assert_eq!((crossed.0, crossed.1, crossed.2), (plain.0, plain.1, plain.2));
    assert!((crossed.3 / plain.3 - 1.0).abs() < 0.3, "{} {}", crossed.3, plain.3);
}
