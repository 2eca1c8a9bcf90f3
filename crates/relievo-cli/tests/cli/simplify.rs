//! `relievo simplify`.

use std::path::{Path, PathBuf};

use relievo::asset::Model;
use relievo_lab::files::sha256;
use serde_json::Value;

use crate::assert_refused;
use crate::harness::relievo;

/// Cells along an edge of the model.
const CELLS: usize = 16;

/// A folder with hills.obj: quadrangles of two objects that share a border, one of them with a material of hills.mtl.
struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        let bench = Self(tempfile::tempdir().expect("a temporary folder"));
        let mut text = "mtllib hills.mtl\n".to_owned();
        for row in 0..=CELLS {
            for column in 0..=CELLS {
                let [x, z] = [column, row].map(|at| at as f32 / CELLS as f32);
                let y = 0.1 * (7.0 * x).sin() * (5.0 * z).cos();
                text += &format!("v {x} {y} {z}\nvt {x} {z}\n");
            }
        }
        for (name, columns) in
            [("left\nusemtl grass", 0..CELLS / 2), ("right\nusemtl none", CELLS / 2..CELLS)]
        {
            text += &format!("o {name}\n");
            for row in 0..CELLS {
                for column in columns.clone() {
                    let corner = |x: usize, z: usize| 1 + (row + z) * (CELLS + 1) + column + x;
                    let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)];
                    text += &format!("f {a}/{a} {b}/{b} {c}/{c} {d}/{d}\n");
                }
            }
        }
        bench.write("hills.obj", &text);
        bench.write("hills.mtl", "newmtl grass\nKd 0.2 0.6 0.1\n");
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("writable");
    }

    /// Runs the command on a model into `out`, and returns its report.
    fn levels(&self, model: &str, more: &[&str]) -> Value {
        let (model, out) = (self.model(model), self.path("out"));
        let run = relievo(
            &[&["simplify", "--model", &model, "--out", out.to_str().expect("UTF-8")], more].concat(),
        );
        assert_eq!((run.code, run.stderr.trim()), (Some(0), ""), "{more:?}");
        self.json("out/report.json")
    }

    fn model(&self, name: &str) -> String {
        if name.starts_with("builtin") {
            name.to_owned()
        } else {
            self.path(name).to_str().expect("UTF-8").to_owned()
        }
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&std::fs::read(self.path(name)).expect("written")).expect("JSON")
    }

    fn names(&self) -> Vec<String> {
        let entries = self.path("out").read_dir().expect("written");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

fn triangles(model: &Model) -> usize {
    model.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum()
}

/// Checks a level of a report against its file: the model of it.
fn checked(out: &Path, level: &Value) -> Model {
    let path = out.join(level["file"].as_str().expect("a name"));
    let model = Model::from_file(&path).expect("readable");
    assert_eq!(level["triangles"], triangles(&model), "{level}");
    let vertices: usize = model.meshes.iter().map(|mesh| mesh.vertices()).sum();
    assert_eq!(level["vertices"], vertices, "{level}");
    assert_eq!(level["hash"], sha256(&std::fs::read(&path).expect("readable")), "{level}");
    let [rms, max] = ["error_rms", "error_max"].map(|name| level[name].as_f64().expect("a number"));
    assert!(0.0 <= rms && rms <= max && max < 0.3, "{level}");
    model
}

const ALL: usize = 2 * CELLS * CELLS;

#[test]
fn levels_are_written_in_their_order() {
    let bench = Bench::new();
    for (format, files) in [
        (
            "glb",
            &["level_0.glb", "level_1.glb", "level_2.glb", "level_3.glb", "levels.png", "report.json"][..],
        ),
        ("obj", &["level_0.mtl", "level_0.obj", "level_1.mtl", "level_1.obj"][..]),
    ] {
        // The second run has fewer levels of another format: those of the first are removed.
        let targets: &[&str] = match format {
            "glb" => &["--error", "0.02", "--triangles", "100,40", "--share", "1"],
            _ => &["--share", "0.5", "0.1"],
        };
        let report = bench.levels("hills.obj", &[targets, &["--format", format]].concat());
        assert_eq!(
            (report["reducer"].as_str(), report["model"].as_str()),
            (Some("quadric"), Some(&*bench.model("hills.obj")))
        );
        assert!(report["seconds"].as_f64().is_some_and(|seconds| seconds > 0.0));
        let levels = report["levels"].as_array().expect("a list");
        let models: Vec<Model> = levels.iter().map(|level| checked(&bench.path("out"), level)).collect();
        let counts: Vec<usize> = models.iter().map(triangles).collect();
        let errors: Vec<f64> = levels.iter().filter_map(|level| level["error_max"].as_f64()).collect();
        if format == "glb" {
            assert_eq!(bench.names(), files);
            assert!((90..=100).contains(&counts[0]) && (30..=40).contains(&counts[1]), "{counts:?}");
            assert_eq!((counts[2], errors[2] < 1e-12), (ALL, true));
            assert!(errors[3] <= 0.02 && counts[3] < ALL / 3, "{counts:?} {errors:?}");
        } else {
            assert_eq!(bench.names(), [files, &["levels.png", "report.json"]].concat());
            assert!((ALL / 2 - 8..=ALL / 2).contains(&counts[0]) && counts[1] <= ALL / 10, "{counts:?}");
        }
        // Both objects are there, one of them with its material.
        for model in &models {
            let names: Vec<_> =
                model.meshes.iter().map(|mesh| mesh.material.map(|at| &*model.materials[at].name)).collect();
            assert_eq!(names, [Some("grass"), None]);
        }
        let picture = relievo_testing::picture(bench.path("out/levels.png")).to_rgb8();
        let pictures = if format == "glb" { 5 } else { 3 };
        assert_eq!(picture.width(), pictures * (384 + 8) + 8);
        let green = picture
            .pixels()
            .filter(|pixel| u16::from(pixel[1]) > 2 * u16::from(pixel[0]) && pixel[1] > 40)
            .count();
        assert!(green > 5000, "{green}");
    }
}

/// The border between the two objects stays closed: each of its points belongs to both.
#[test]
fn shared_borders_stay_closed() {
    let bench = Bench::new();
    bench.levels("hills.obj", &["--share", "0.3", "0.1", "0.05", "--backend", "cpu"]);
    for level in 0..3 {
        let model = Model::from_file(&bench.path(&format!("out/level_{level}.glb"))).expect("readable");
        let border = |mesh: usize| -> Vec<[u32; 3]> {
            let all = model.meshes[mesh].positions.iter().filter(|position| position[0] == 0.5);
            let mut all: Vec<_> = all.map(|position| position.map(f32::to_bits)).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        assert!(border(0).len() >= 2 && border(0) == border(1), "level {level}");
    }
}

#[test]
fn both_backends_draw_and_normals_are_as_asked() {
    let bench = Bench::new();
    let mut pictures = Vec::new();
    for backend in ["gpu", "cpu"] {
        bench.levels("hills.obj", &["--share", "0.2", "--backend", backend, "--normals", "recompute"]);
        pictures.push(relievo_testing::picture(bench.path("out/levels.png")).to_rgb8());
    }
    let pairs = pictures[0].as_raw().iter().zip(pictures[1].as_raw());
    let off = pairs.filter(|(a, b)| a.abs_diff(**b) > 3).count() as f64 / pictures[0].as_raw().len() as f64;
    assert!(off < 0.02, "{off} of the channels differ");
    let level = Model::from_file(&bench.path("out/level_0.glb")).expect("readable");
    let mesh = &level.meshes[0];
    let mut sums = vec![glam::Vec3::ZERO; mesh.vertices()];
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|corner| glam::Vec3::from(mesh.positions[corner as usize]));
        triangle.iter().for_each(|corner| sums[*corner as usize] += (b - a).cross(c - a));
    }
    for (sum, normal) in sums.iter().zip(&mesh.normals) {
        assert!(sum.normalize().distance(glam::Vec3::from(*normal)) < 1e-5, "{normal:?}");
    }
}

