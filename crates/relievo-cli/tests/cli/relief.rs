//! `relievo relief`, good and bad input.

use std::path::{Path, PathBuf};

use relievo::ops::surface::{Address, HeightMap, ReliefRay};
use relievo_lab::measure::relief::exact::exact;
use serde_json::Value;

use crate::harness::{Difference, relievo};

/// A folder with images of 16 × 12 texels, and a place for output.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let height = |x: u32, y: u32| ((x * 37 + y * 91) % 16 * 17) as u8;
        let grey = image::GrayImage::from_fn(16, 12, |x, y| image::Luma([height(x, y)]));
        grey.save(folder.path().join("height.png")).expect("writable");
        let color =
            image::RgbaImage::from_fn(16, 12, |x, y| image::Rgba([x as u8 * 15, 90, 60, height(x, y)]));
        color.save(folder.path().join("albedo.png")).expect("writable");
        image::RgbImage::new(4, 4).save(folder.path().join("opaque.png")).expect("writable");
        std::fs::write(folder.path().join("text.png"), "not an image").expect("writable");
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs `relief` into the folder `out`; words that start with `@` are files of the bench.
    fn run(&self, out: &str, arguments: &[&str]) -> crate::harness::Run {
        let path = |name: &str| self.path(name).to_str().expect("UTF-8").to_owned();
        let mut words = vec!["relief".to_owned(), "--out".to_owned(), path(out)];
        words.extend(arguments.iter().map(|word| word.strip_prefix('@').map_or(word.to_string(), path)));
        relievo(&words.iter().map(String::as_str).collect::<Vec<_>>())
    }

    fn made(&self, out: &str, arguments: &[&str]) {
        let run = self.run(out, arguments);
        assert_eq!(run.code, Some(0), "{arguments:?}: {}", run.stderr);
    }

    fn report(&self, out: &str) -> Value {
        let text = std::fs::read_to_string(self.path(out).join("report.json")).expect("written");
        serde_json::from_str(&text).expect("JSON")
    }

    fn floats<const N: usize>(&self, file: &str) -> Vec<[f32; N]> {
        let bytes = std::fs::read(self.path(file)).expect("written");
        let all: Vec<f32> = bytes
            .chunks_exact(4)
            .map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect();
        all.chunks_exact(N).map(|row| row.try_into().expect("whole rows")).collect()
    }

    fn image(&self, file: &str) -> image::RgbaImage {
        relievo_testing::picture(self.path(file)).into_rgba8()
    }
}

fn map(path: &Path) -> HeightMap {
    HeightMap::from_file(path).expect("a height map")
}

/// The files agree: rays that enter at height 1, their hits, and errors against the exact intersection.
#[test]
fn rays_hits_and_errors_fit_together() {
    let bench = Bench::new();
    let common =
        ["--size", "64x40", "--angle", "62", "--azimuth", "33", "--tile", "1.5", "--height", "@height.png"];
    let heights = map(&bench.path("height.png"));
    for method in ["plain", "parallax", "parallax-limited", "relief", "occlusion", "cone", "quadtree"] {
        bench.made("out", &[&common[..], &["--method", method]].concat());
        let (rays, hits) = (bench.floats::<6>("out/rays.f32"), bench.floats::<4>("out/hits.f32"));
        assert_eq!((rays.len(), hits.len()), (64 * 40, 64 * 40));
        let mut errors = Vec::new();
        for ([u, v, top, du, dv, dh], [hit_u, hit_v, height, met]) in rays.into_iter().zip(hits) {
            if dh == 0.0 {
                assert_eq!([u, v, top, du, dv, hit_u, hit_v, height, met], [0.0; 9]);
                continue;
            }
            assert_eq!([top, dh, met], [1.0, -1.0, 1.0]);
            assert!((0.0..=1.5).contains(&u) && (0.0..=1.5).contains(&v) && (0.0..=1.0).contains(&height));
            let ray = ReliefRay { origin: [u, v], slope: [du, dv], cosine: 1.0, polygon: 0.0 };
            let exact = exact(&heights, &ray, Address::Wrap).expect("from above");
            let [x, y] = [f64::from(hit_u) - exact.uv[0], f64::from(hit_v) - exact.uv[1]];
            errors.push((x * 16.0).hypot(y * 12.0));
        }
        assert!(errors.len() > 500, "the square fills the picture");
        let report = bench.report("out");
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let says = report["mean_error_texels"].as_f64().expect("a number");
        assert!((mean - says).abs() < 1e-4, "{method}: {mean} and {says}");
        assert_eq!(report["method"], method);
        for key in ["p99_error_texels", "max_error_texels", "samples_per_pixel", "mean_samples"] {
            assert!(report[key].is_number(), "{key}");
        }
        assert!(report["adapter"].is_string() && report["driver"].is_string());
        if ["cone", "quadtree"].contains(&method) {
            assert!(errors.iter().all(|error| *error < 0.05), "{method}: {mean}");
        }
    }
}

