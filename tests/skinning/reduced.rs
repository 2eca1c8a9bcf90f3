//! Whole models with fewer triangles.

use glam::Vec3;
use relievo::asset::{Mesh, Model};
use relievo::ops::skinning::at_rest;
use relievo_lab::distance::DistanceOptions;
use relievo_lab::reduce::{Limits, Reducer};
use relievo_lab::reduce::{Normals, ReducedModel, reduce_model};
use relievo_samples::creature;

fn model(text: &str) -> Model {
    Model::from_obj(text.as_bytes(), None).expect("valid")
}

fn reduced(model: &Model, triangles: usize, normals: Normals) -> ReducedModel {
    let reducer: Reducer = "quadric".parse().expect("a reducer");
    let limits = [Limits { triangles, ..Limits::default() }];
    reduce_model(model, &reducer, &limits, normals).expect("valid").remove(0)
}

fn count(model: &Model) -> usize {
    model.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum()
}

fn normal_of(mesh: &Mesh, triangle: [u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|corner| Vec3::from(mesh.positions[corner as usize]));
    (b - a).cross(c - a).normalize()
}

/// A cube of `cells`² quadrangles a side. Every side is hard: it has a normal of its own. Sides with an axis of `materials` are
/// another mesh.
fn cube(cells: usize, materials: bool) -> Model {
    let mut text = String::new();
    let mut vertices = 0;
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut normal = [0.0; 3];
            normal[axis] = side;
            text += &format!("vn {} {} {}\n", normal[0], normal[1], normal[2]);
            if materials {
                text += &format!("usemtl {}\n", axis.min(1));
            }
            for row in 0..=cells {
                for column in 0..=cells {
                    let [u, v] = [column, row].map(|at| 2.0 * at as f64 / cells as f64 - 1.0);
                    let mut place = [side; 3];
                    (place[(axis + 1) % 3], place[(axis + 2) % 3]) = (u * side, v);
                    text += &format!("v {} {} {}\n", place[0], place[1], place[2]);
                }
            }
            for row in 0..cells {
                for column in 0..cells {
                    let corner = |x: usize, y: usize| {
                        let at = vertices + (row + y) * (cells + 1) + column + x + 1;
                        format!("{at}//{}", 2 * axis + usize::from(side > 0.0) + 1)
                    };
                    text +=
                        &format!("f {} {} {} {}\n", corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
                }
            }
            vertices += (cells + 1) * (cells + 1);
        }
    }
    model(&text)
}

/// A cube needs twelve triangles, and its edges stay hard.
#[test]
fn hard_edges_do_not_hinder_and_stay() {
    for materials in [false, true] {
        let cube = cube(6, materials);
        let found = reduced(&cube, 12, Normals::Carry);
        assert_eq!((count(&cube), found.triangles()), (6 * 72, 12), "{materials}");
        assert!(
            found
                .distance(&at_rest(&cube).expect("valid"), &DistanceOptions::default())
                .expect("valid")
                .max()
                < 1e-8
        );
        assert_eq!(found.model.meshes.len(), 1 + usize::from(materials));
        for mesh in &found.model.meshes {
            for triangle in mesh.indices.as_chunks::<3>().0 {
                let normal = normal_of(mesh, *triangle);
                for corner in triangle {
                    assert_eq!(mesh.normals[*corner as usize], normal.to_array(), "{materials}");
                }
            }
        }
        // Each of the eight corners has three normals.
        assert_eq!(found.vertices(), 24, "{materials}");
        // Computed again, they are smooth inside of each mesh: a corner has one normal, and one a mesh where there are two.
        let smooth = reduced(&cube, 12, Normals::Recompute);
        assert_eq!(smooth.vertices(), if materials { 16 } else { 8 });
    }
}

/// A square of 4 and a triangle of ½ stand upright on each other: the vertices that they share have the normal of
/// the sum of their areas.
#[test]
fn recomputed_normals_weight_triangles_by_area() {
    let text = "v 0 0 0\nv 0 0 4\nv 1 0 4\nv 1 0 0\nv 0.5 1 0\nf 1 2 3 4\nf 1 4 5\n";
    let found = reduced(&model(text), 3, Normals::Recompute);
    assert_eq!(found.triangles(), 3);
    let mesh = &found.model.meshes[0];
    let normal = |place: [f32; 3]| {
        let at = mesh.positions.iter().position(|position| *position == place).expect("kept");
        Vec3::from(mesh.normals[at])
    };
    let triangle = normal([0.5, 1.0, 0.0]);
    assert_eq!(triangle.abs(), Vec3::Z);
    // One of the two halves of the square, or both, at either end of the shared edge.
    let both = [normal([0.0; 3]), normal([1.0, 0.0, 0.0])];
    let mut areas: Vec<f32> = both.iter().map(|normal| (normal.y / normal.z).abs()).collect();
    areas.sort_by(f32::total_cmp);
    assert!((areas[0] - 4.0).abs() < 1e-5 && (areas[1] - 8.0).abs() < 1e-5, "{both:?}");
}