#[test]
fn reducers_are_compared() {
    let bench = Bench::new();
    let out = bench.path("out");
    let arguments = [
        "simplify",
        "--model",
        &bench.model("hills.obj"),
        "--compare",
        "--out",
        out.to_str().expect("UTF-8"),
    ];
    let run = relievo(&arguments);
    assert_eq!((run.code, run.stderr.trim()), (Some(0), ""));
    assert_eq!(bench.names(), ["compare.json", "compare.md", "compare.png"]);
    let found = bench.json("out/compare.json");
    let table = std::fs::read_to_string(bench.path("out/compare.md")).expect("written");
    assert_eq!(run.stdout.trim(), table.trim());
    let rows = found["reducers"].as_array().expect("a list");
    let names: Vec<_> = rows.iter().filter_map(|row| row["reducer"].as_str()).collect();
    assert_eq!(names, relievo_lab::reduce::Reducer::ALL.map(|(name, _)| name));
    let all = found["whole"]["triangles"].as_f64().expect("a number");
    let mut lines = 1;
    for row in rows {
        let levels = row["levels"].as_array().expect("a list");
        lines += levels.len();
        for level in levels {
            let number = |name: &str| level[name].as_f64().unwrap_or_else(|| panic!("{name} of {level}"));
            // Some reducers stop before.
            let most = if row["reducer"] == "quadric" { number("share") * all + 1.0 } else { all };
            assert!(number("triangles") <= most, "{row}");
            assert!(number("error_rms") <= number("error_max") && number("error_rms") > 0.0, "{level}");
            assert!(number("gzip_bytes") < number("json_bytes"), "{level}");
            let seconds = number("json_bytes") * 8.0 / 2_097_152.0;
            assert!(
                (level["download_seconds"][0].as_f64().expect("seconds") - seconds).abs() < 1e-12,
                "{level}"
            );
        }
    }
    assert_eq!(table.lines().filter(|line| line.starts_with("| ")).count(), lines + 1);
    assert_eq!(relievo_testing::picture(bench.path("out/compare.png")).width(), 1200);
}