/// Both backends find the same hits and draw like pictures, for every shadow and address mode.
#[test]
fn backends_draw_the_same() {
    let bench = Bench::new();
    let cases: [&[&str]; 5] = [
        &["--builtin", "bricks", "--texels", "128", "--shadow", "hard"],
        &["--builtin", "cobbles", "--texels", "100", "--shadow", "soft", "--silhouette", "--azimuth", "140"],
        &[
            "--albedo",
            "@albedo.png",
            "--address",
            "clamp",
            "--method",
            "cone",
            "--tile",
            "2",
            "--angle",
            "70",
        ],
        &["--height", "@height.png", "--normal", "@opaque.png", "--method", "relief", "--light", "10,60"],
        &[
            "--builtin",
            "text",
            "--texels",
            "128",
            "--method",
            "occlusion",
            "--bias",
            "-0.05",
            "--shadow",
            "hard",
        ],
    ];
    for case in cases {
        let size = ["--size", "160x100"];
        bench.made("gpu", &[case, &size].concat());
        bench.made("cpu", &[case, &size, &["--backend", "cpu"]].concat());
        let [gpu, cpu] = ["gpu/hits.f32", "cpu/hits.f32"].map(|file| bench.floats::<4>(file));
        let near =
            |(a, b): &(&[f32; 4], &[f32; 4])| a.iter().zip(b.iter()).all(|(a, b)| (a - b).abs() <= 1e-3);
        let astray = gpu.iter().zip(&cpu).filter(|pair| !near(pair)).count();
        assert!(astray * 200 <= gpu.len(), "{case:?}: {astray} of {} hits differ", gpu.len());
        let difference = Difference::of(&bench.image("gpu/relief.png"), &bench.image("cpu/relief.png"), 3);
        // The rasterizer and the reference disagree about who owns a pixel on the square's edge.
        assert!(difference.outliers <= 0.02 && difference.flip <= 0.01, "{case:?}: {difference:?}");
        let report = bench.report("cpu");
        assert!(report["adapter"].is_null() && report["backend"] == "cpu");
    }
}

#[test]
fn alpha_is_the_height_where_no_other_is_given() {
    let bench = Bench::new();
    let common = ["--size", "40x30", "--angle", "55"];
    bench.made("alpha", &[&common[..], &["--albedo", "@albedo.png"]].concat());
    bench.made("height", &[&common[..], &["--height", "@height.png"]].concat());
    let [alpha, height] = ["alpha/hits.f32", "height/hits.f32"].map(|file| bench.floats::<4>(file));
    assert_eq!(alpha, height);
    assert_ne!(bench.image("alpha/relief.png"), bench.image("height/relief.png"));
}

/// A normal map baked from the heights gives the shading of the heights, whichever way its green channel
/// points.
#[test]
fn normal_maps_say_what_heights_say() {
    let bench = Bench::new();
    let map = relievo_samples::BuiltInMap::Cobbles.height_map(128).expect("a map");
    let grey = image::GrayImage::from_fn(128, 128, |x, y| {
        image::Luma([(map.texel(x as i32, y as i32, Address::Wrap) * 255.0).round() as u8])
    });
    grey.save(bench.path("cobbles.png")).expect("writable");
    for (name, green) in [("up", -1.0), ("down", 1.0)] {
        let normals = image::RgbImage::from_fn(128, 128, |x, y| {
            let at = |dx: i32, dy: i32| map.texel(x as i32 + dx, y as i32 + dy, Address::Wrap);
            // The depth is 0.1 of 128 texels, 12.8; the difference spans two texels.
            let [x, y] = [at(1, 0) - at(-1, 0), at(0, 1) - at(0, -1)].map(|rise| -0.5 * 12.8 * rise);
            let length = (x * x + y * y + 1.0).sqrt();
            let byte = |part: f32| ((part / length * 0.5 + 0.5) * 255.0).round() as u8;
            image::Rgb([byte(x), byte(green * y), byte(1.0)])
        });
        normals.save(bench.path(&format!("{name}.png"))).expect("writable");
    }
    for light in ["0,30", "90,30", "225,40"] {
        let common = ["--height", "@cobbles.png", "--angle", "30", "--size", "120x90", "--light", light];
        bench.made("heights", &common);
        let from_heights = bench.image("heights/relief.png");
        for green in ["up", "down"] {
            let file = format!("@{green}.png");
            let more = ["--normal", &file, "--normal-green", green];
            bench.made("normals", &[&common[..], &more].concat());
            let difference = Difference::of(&bench.image("normals/relief.png"), &from_heights, 24);
            assert!(difference.outliers < 0.04, "{light} {green}: {difference:?}");
        }
        // With the wrong direction the shading is far off if light comes along v.
        bench.made("wrong", &[&common[..], &["--normal", "@up.png", "--normal-green", "down"]].concat());
        let difference = Difference::of(&bench.image("wrong/relief.png"), &from_heights, 24);
        assert!(light == "90,30" || difference.outliers > 0.2, "{light}: {difference:?}");
    }
}

