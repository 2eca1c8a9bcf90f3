//! Terrain of the caller's own heights: shared buffers, heights that change, patches that travel, wireframes.

use image::RgbaImage;
use relievo::InputError;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::field::field;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::recipe::Recipe;
use relievo::render::{Layer, Renderer};
use relievo::scene::{Scene, TerrainSource, TerrainStyle};

use crate::frame::device;
use crate::stage::Stage;

/// The scene generates a recipe with all erosion: its ground is what the CPU computes.
#[test]
fn eroded_ground_is_that_of_the_reference() {
    let recipe = Recipe::from_json(
        r#"{"patchSize": 33, "scaleFactor": 9, "seed": "h", "interpolation": "smooth", "thermal": {"iterations": 2},
            "hydraulic": {"iterations": 17, "rain": 0.01, "threshold": 1}, "thermalAfter": {"iterations": 3}}"#,
    )
    .expect("valid");
    let stage = Stage::new(&device(), &TerrainSource::from(recipe.clone()).with_patches(&HERE));
    let fields = field(&recipe, &HERE, 0).expect("valid");
    let dry = field(&Recipe { hydraulic: None, ..recipe }, &HERE, 0).expect("valid");
    assert!(fields != dry);
    for (patch, heights) in HERE.iter().zip(&fields) {
        for at in 0..33 * 33 {
            let [x, z] = [at % 33, at / 33];
            let place = [(0, x), (1, z)].map(|(axis, index)| f64::from(32 * patch[axis] + index));
            let height = f64::from(heights[at as usize]) / 65_536.0;
            let shown = stage.height(place[0], place[1]).expect("on a patch");
            assert!((shown - height).abs() < 1e-9, "{place:?}: {shown} instead of {height}");
        }
    }
}

const HERE: [[i32; 2]; 4] = [[-1, -1], [0, -1], [-1, 0], [0, 0]];

fn config() -> TerrainConfig {
    TerrainConfig::new(33, 6.0, "embed").expect("valid")
}

/// Heights of patches with a margin of `margin` samples.
fn fields(gpu: &Gpu, patches: &[[i32; 2]], margin: u32) -> Fields {
    let generator = Generator::new(gpu, Recipe::new(config())).expect("compiled");
    generator.generate(gpu, patches, margin, &mut |_| ()).expect("generated").remove(0)
}

fn stage_of(gpu: &Gpu, fields: &Fields, patches: &[[i32; 2]]) -> Stage {
    Stage::new(gpu, &TerrainSource::from_fields(config(), fields.clone(), patches))
}

/// Adds whole units to all heights.
fn lift(gpu: &Gpu, fields: &Fields, units: i32) {
    let heights: Vec<i32> = fields.heights.read_blocking(gpu).expect("read");
    let lifted: Vec<i32> = heights.iter().map(|height| height + (units << 16)).collect();
    fields.heights.write(gpu, &lifted).expect("written");
}

#[test]
fn fields_of_the_caller_look_like_those_of_the_scene() {
    let gpu = device();
    let mut own = Stage::new(&gpu, &TerrainSource::new(config()).with_patches(&HERE));
    let expected = own.shot();
    for margin in [1, 4] {
        let mut given = stage_of(&gpu, &fields(&gpu, &HERE, margin), &HERE);
        assert!(given.shot() == expected, "another picture with a margin of {margin}");
        for (x, z) in [(-7.3, 12.5), (0.0, 0.0), (31.9, -31.9)] {
            assert_eq!(given.height(x, z), own.height(x, z));
            assert!(given.height(x, z).is_some() && given.below(x, z) == own.below(x, z));
        }
    }
    let other = stage_of(&gpu, &fields(&gpu, &[[5, 5], [6, 5], [5, 6], [6, 6]], 1), &HERE).shot();
    assert!(other != expected, "other heights look the same");
}