/// Triangles that share no vertices, as exporters write flat shading.
#[test]
fn loose_triangles_are_joined() {
    let whole = at_rest(&creature().expect("valid")).expect("valid");
    let mut text = String::new();
    let mut next = 1;
    for mesh in &whole.meshes {
        for triangle in mesh.indices.as_chunks::<3>().0 {
            let normal = normal_of(mesh, *triangle);
            if !normal.is_finite() {
                continue;
            }
            for corner in triangle {
                let [x, y, z] = mesh.positions[*corner as usize];
                text += &format!("v {x} {y} {z}\n");
            }
            text += &format!(
                "vn {} {} {}\nf {next}//-1 {}//-1 {}//-1\n",
                normal.x,
                normal.y,
                normal.z,
                next + 1,
                next + 2
            );
            next += 3;
        }
    }
    let loose = model(&text);
    let all = count(&loose);
    assert_eq!(loose.meshes[0].vertices(), 3 * all);
    let found = reduced(&loose, all / 5, Normals::Carry);
    assert!(found.triangles() <= all / 5, "{} of {all}", found.triangles());
}

/// What is not moved has the same vertices, to the bit.
#[test]
fn nothing_changes_without_need() {
    let whole = at_rest(&creature().expect("valid")).expect("valid");
    // Normals are normalized once more.
    let again = at_rest(&whole).expect("valid");
    let all = count(&whole);
    let same = reduced(&whole, all, Normals::Carry);
    assert_eq!(same.triangles(), all);
    let coarse = reduced(&whole, all / 4, Normals::Carry);
    for (found, least) in [(&same, 0.999), (&coarse, 0.5)] {
        for (mesh, wanted) in found.model.meshes.iter().zip(&again.meshes) {
            let key = |mesh: &Mesh, at: usize| {
                let bits = |numbers: &[f32]| numbers.iter().map(|x| (x + 0.0).to_bits()).collect::<Vec<_>>();
                [bits(&mesh.positions[at]), bits(&mesh.normals[at]), bits(&mesh.uv[at])]
            };
            let known: std::collections::HashSet<_> =
                (0..wanted.vertices()).map(|at| key(wanted, at)).collect();
            assert!((0..mesh.vertices()).all(|at| known.contains(&key(mesh, at))), "{}", mesh.name);
            assert!(mesh.vertices() as f64 <= wanted.vertices() as f64 / least, "{}", mesh.name);
            assert_eq!((&mesh.name, mesh.material), (&wanted.name, wanted.material));
            mesh.validate(&found.model.skins).expect("valid");
        }
    }
}

/// Reducers that place vertices anew keep attributes on the scale of the model's.
#[test]
fn every_reducer_gives_a_valid_model() {
    let whole = at_rest(&creature().expect("valid")).expect("valid");
    let most = |model: &Model| {
        let uv = model.meshes.iter().flat_map(|mesh| &mesh.uv).flatten();
        uv.fold(0.0_f32, |most, x| most.max(x.abs()))
    };
    for (name, reducer) in Reducer::ALL {
        let limits = [Limits { triangles: count(&whole) / 3, ..Limits::default() }];
        let found = reduce_model(&whole, &reducer, &limits, Normals::Carry).expect(name).remove(0);
        assert!(found.triangles() < count(&whole), "{name}");
        for mesh in &found.model.meshes {
            mesh.validate(&found.model.skins).expect(name);
            let lengths = mesh.normals.iter().map(|normal| Vec3::from(*normal).length());
            assert!(
                lengths.clone().all(|length| (length - 1.0).abs() < 1e-3),
                "{name}: {:?}",
                lengths.fold(1.0, f32::min)
            );
        }
        assert!(most(&found.model) <= 2.0 * most(&whole), "{name}");
    }
}

#[test]
fn what_cannot_be_reduced_is_refused() {
    let mut empty = cube(1, false);
    empty.meshes[0].indices.clear();
    let reducer: Reducer = "quadric".parse().expect("a reducer");
    let refused = |model: &Model, limits: Limits| {
        reduce_model(model, &reducer, &[limits], Normals::Carry).map(|_| ()).expect_err("refused").path
    };
    assert_eq!(refused(&empty, Limits::default()), "model.triangles.len");
    assert_eq!(refused(&cube(1, false), Limits { error: -1.0, ..Limits::default() }), "limits[0].error");
}