#[test]
fn the_comparison_names_every_method_at_every_angle() {
    let bench = Bench::new();
    bench.made("out", &["--compare", "--builtin", "posts", "--texels", "64", "--size", "48x48"]);
    let text = std::fs::read_to_string(bench.path("out/compare.json")).expect("written");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    let entries = report["entries"].as_array().expect("entries");
    for angle in [0.0, 30.0, 60.0, 80.0] {
        let here = |method: &str| {
            entries.iter().filter(|entry| entry["angle"] == angle && entry["method"] == method).count()
        };
        for method in ["plain", "parallax", "parallax-limited", "cone", "quadtree"] {
            assert_eq!(here(method), 1, "{method} at {angle}");
        }
        assert_eq!((here("relief"), here("occlusion")), (8, 8), "one a number of steps");
    }
    let table = std::fs::read_to_string(bench.path("out/compare.md")).expect("written");
    assert!(table.contains("| 80° | quadtree |") && table.contains("cheapest"), "{table}");
    assert!(bench.image("out/compare.png").width() >= 1000);
}

#[test]
fn bad_input_is_refused_and_nothing_written() {
    let cases: &[(&[&str], &[&str])] = &[
        (&[], &["height", "--builtin"]),
        (&["--height", "@nowhere.png"], &["nowhere.png"]),
        (&["--height", "@text.png"], &["text.png"]),
        (&["--albedo", "@opaque.png"], &["opaque.png", "alpha"]),
        (&["--height", "@height.png", "--albedo", "@text.png"], &["text.png"]),
        (&["--height", "@height.png", "--normal", "@nowhere.png"], &["nowhere.png"]),
        (&["--builtin", "sponge"], &["builtin", "sponge", "bricks"]),
        (&["--builtin", "bricks", "--texels", "0"], &["texels", "0"]),
        (&["--height", "@height.png", "--texels", "64"], &["--texels"]),
        (&["--builtin", "bricks", "--normal-green", "left"], &["normal-green", "left"]),
        (&["--builtin", "bricks", "--angle", "89.9999"], &["angle", "89.9999", "no pixel"]),
        (&["--builtin", "bricks", "--compare", "--size", "2x2"], &["size", "2x2", "no pixel"]),
        (&["--builtin", "bricks", "--height", "@height.png"], &["--height"]),
        (&["--builtin", "bricks", "--method", "bump"], &["method", "bump", "quadtree"]),
        (&["--builtin", "bricks", "--angle", "90"], &["angle", "90", "below 90"]),
        (&["--builtin", "bricks", "--angle", "-1"], &["angle", "-1"]),
        (&["--builtin", "bricks", "--angle", "nan"], &["angle", "NaN"]),
        (&["--builtin", "bricks", "--azimuth", "inf"], &["azimuth", "inf"]),
        (&["--builtin", "bricks", "--scale", "-0.1"], &["scale", "-0.1"]),
        (&["--builtin", "bricks", "--scale", "nan"], &["scale", "NaN"]),
        (&["--builtin", "bricks", "--scale", "1.5"], &["scale", "1.5"]),
        (&["--builtin", "bricks", "--bias", "0.1"], &["bias", "0.1"]),
        (&["--builtin", "bricks", "--bias", "-0.2"], &["bias", "-0.2"]),
        (&["--builtin", "bricks", "--tile", "0"], &["tile", "0"]),
        (&["--builtin", "bricks", "--tile", "inf"], &["tile", "inf"]),
        (&["--builtin", "bricks", "--steps", "9,3"], &["steps[1]", "3", "9..=1024"]),
        (&["--builtin", "bricks", "--steps", "0"], &["steps[0]", "0", "1..="]),
        (&["--builtin", "bricks", "--steps", "many"], &["steps", "many"]),
        (&["--builtin", "bricks", "--steps", "1,5000"], &["steps", "1024"]),
        (&["--builtin", "bricks", "--light", "45"], &["light", "45"]),
        (&["--builtin", "bricks", "--light", "0,91"], &["light", "91"]),
        (&["--builtin", "bricks", "--light", "nan,20"], &["light", "NaN"]),
        (&["--builtin", "bricks", "--size", "0x0"], &["size[0]", "0"]),
        (&["--builtin", "bricks", "--size", "640"], &["size", "640"]),
        (&["--builtin", "bricks", "--size", "9000x10"], &["size[0]", "9000", "8192"]),
        (&["--builtin", "bricks", "--shadow", "dark"], &["shadow", "dark"]),
        (&["--builtin", "bricks", "--address", "mirror"], &["address", "mirror"]),
    ];
    let bench = Bench::new();
    for (arguments, words) in cases {
        let run = bench.run("out", arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {}", run.stderr);
        assert_eq!(run.stderr.trim().lines().count(), 1, "{arguments:?}: {}", run.stderr);
        for word in *words {
            assert!(run.stderr.contains(word), "{arguments:?}: `{word}` is not in: {}", run.stderr);
        }
        assert!(!bench.path("out").exists() && run.stdout.is_empty(), "{arguments:?} wrote something");
    }
}
