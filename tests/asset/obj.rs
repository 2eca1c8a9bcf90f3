//! Geometry of Wavefront OBJ.

use relievo::asset::{Mesh, Model};

use crate::read;

/// A cube of six quadrangles, without texture coordinates and normals.
const CUBE: &str = "# a cube
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn only(text: &str) -> Mesh {
    let Model { mut meshes, .. } = read(text).expect(text);
    assert_eq!(meshes.len(), 1, "{text}");
    meshes.remove(0)
}

/// The positions of each triangle's corners.
fn triangles(mesh: &Mesh) -> Vec<[[f32; 3]; 3]> {
    let position = |index: u32| mesh.positions[index as usize];
    mesh.indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(position)).collect()
}

/// Six times the volume that triangles enclose.
fn volume(mesh: &Mesh) -> f32 {
    let of =
        |[a, b, c]: [[f32; 3]; 3]| glam::Vec3::from(a).dot(glam::Vec3::from(b).cross(glam::Vec3::from(c)));
    triangles(mesh).into_iter().map(of).sum()
}

#[test]
fn polygons_become_triangles_with_smooth_normals() {
    let cube = only(CUBE);
    assert_eq!((cube.vertices(), cube.indices.len() / 3, volume(&cube)), (8, 12, 48.0));
    assert_eq!(cube.positions[6], [1.0; 3]);
    for (position, normal) in cube.positions.iter().zip(&cube.normals) {
        let (position, normal) = (glam::Vec3::from(*position), glam::Vec3::from(*normal));
        assert!(position.dot(normal) > 1.6 && (normal.length() - 1.0).abs() < 1e-6, "{position} {normal}");
    }
    assert!(cube.uv.iter().all(|uv| *uv == [0.0; 2]));
    assert!(!cube.double_sided && cube.material.is_none());
}

/// A polygon that is not convex, begun at each of its corners, backwards too.
#[test]
fn polygons_need_not_be_convex() {
    let corners = [[0, 0], [4, 0], [4, 4], [3, 1], [2, 4], [1, 1], [0, 4]];
    for turn in 0..corners.len() {
        let mut corners = corners;
        corners.rotate_left(turn);
        let vertices: String = corners.iter().map(|[x, y]| format!("v {x} {y} 5\n")).collect();
        for (face, sign) in [("f 1 2 3 4 5 6 7", 1.0), ("f 7 6 5 4 3 2 1", -1.0)] {
            let mesh = only(&format!("{vertices}{face}\n"));
            let areas = triangles(&mesh).into_iter().map(|[a, b, c]| {
                let [a, b, c] = [a, b, c].map(|corner| glam::Vec3::from(corner).truncate());
                (b - a).perp_dot(c - a) / 2.0
            });
            let areas: Vec<f32> = areas.collect();
            assert_eq!((areas.len(), areas.iter().sum::<f32>()), (5, sign * 10.0), "{turn} {face}");
            assert!(areas.iter().all(|area| area * sign > 0.0), "{turn} {face}: {areas:?}");
        }
    }
}

#[test]
fn negative_indices_count_backwards() {
    let after_each = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nf -3/-2/-1 -2/-1/-1 -1/-2/-1\n\
                      v 1 1 0\nvt 1 1\nf -3/2/1 -1/-1/-1 -2/1/-1\n";
    let all = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n\
               f 1/1/1 2/2/1 3/1/1\nf 2/2/1 4/3/1 3/1/1\n";
    assert_eq!(only(after_each), only(all));
}

/// A vertex for each combination of position, texture coordinates and normal, in the order of their numbers.
#[test]
fn corners_are_joined() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0.25\nvn 0 0 2\nvn 0 3 0\n\
                f 4/1/1 3/1/1 2/1/1\nf 1/1/1 2/1/1 3/1/1\nf 2/2/1 4/1/2 3/1/1\n";
    let mesh = only(text);
    assert_eq!(
        mesh.positions,
        [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]
    );
    // v points down, and normals have a length of 1.
    assert_eq!(mesh.uv[1..3], [[0.0, 1.0], [1.0, 0.75]]);
    assert_eq!(mesh.normals[4..], [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.indices, [4, 3, 1, 0, 1, 3, 2, 5, 3]);
}

