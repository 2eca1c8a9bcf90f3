//! Terrain between two recipes: pictures, normals and ground are those of the heights in between.

use glam::{DVec3, Vec3};
use image::RgbaImage;
use relievo::InputError;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::morph::Morph;
use relievo::ops::terrain::morph::reference::morph;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::thermal::Thermal;
use relievo::scene::{Camera, Scene, TerrainSource};

use crate::frame::{device, devices};
use crate::stage::Stage;
use crate::world::SIZE;

const HERE: [[i32; 2]; 4] = [[-1, -1], [0, -1], [-1, 0], [0, 0]];

fn ends() -> [TerrainConfig; 2] {
    [("embed", 6.0), ("another", 9.0)]
        .map(|(seed, height)| TerrainConfig::new(33, height, seed).expect("valid"))
}

/// The first is eroded.
fn recipes() -> [Recipe; 2] {
    let [from, to] = ends().map(Recipe::new);
    [Recipe { thermal: Some(Thermal { iterations: 3, ..Thermal::default() }), ..from }, to]
}

fn source(time: f64) -> TerrainSource {
    let [from, to] = recipes();
    TerrainSource::from(from).with_patches(&HERE).with_target(to, Morph { time })
}

/// Terrain made from the heights at a time, which the host computed.
fn between(gpu: &Gpu, time: f64) -> TerrainSource {
    let [from, to] = recipes().map(|recipe| {
        let generator = Generator::new(gpu, recipe).expect("compiled");
        let fields = generator.generate(gpu, &HERE, 1, &mut |_| ()).expect("generated").remove(0);
        fields.read_blocking(gpu).expect("read").concat()
    });
    let fields = Fields::new(gpu, "between", 35, 4).expect("allocated");
    fields.heights.write(gpu, &morph(&from, &to, Morph { time }.fixed_time())).expect("written");
    TerrainSource::from_fields(ends()[0].clone(), fields, &HERE)
}

fn at(stage: &mut Stage, time: f64) -> RgbaImage {
    stage.scene.morph_terrain(stage.land, Morph { time }).expect("has a target");
    stage.shot()
}

fn ground(stage: &Stage) -> Vec<f64> {
    let places = [(0.25, 0.5), (-7.5, 11.0), (20.0, -30.75)];
    let point = |(x, z): (f64, f64)| stage.scene.ground(stage.land, x, z).expect("terrain").expect("inside");
    places
        .map(point)
        .iter()
        .flat_map(|point| [vec![point.height], point.normal.map(f64::from).to_vec()].concat())
        .collect()
}

/// Each time looks as terrain made from these heights, also after a frame that was never submitted, and on the way back; the
/// ground is theirs too. Another time looks different, or the comparison would mean nothing.
#[test]
fn a_time_looks_as_its_heights() {
    let gpu = device();
    let mut stage = Stage::new(&gpu, &source(0.0));
    let mut pictures = Vec::new();
    for time in [0.0, 0.25, 0.7, 1.0, 0.25] {
        let picture = at(&mut stage, time);
        let mut expected = Stage::new(&gpu, &between(&gpu, time));
        assert!(picture == expected.shot(), "time {time} looks different");
        assert_eq!(ground(&stage), ground(&expected), "time {time}");
        pictures.push(picture);
    }
    assert!(pictures[..4].iter().enumerate().all(|(at, picture)| !pictures[..at].contains(picture)));
    assert!(pictures[4] == pictures[1], "the way back leads elsewhere");
    assert!(Stage::new(&gpu, &source(0.7)).shot() == pictures[2], "a later start looks different");
    // Dropped, and given up.
    stage.scene.morph_terrain(stage.land, Morph { time: 1.0 }).expect("has a target");
    let mut encoder = gpu.encoder("dropped");
    stage.scene.record(&mut encoder, &mut [&mut stage.view]).expect("recorded");
    drop(encoder);
    stage.scene.invalidate().expect("starts afresh");
    assert!(stage.shot() == pictures[3], "what was dropped is missing");
}

