//! `relievo skin` on models of its own and on the built-in one.

mod attached;

use std::path::Path;

use serde_json::json;

use crate::harness::relievo;
use crate::push_raised_and_morphed;
use crate::scene::Scene;

/// A folder with `model.gltf`: a triangle whose last corner follows the upper of two joints and a morph target, and a
/// clip that lifts that joint and the target's weight.
struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        let mut scene = Scene::of_two_bones();
        let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.1, 0.0]);
        scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
        scene.json["accessors"][positions]["max"] = json!([1, 0.1, 0]);
        let target = scene.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]);
        let weights = scene.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
        let joints = scene.integers("VEC4", 1, &[0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0]);
        scene.json["meshes"] = json!([{"primitives": [{
            "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights},
            "targets": [{"POSITION": target}],
        }]}]);
        scene.push("nodes", json!({"name": "my body", "skin": 0, "mesh": 0}));
        push_raised_and_morphed(&mut scene, 5.0);
        let bench = Self(tempfile::tempdir().expect("a temporary folder"));
        std::fs::write(bench.path("model.gltf"), scene.gltf()).expect("writable");
        for (weight, name) in [(0.0, "unweighted.gltf"), (-1.0, "loose.gltf")] {
            let weights = scene.floats("VEC4", &[weight, 0.0, 0.0, 0.0].repeat(3));
            scene.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
            std::fs::write(bench.path(name), scene.gltf()).expect("writable");
        }
        scene.json["nodes"][2].as_object_mut().expect("an object").remove("mesh");
        std::fs::write(bench.path("bare.gltf"), scene.gltf()).expect("writable");
        bench
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().expect("UTF-8").to_owned()
    }

    /// The lines of mesh.obj or, if nothing has a skin, of attached.obj.
    fn skin(&self, model: &str, more: &[&str]) -> Vec<String> {
        let out = self.path("out");
        let run = relievo(&[&["skin", "--model", model, "--out", &out], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert_eq!(run.stdout.is_empty(), !more.contains(&"--within"), "{}", run.stdout);
        assert!(run.stderr.is_empty());
        let picture = relievo_testing::picture(Path::new(&out).join("skin.png")).to_rgb8();
        // The picture shows something in its middle that differs from its corner.
        let corner = picture.get_pixel(0, 0);
        let covered = picture.pixels().filter(|pixel| *pixel != corner).count() as f64;
        let fraction = covered / f64::from(picture.width() * picture.height());
        assert!((0.02..0.9).contains(&fraction), "{fraction}");
        let read = |name: &str| std::fs::read_to_string(Path::new(&out).join(name));
        let text = read("mesh.obj").or_else(|_| read("attached.obj")).expect("written");
        text.lines().map(str::to_owned).collect()
    }

    fn refused(&self, model: &str, more: &[&str], words: &str) {
        let out = self.path("never");
        let run = relievo(&[&["skin", "--model", model, "--out", &out, "--time", "0"], more].concat());
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(run.stderr.contains(words) && run.stderr.lines().count() == 1, "{}", run.stderr);
        assert!(!Path::new(&out).exists());
    }
}

#[test]
fn a_mesh_is_written_where_its_bones_and_targets_are() {
    let bench = Bench::new();
    for backend in ["gpu", "cpu"] {
        let lines =
            bench.skin(&bench.path("model.gltf"), &["--clip", "0", "--time", "2.5", "--backend", backend]);
        // At a quarter of the clip the joint is at y = 2, and the target's weight is ¼.
        assert_eq!(lines[..4], ["o my_body_0", "v 0 0 0", "v 1 0 0", "v 0 2.1 1"]);
        assert_eq!(lines.last().map(String::as_str), Some("f 1/1/1 2/2/2 3/3/3"));
        assert_eq!(lines.len(), 1 + 3 * 3 + 1);
        let end = ["--clip", "0", "--time", "9", "--wrap", "clamp", "--backend", backend];
        assert_eq!(bench.skin(&bench.path("model.gltf"), &end)[3], "v 0 5.1 4");
    }
}

#[test]
fn both_backends_agree_and_every_option_matters() {
    let bench = Bench::new();
    let vertices = |more: &[&str]| -> Vec<f32> {
        let all = bench.skin("builtin", &[&["--clip", "walk", "--time", "0.3"], more].concat());
        let of_places = all.iter().filter_map(|line| line.strip_prefix("v "));
        of_places.flat_map(|line| line.split(' ').map(|x| x.parse::<f32>().expect("a number"))).collect()
    };
    let largest = |a: &[f32], b: &[f32]| {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    };
    let full = vertices(&[]);
    for options in [
        &["--dual-quaternion"][..],
        &["--influences", "truncate:2"],
        &["--influences", "fade:0.5"],
        &["--influences", "fade:1", "--dual-quaternion"],
    ] {
        let [gpu, cpu] = ["gpu", "cpu"].map(|name| vertices(&[options, &["--backend", name]].concat()));
        assert!(largest(&gpu, &cpu) < 1e-5, "{options:?}");
        assert!(largest(&gpu, &full) > 1e-4, "{options:?}");
    }
    assert_eq!(vertices(&["--influences", "fade:0"]), full);
    assert_eq!(vertices(&["--influences", "truncate:8"]), full);
    assert_eq!(vertices(&["--influences", "fade:1"]), vertices(&["--influences", "truncate:1"]));
}

/// The vertices stay the same; the larger the permitted error, the fewer triangles there are.
#[test]
fn triangles_are_left_out() {
    let bench = Bench::new();
    let found = |more: &[&str]| {
        let lines = bench.skin("builtin", &[&["--clip", "walk", "--time", "0.3"], more].concat());
        let (faces, others): (Vec<_>, Vec<_>) = lines.into_iter().partition(|line| line.starts_with("f "));
        (faces.len(), others)
    };
    let (all, places) = found(&[]);
    assert_eq!(found(&["--within", "0"]), (all, places.clone()));
    let (near, far) = (found(&["--within", "0.003", "--backend", "cpu"]), found(&["--within", "0.015"]));
    assert!(near.0 < all * 2 / 3 && far.0 < all / 8, "{all}, {}, {}", near.0, far.0);
    assert_eq!((near.1.len(), far.1), (places.len(), places));
}

/// A sheet whose middle rises for a thirtieth of a second in a hundred seconds; 60 poses a second catch it.
#[test]
fn every_sixtieth_of_a_second_counts() {
    let mut scene = Scene::of_two_bones();
    let corners = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]];
    let positions: Vec<f32> = corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]).collect();
    let positions = scene.floats("VEC3", &positions);
    scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
    scene.json["accessors"][positions]["max"] = json!([2, 1, 0]);
    let joints: Vec<u32> = (0..6).flat_map(|at| [u32::from(at % 3 == 1), 0, 0, 0]).collect();
    let joints = scene.integers("VEC4", 1, &joints);
    let weights = scene.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(6));
    let indices = scene.integers("SCALAR", 1, &[0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4]);
    scene.json["meshes"] = json!([{"primitives": [{
        "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights},
        "indices": indices,
    }]}]);
    scene.push("nodes", json!({"name": "sheet", "skin": 0, "mesh": 0}));
    scene.json["nodes"][1]["translation"] = json!([0, 0, 0]);
    let times = scene.floats("SCALAR", &[0.0, 50.03, 50.04, 50.06, 50.07, 100.0]);
    let still = [0.0; 3];
    let up = [0.0, 0.0, 1.0];
    let values = scene.floats("VEC3", [still, still, up, up, still, still].as_flattened());
    scene.push(
        "animations",
        json!({
            "samplers": [{"input": times, "output": values}],
            "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
        }),
    );
    let bench = Bench::new();
    std::fs::write(bench.path("sheet.gltf"), scene.gltf()).expect("writable");
    let left = |within: &str| {
        let (model, out) = (bench.path("sheet.gltf"), bench.path("out"));
        let clip = ["--clip", "0", "--time", "0", "--backend", "cpu", "--within", within];
        let run = relievo(&[&["skin", "--model", &model, "--out", &out][..], &clip].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        run.stdout
    };
    assert_eq!(left("0.9"), "sheet_0: 4 of 4 triangles, 0 metres off\n");
    let coarse = left("1.2");
    assert!(coarse.starts_with("sheet_0: 2 of 4 triangles, 1."), "{coarse}");
}