/// Smooth across texture seams and materials, but not onto faces that have normals.
#[test]
fn missing_normals_are_smooth_at_positions() {
    let model = read(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvn 1 0 0\nvn 0 0 0\n\
         usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/2 4/3 2/1\nusemtl c\nf 1//1 3//1 4//1\nusemtl d\nf 1//2 3//1 4//1\n",
    )
    .expect("valid");
    let normal = |mesh: usize, position: [f32; 3]| {
        let mesh = &model.meshes[mesh];
        let at = mesh.positions.iter().position(|other| *other == position).expect("there");
        glam::Vec3::from(mesh.normals[at])
    };
    // The last face lacks the normal of its first corner, since a normal without a direction is none.
    let corner = normal(0, [0.0; 3]);
    assert!(corner.distance(glam::Vec3::ONE.normalize()) < 1e-6, "{corner}");
    assert_eq!([normal(1, [0.0; 3]), normal(3, [0.0; 3])], [corner; 2]);
    assert_eq!(normal(2, [0.0; 3]), glam::Vec3::X);
    let edge = normal(0, [1.0, 0.0, 0.0]);
    assert!(edge.distance(glam::Vec3::new(0.0, 1.0, 1.0).normalize()) < 1e-6, "{edge}");
}

#[test]
fn objects_groups_and_materials_become_meshes_below_bones() {
    let model = read(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no House with garden\nusemtl wood\nf 1 2 3\ng roof left\nf 1 2 3\nf 1 3 2\n\
         usemtl tiles\nf 1 2 3\no Shed\nf 1 2 3\ng roof left\nusemtl wood\nf 1 2 3\no House with garden\nf 1 2 3\ng\nf 1 2 3\n",
    )
    .expect("valid");
    let bones: Vec<_> = model.skeleton.bones().iter().map(|bone| (&*bone.name, bone.parent)).collect();
    let expected = [
        ("mesh", None),
        ("House with garden", None),
        ("roof left", Some(1)),
        ("Shed", None),
        ("roof left", Some(3)),
    ];
    assert_eq!(bones, expected);
    let meshes: Vec<_> = model
        .meshes
        .iter()
        .map(|mesh| (&*mesh.name, model.skins[mesh.skin].bones[0], mesh.indices.len() / 3))
        .collect();
    let expected = [
        ("mesh_0", 0, 1),
        // Without a library the materials are one: none. They still are meshes of their own.
        ("House with garden_0", 1, 3),
        ("roof left_0", 2, 2),
        ("roof left_1", 2, 1),
        ("Shed_0", 3, 1),
        ("roof left_0", 4, 1),
    ];
    assert_eq!(meshes, expected);
    assert_eq!((model.skinned, model.clips.len()), (0, 0));
}

#[test]
fn what_has_no_faces_is_left_out() {
    let mesh = only(
        "mtllib gone.mtl\nv 0 0 0 1\nv 1 0 0 0.5 0.25 1\nv 0 1 0\nvp 1 2\np 1 2\nl 1 2 3\ns off\nlod 3\n\
         curv 0 1 1 2\nunknown words\nvt 0.5\nvn 0 0 1\nf 1/1/ 2/1/ 3/1/\nf 1 2 2\nf 1 2 3 # the same\n",
    );
    assert_eq!((mesh.vertices(), mesh.indices.len()), (6, 6));
    assert_eq!(mesh.uv[..2], [[0.5, 1.0], [0.0, 0.0]]);
}