/// The buffer is shared: what passes write shows in the next frame, and is known on the host once it was read.
#[test]
fn heights_that_change_show_at_once_and_are_known_when_read() {
    let gpu = device();
    let fields = fields(&gpu, &HERE, 1);
    let mut stage = stage_of(&gpu, &fields, &HERE);
    let (before, height) = (stage.shot(), stage.height(3.0, 4.0).expect("ground"));
    lift(&gpu, &fields, 2);
    let after = stage.shot();
    assert!(after != before, "the picture has not changed");
    assert!(after == stage_of(&gpu, &fields, &HERE).shot(), "another picture than a new scene");
    assert_eq!(stage.height(3.0, 4.0), Some(height));
    stage.scene.read_ground(stage.land).expect("read");
    assert_eq!(stage.height(3.0, 4.0), Some(height + 2.0));
    let bounds = |stage: &Stage| {
        let patches = stage.scene.instances(stage.land).expect("terrain");
        patches.iter().map(|patch| stage.scene.bounds(*patch).expect("there")).collect::<Vec<_>>()
    };
    let found = bounds(&stage);
    lift(&gpu, &fields, 300);
    stage.scene.read_ground(stage.land).expect("read");
    let raised = bounds(&stage);
    assert!(found.iter().zip(&raised).all(|(a, b)| (b.world()[1].y - a.world()[1].y - 300.0).abs() < 0.1));
    assert!(stage.shot() == stage_of(&gpu, &fields, &HERE).shot());
}

/// Fields that show other patches look as if they had been added there. Views cull by the heights that are told.
#[test]
fn fields_travel() {
    let gpu = device();
    let there = [[-1, -1], [0, 0], [1, -1]];
    let fields = fields(&gpu, &HERE, 1);
    let mut stage = stage_of(&gpu, &fields, &HERE);
    let handles = stage.scene.instances(stage.land).expect("terrain");
    let before = stage.shot();
    stage.scene.set_patches(stage.land, &there, [-6.0, 6.0]).expect("set");
    let travelled = stage.shot();
    assert!(travelled != before);
    assert!(travelled == stage_of(&gpu, &fields, &there).shot(), "another picture than a new scene");
    // The first patch stays, with its handle and its ground; the others are new, and there is one less.
    let now = stage.scene.instances(stage.land).expect("terrain");
    assert_eq!((now.len(), now[0]), (3, handles[0]));
    assert!(handles[1..].iter().all(|old| stage.scene.bounds(*old).is_err()));
    assert!(stage.height(-5.0, -5.0).is_some() && stage.height(5.0, 5.0).is_none());
    assert!(stage.below(40.0, -5.0).is_none());
    stage.scene.read_ground(stage.land).expect("read");
    assert!(stage.height(5.0, 5.0).is_some() && stage.below(40.0, -5.0).is_some());
    // A view that would see none of the heights that are told draws nothing.
    let sky = *stage.shot().get_pixel(0, 0);
    stage.scene.set_patches(stage.land, &there, [-3000.0, -2900.0]).expect("set");
    assert!(stage.shot().pixels().all(|pixel| *pixel == sky), "culling does not follow the heights");
    stage.scene.set_patches(stage.land, &[], [0.0, 0.0]).expect("set");
    assert!(stage.shot().pixels().all(|pixel| *pixel == sky));
    stage.scene.set_patches(stage.land, &HERE, [-6.0, 6.0]).expect("set");
    assert!(stage.shot() == before, "the way back leads elsewhere");
}