#[test]
fn what_cannot_be_skinned_is_refused() {
    let bench = Bench::new();
    for metres in ["-1", "NaN", "inf"] {
        bench.refused("builtin", &["--clip", "walk", "--within", metres], "within");
    }
    let path = |name| bench.path(name);
    for (influences, words) in [
        ("half", "must be full, truncate:K or fade:LAMBDA"),
        ("truncate:0", "must be in 1..=8"),
        ("truncate:9", "must be in 1..=8"),
        ("fade:1.5", "must be in 0..=1"),
        ("fade:NaN", "must be in 0..=1"),
        ("fade:", "must be full"),
    ] {
        bench.refused(&path("model.gltf"), &["--clip", "0", "--influences", influences], words);
    }
    bench.refused(
        &path("loose.gltf"),
        &["--clip", "0"],
        "meshes[0].primitives[0].attributes.WEIGHTS_0[0] = -1",
    );
    // Vertices without weights follow their first joint.
    let [of_weights, of_none] = ["model.gltf", "unweighted.gltf"]
        .map(|name| bench.skin(&path(name), &["--clip", "0", "--time", "2.5"]));
    assert_eq!(of_none, of_weights);
    bench.refused(&path("bare.gltf"), &["--clip", "0"], "meshes.len = 0");
    bench.refused(&path("model.gltf"), &["--clip", "5"], "clip = 5");
    bench.refused("builtin", &["--clip", "run"], "walk");
}