/// Lines in the manner of all systems, joined lines, tabs, and letters that are not UTF-8.
#[test]
fn text_is_read_as_it_comes() {
    let plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\no e\nf 1 2 3\n";
    let bytes = |text: &[u8]| Model::from_obj(text, None).expect("valid").meshes.remove(0);
    let expected = bytes(plain.as_bytes());
    for text in [plain.replace('\n', "\r\n"), plain.replace('\n', "\r"), plain.replace(' ', " \t ")] {
        assert_eq!(bytes(text.as_bytes()), expected, "{text:?}");
    }
    let joined = plain.replace("f 1 2 3", "f 1 \\\n2 \\\r\n 3");
    assert_eq!(bytes(joined.as_bytes()), expected);
    assert_eq!(bytes(format!("\u{feff}{plain}").as_bytes()), expected);
    let latin: Vec<u8> = plain.bytes().map(|byte| if byte == b'e' { 0xe9 } else { byte }).collect();
    assert_eq!(bytes(&latin).name, "\u{fffd}_0");
}

#[test]
fn mistakes_are_refused_with_their_line() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
    for (text, value, words) in [
        ("v 1 2", "v 1 2", "three numbers"),
        ("v 1 2 x", "v 1 2 x", "three numbers"),
        ("v 1 2 1e39", "v 1 2 1e39", "finite"),
        ("v 1 NaN 2", "v 1 NaN 2", "finite"),
        ("vt", "vt", "one to three numbers"),
        ("vt 1,5 2", "vt 1,5 2", "one to three numbers"),
        ("vt 1e300 0", "vt 1e300 0", "finite"),
        ("vn 0 1", "vn 0 1", "three numbers"),
        ("f 1 2", "f 1 2", "three or more corners"),
        ("f", "f", "three or more corners"),
        ("f 1 2 x", "f 1 2 x", "three or more corners"),
        ("f 1 2/1 3", "f 1 2/1 3", "all alike"),
        ("f 1/1/1/1 2 3", "f 1/1/1/1 2 3", "three or more corners"),
        ("f 0 1 2", "f 0 1 2", "counted from 1"),
        ("f 1 2 4", "f 1 2 4", "counted from 1"),
        ("f 1 2 -4", "f 1 2 -4", "counted from 1"),
        ("f 1/2 2/1 3/1", "f 1/2 2/1 3/1", "counted from 1"),
        ("f 1//1 2//1 3//2", "f 1//1 2//1 3//2", "counted from 1"),
        ("f 1 2 99999999999999999999", "f 1 2 99999999999999999999", "three or more corners"),
    ] {
        // A comment does not continue.
        let error = read(&format!("{start}# \\\n{text}\nf 1 2 3\n")).map(|_| ()).expect_err(text);
        let words = if words == "all alike" { "all like 1/1" } else { words };
        assert_eq!((&*error.path, &*error.value), ("line 7", value), "{error}");
        assert!(error.bound.contains(words), "{error}");
    }
    for text in ["", "glTF", "v 0 0 0\n", "p 1\n", "{\"asset\": {}}"] {
        let error = read(text).map(|_| ()).expect_err(text);
        assert!(error.path == "OBJ" && error.bound.contains("at least one face"), "{error}");
    }
    let flat = read("v 0 0 0\nv 0 0 1\nf 1 2 2\n").map(|_| ()).expect_err("no triangle");
    assert_eq!((&*flat.path, &*flat.value), ("OBJ", "[1 faces]"));
}

#[test]
fn files_are_read_by_their_endings() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("Cube.OBJ");
    std::fs::write(&path, CUBE).expect("writable");
    let model = Model::from_file(&path).expect("valid");
    assert_eq!(model, Model::from_obj(CUBE.as_bytes(), Some(folder.path())).expect("valid"));
    assert_eq!(Model::from_file_bare(&path).expect("valid"), model);
    std::fs::write(&path, "f 1 2 3\n").expect("writable");
    let error = Model::from_file(&path).expect_err("no vertices").to_string();
    assert!(error.contains("Cube.OBJ: line 1 = f 1 2 3: must name"), "{error}");
}