/// Patches whose heights enter the view are drawn, though a view that looks over the plain saw none of them, and leave it again.
#[test]
fn mountains_rise_into_view() {
    let gpu = device();
    let [plain, mountains] = [("plain", 0.01), ("mountains", 300.0)]
        .map(|(seed, height)| Recipe::new(TerrainConfig::new(33, height, seed).expect("valid")));
    let land = |time| {
        let source = TerrainSource::from(plain.clone()).with_patches(&HERE);
        Stage::new(&gpu, &source.with_target(mountains.clone(), Morph { time }))
    };
    let mut risen = land(1.0);
    let places = (-31..32).flat_map(|x| (-31..32).map(move |z| [f64::from(x), f64::from(z)]));
    let peak = places
        .map(|[x, z]| DVec3::new(x, risen.height(x, z).expect("inside"), z))
        .max_by(|one, other| one.y.total_cmp(&other.y))
        .expect("some")
        .as_vec3();
    assert!(peak.y > 60.0, "no mountains: {peak}");
    let mut stage = land(0.0);
    for view in [&mut risen.view, &mut stage.view] {
        let eye = peak + Vec3::new(0.0, 0.0, 60.0);
        view.set(Camera::looking_at(eye, peak, 0.3, [0.5, 400.0], SIZE)).expect("a camera");
    }
    let expected = risen.shot();
    let sky = stage.shot();
    assert!(sky.pixels().all(|pixel| pixel == sky.get_pixel(0, 0)), "the plain is in view");
    assert!(expected != sky, "the peak is not in view");
    assert!(at(&mut stage, 1.0) == expected, "mountains that rose look different");
    assert!(at(&mut stage, 0.0) == sky, "something stayed");
}

/// A scene that is made again on another device, since the first was lost, has the heights of the last time.
#[test]
fn a_lost_device_keeps_the_time() {
    let [lost, second] = devices();
    lost.device().on_uncaptured_error(std::sync::Arc::new(|_| ()));
    let Stage { mut scene, land, mut view, .. } = Stage::new(&lost, &source(0.25));
    scene.morph_terrain(land, Morph { time: 0.7 }).expect("has a target");
    lost.device().destroy();
    scene.rebuild(&second).expect("a device");
    view.rebuild(&scene).expect("a device");
    let mut expected = Stage::new(&second, &source(0.7));
    let renderer = expected.frame.renderer(&second, &scene);
    assert!(expected.frame.shot(&mut scene, &mut view, &renderer) == expected.shot(), "another picture");
}

#[test]
fn mistakes_about_targets_are_told() {
    let gpu = device();
    let told = |error: relievo::Error| match error {
        relievo::Error::Input(InputError { path, value, .. }) => (path, value),
        other => panic!("{other}"),
    };
    let pair = |path: &str, value: &str| (path.to_owned(), value.to_owned());
    let mut scene = Scene::new(&gpu).expect("compiled");
    let [from, to] = ends();
    let mut refused = |source: TerrainSource| told(scene.add_terrain(&source).expect_err("refused"));
    let plain = || TerrainSource::new(from.clone());
    let finer = TerrainConfig::new(65, 9.0, "finer").expect("valid");
    let half = Morph { time: 0.5 };
    assert_eq!(refused(plain().with_target(Recipe::new(finer), half)), pair("target.patch_size", "65"));
    let wide = TerrainConfig { terrain_scale: 2.0, ..to.clone() };
    assert_eq!(refused(plain().with_target(Recipe::new(wide), half)), pair("target.terrain_scale", "2"));
    let beyond = plain().with_target(Recipe::new(to.clone()), Morph { time: 1.5 });
    assert_eq!(refused(beyond), pair("time", "1.5"));
    let fields = between(&gpu, 0.5).with_target(Recipe::new(to), half);
    assert_eq!(refused(fields).0, "target");
    let mut stage = Stage::new(&gpu, &source(0.25));
    let before = stage.shot();
    let error = stage.scene.morph_terrain(stage.land, Morph { time: -0.5 }).expect_err("refused");
    assert_eq!((error.path, error.value), pair("time", "-0.5"));
    assert!(stage.shot() == before, "a mistake has changed the picture");
    let mut alone = Stage::new(&gpu, &plain());
    let error = alone.scene.morph_terrain(alone.land, half).expect_err("refused");
    assert_eq!(error.path, "terrain");
}