/// The terrain is told from a mesh, fields from a recipe, and every mistake by its name; nothing changes then.
#[test]
fn mistakes_about_fields_are_told() {
    let gpu = device();
    let path = |error: relievo::Error| match error {
        relievo::Error::Input(InputError { path, .. }) => path,
        other => panic!("{other}"),
    };
    let mut scene = Scene::new(&gpu).expect("compiled");
    let refused = |scene: &mut Scene, fields: &Fields, patches: &[[i32; 2]]| {
        path(
            scene
                .add_terrain(&TerrainSource::from_fields(config(), fields.clone(), patches))
                .expect_err("refused"),
        )
    };
    let good = fields(&gpu, &HERE, 1);
    for width in [33, 34, 36] {
        let bare = Fields::new(&gpu, "no margin", width, 1).expect("allocated");
        assert_eq!(refused(&mut scene, &bare, &HERE[..1]), "fields.width");
    }
    let short = Fields { count: 9, ..good.clone() };
    assert!(refused(&mut scene, &short, &HERE).starts_with("fields.heights"));
    let five = [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0]];
    assert_eq!(refused(&mut scene, &good, &five), "patches.len");
    assert_eq!(refused(&mut scene, &good, &[[0, 0], [1, 1], [0, 0]]), "patches[2]");
    assert_eq!(refused(&mut scene, &good, &[[0, 0], [3, i32::MAX]]), "patches[1][1]");
    let mut stage = stage_of(&gpu, &good, &HERE);
    let before = stage.shot();
    for (patches, heights, expected) in [
        (&five[..], [0.0, 1.0], "patches.len"),
        (&[[4, 4], [4, 4]], [0.0, 1.0], "patches[1]"),
        (&[[0, -70_000_000]], [0.0, 1.0], "patches[0][1]"),
        (&HERE, [1.0, 0.0], "heights"),
        (&HERE, [0.0, f64::NAN], "heights"),
        (&HERE, [f64::NEG_INFINITY, 0.0], "heights"),
    ] {
        assert_eq!(
            path(stage.scene.set_patches(stage.land, patches, heights).expect_err("refused")),
            expected
        );
    }
    assert!(stage.shot() == before, "a mistake has changed the picture");
    let mut own = Stage::new(&gpu, &TerrainSource::new(config()));
    assert_eq!(path(own.scene.set_patches(own.land, &HERE, [0.0, 1.0]).expect_err("refused")), "terrain");
    assert_eq!(path(own.scene.read_ground(own.land).expect_err("refused")), "terrain");
    assert_eq!(path(stage.scene.rebuild(&gpu).expect_err("refused")), "terrain");
    assert!(stage.shot() == before, "a rebuild that failed has changed the picture");
}

/// A wireframe has lines in the crate's or the caller's shading, on ground that no light reaches.
#[test]
fn a_wireframe_has_lines_and_dark_ground() {
    let gpu = device();
    let source = TerrainSource::new(config()).with_patches(&HERE);
    let textured = Stage::new(&gpu, &source).shot();
    let mut stage = Stage::new(&gpu, &source.with_style(TerrainStyle::Wireframe));
    let wired = stage.shot();
    // 0.01, 0.014 and 0.02 of the light in sRGB.
    let is_ground =
        |pixel: &image::Rgba<u8>| pixel.0.iter().zip([25, 31, 38, 255]).all(|(a, b)| a.abs_diff(b) <= 1);
    let (sky, all) = (*wired.get_pixel(0, 0), wired.pixels().len());
    let count = |picture: &RgbaImage, wanted: &dyn Fn(&image::Rgba<u8>) -> bool| {
        picture.pixels().filter(|pixel| wanted(pixel)).count()
    };
    let [ground, clear] = [count(&wired, &is_ground), count(&wired, &|pixel| *pixel == sky)];
    assert!(ground > all / 20 && all - ground - clear > all / 20, "{ground} of ground, {clear} of sky");
    assert_eq!(clear, count(&textured, &|pixel| *pixel == sky), "another outline");
    assert_eq!(count(&textured, &is_ground), 0);
    let magenta =
        "fn shade(surface: Surface, view: View) -> vec4<f32> { return vec4<f32>(1.0, 0.0, 1.0, 1.0); }";
    let renderer = Renderer::new(&gpu, &stage.frame.format).expect("a format");
    stage.renderer = renderer.with_shading(magenta, None).expect("valid");
    stage.renderer.prepare(&stage.scene).expect("compiled");
    let shaded = stage.shot();
    let still = shaded.pixels().zip(wired.pixels()).filter(|(a, b)| is_ground(a) && is_ground(b)).count();
    // Where a line is faint, the one light may round it to the ground, and the other not.
    assert!(100 * still >= 99 * ground, "the caller's light reaches the ground: {still} of {ground}");
    let lines = count(&shaded, &|pixel| pixel.0 == [255, 0, 255, 255]);
    assert!(lines > 100, "{lines} pixels of lines");
}

/// A depth prepass serves wireframes too.
#[test]
fn wireframes_pass_behind_their_prepass() {
    let gpu = device();
    let source = TerrainSource::new(config()).with_patches(&HERE).with_style(TerrainStyle::Wireframe);
    let mut stage = Stage::new(&gpu, &source);
    let plain = stage.shot();
    let Stage { scene, view, frame, renderer, .. } = &mut stage;
    let behind = frame.shot_of(scene, view, renderer, &[Layer::Depth, Layer::Color]);
    assert!(behind == plain, "another picture behind a prepass");
}