/// A model in which each triangle has texture coordinates of its own keeps its triangles, and the output says why.
#[test]
fn seams_of_textures_are_held_or_crossed() {
    let bench = Bench::new();
    let mut text = "mtllib charts.mtl\nusemtl charts\n".to_owned();
    let mut corners = 0;
    for cell in 0..256_u32 {
        let [x, z] = [cell % 16, cell / 16];
        for triangle in [[[0, 0], [0, 1], [1, 1]], [[0, 0], [1, 1], [1, 0]]] {
            let chart = corners / 3;
            for ([right, down], [u, v]) in triangle.into_iter().zip([[0.1, 0.1], [0.1, 0.8], [0.8, 0.8]]) {
                let [x, z] = [x + right, z + down].map(|at| f64::from(at) / 16.0);
                let [u, v] = [f64::from(chart % 32) + u, f64::from(chart / 32) + v].map(|at| at / 32.0);
                let y = 0.1 * (5.0 * x).sin() * (4.0 * z).cos();
                text += &format!("v {x} {y} {z}\nvt {u} {v}\n");
            }
            text += &format!("f {0}/{0} {1}/{1} {2}/{2}\n", corners + 1, corners + 2, corners + 3);
            corners += 3;
        }
    }
    bench.write("charts.obj", &text);
    bench.write("charts.mtl", "newmtl charts\nmap_Kd charts.png\n");
    image::RgbaImage::new(4, 4).save(bench.path("charts.png")).expect("writable");
    let out = bench.path("out");
    let model = bench.model("charts.obj");
    let arguments = ["simplify", "--model", &model, "--share", "0.2", "--out", out.to_str().expect("UTF-8")];
    let run = relievo(&arguments);
    assert_eq!((run.code, run.stderr.trim()), (Some(0), ""));
    let hindrance = "held by seams of texture coordinates: see --texture-seams";
    assert!(run.stdout.contains(hindrance), "{}", run.stdout);
    let level = &bench.json("out/report.json")["levels"][0];
    assert_eq!((&level["triangles"], &level["stopped"]), (&510.into(), &"seams".into()));

    let run = relievo(&[&arguments[..], &["--texture-seams", "cross"]].concat());
    assert_eq!((run.code, run.stderr.trim()), (Some(0), ""));
    assert!(!run.stdout.contains("held"), "{}", run.stdout);
    let level = &bench.json("out/report.json")["levels"][0];
    assert_eq!(level["stopped"], "triangles");
    assert!(level["triangles"].as_u64().is_some_and(|left| (80..=102).contains(&left)), "{level}");
}