/// A texture with a quadrant each of red, green, blue and white, sampled at the nearest texel.
#[test]
fn textures_are_seen() {
    let bench = Bench::new();
    let colors = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]];
    let image = image::RgbImage::from_fn(2, 2, |x, y| image::Rgb(colors[(2 * y + x) as usize]));
    image.save(bench.path("paint.png")).expect("written");
    let mut scene = Scene::of_two_bones();
    let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
    scene.json["accessors"][positions]["max"] = json!([1, 1, 0]);
    let uv = scene.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    let indices = scene.integers("SCALAR", 2, &[0, 1, 2, 0, 2, 3]);
    scene.json["meshes"] = json!([{"primitives": [
        {"attributes": {"POSITION": positions, "TEXCOORD_0": uv}, "indices": indices, "material": 0}
    ]}]);
    scene.json["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    scene.json["images"] = json!([{"uri": "paint.png"}]);
    scene.json["samplers"] = json!([{"magFilter": 9728}]);
    scene.json["textures"] = json!([{"source": 0, "sampler": 0}]);
    scene.push("nodes", json!({"mesh": 0}));
    let (times, values) = (scene.floats("SCALAR", &[0.0]), scene.floats("VEC3", &[0.0; 3]));
    scene.animate(1, "translation", "LINEAR", times, values);
    std::fs::write(bench.path("painted.gltf"), scene.gltf()).expect("writable");
    for backend in ["gpu", "cpu"] {
        bench.skin(&bench.path("painted.gltf"), &["--clip", "0", "--time", "0", "--backend", backend]);
        let picture = relievo_testing::picture(Path::new(&bench.path("out")).join("skin.png")).to_rgb8();
        for (color, [x, y]) in colors.iter().zip([[0.3, 0.3], [0.7, 0.3], [0.3, 0.7], [0.7, 0.7]]) {
            let at = |fraction: f64, edge: u32| (fraction * f64::from(edge)) as u32;
            let found = picture.get_pixel(at(x, picture.width()), at(y, picture.height())).0;
            for (found, wanted) in found.iter().zip(color) {
                assert!(
                    if *wanted > 0 { *found > 150 } else { *found < 5 },
                    "{backend}: {found} for {color:?}"
                );
            }
        }
    }
    std::fs::remove_file(bench.path("paint.png")).expect("removed");
    bench.refused(&bench.path("painted.gltf"), &["--clip", "0"], "images[0].uri = paint.png");
}