#[test]
fn mistakes_are_refused_and_nothing_is_written() {
    let bench = Bench::new();
    bench.write("broken.obj", "v 0 0 0\nf 1 2 3\n");
    bench.write("points.obj", "v 0 0 0\np 1\n");
    let out = bench.path("out");
    let out = out.to_str().expect("UTF-8");
    for (model, more, words) in [
        ("hills.obj", &[][..], "--triangles"),
        ("hills.obj", &["--share", "0"], "share = 0: must be above 0"),
        ("hills.obj", &["--share", "0.5,1.5"], "share = 1.5: must be above 0"),
        ("hills.obj", &["--share", "NaN"], "share = NaN"),
        ("hills.obj", &["--share", "-0.5"], "share = -0.5"),
        ("hills.obj", &["--share", "half"], "--share"),
        ("hills.obj", &["--triangles", "0"], "triangles = 0: must be in 1..=512"),
        ("hills.obj", &["--triangles", "513"], "triangles = 513: must be in 1..=512"),
        ("hills.obj", &["--error", "-1"], "error = -1: must be finite"),
        ("hills.obj", &["--error", "inf"], "error = inf: must be finite"),
        (
            "hills.obj",
            &["--share", "0.5", "--reducer", "best"],
            "reducer = best: must be one of quadric, melax",
        ),
        ("hills.obj", &["--share", "0.5", "--format", "ply"], "--format"),
        ("hills.obj", &["--share", "0.5", "--normals", "no"], "--normals"),
        ("hills.obj", &["--share", "0.5", "--texture-seams", "no"], "--texture-seams"),
        (
            "hills.obj",
            &["--share", "0.5", "--texture-seams", "cross", "--reducer", "vertex-pair"],
            "texture-seams = cross: must be hold with the reducer vertex-pair",
        ),
        ("hills.obj", &["--share", "0.5", "--compare"], "--compare"),
        ("builtin:cow", &["--share", "0.5"], "model = cow: must be one of creature, rock, wall"),
        ("gone.obj", &["--share", "0.5"], "gone.obj"),
        ("broken.obj", &["--share", "0.5"], "broken.obj: line 2 = f 1 2 3: must name v"),
        ("points.obj", &["--compare"], "points.obj: OBJ"),
    ] {
        let model = bench.model(model);
        let arguments = [&["simplify", "--model", &model, "--out", out], more].concat();
        assert_refused(&relievo(&arguments), &arguments, &[words]);
        assert!(!Path::new(out).exists(), "{arguments:?}");
    }
    std::fs::write(out, "a file").expect("writable");
    let model = bench.model("hills.obj");
    let arguments = ["simplify", "--model", &model, "--share", "0.5", "--out", out];
    assert_refused(&relievo(&arguments), &arguments, &["is not a folder"]);
}
