//! Endless terrain as a walker and a flyer see it, a million samples from the origin.

use std::sync::Arc;

use glam::Vec3;
use relievo::asset::Light;
use relievo::ops::terrain::config::HeightInterpolation;
use relievo::ops::terrain::field::region;
use relievo::ops::terrain::hydraulic::Hydraulic;
use relievo::ops::terrain::thermal::Thermal;
use relievo::ops::terrain::window::Region;
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{
    Camera, ElevationLayout, ElevationMap, ElevationTiles, EndlessLimits, FeatureFile, FeatureMode, Quality,
    Scene, TerrainConfig, TerrainFeatures, TerrainRecipe, TerrainSource,
};
use relievo::wgpu;

use crate::harness::{Tolerance, check_golden, gpu};

const SIZE: [u32; 2] = [192, 108];

fn config() -> TerrainConfig {
    TerrainConfig {
        coarse_levels: 7,
        interpolation: HeightInterpolation::Smooth,
        triplanar: true,
        variation: 0.7,
        ..TerrainConfig::new(65, 700.0, "golden").expect("valid")
    }
}

/// Many nodes a frame, so that the picture is there soon.
fn limits() -> EndlessLimits {
    EndlessLimits { nodes_per_frame: 128, ..EndlessLimits::default() }
}

/// Compares the picture `height` units above the ground, a million samples from the origin, with its golden.
fn check(height: f64, name: &str) {
    let at = [1.0e6, 2_000.0];
    check_view(
        &TerrainSource::endless(config()).with_limits(limits()),
        (at, height),
        [at[0] + 300.0, at[1] + 1_000.0],
        name,
    );
}

/// Compares the picture `height` units above the ground at `at`, towards `to`, with its golden.
fn check_view(source: &TerrainSource, (at, height): ([f64; 2], f64), to: [f64; 2], name: &str) {
    let gpu = gpu();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let light = Light { direction: Vec3::new(-0.8, 0.5, 0.3), ambient: 0.25, ..Light::default() };
    scene.set_light(light).expect("valid");
    let land = scene.add_terrain(source).expect("added");
    let ground = scene.ground(land, at[0], at[1]).expect("valid").expect("ground").height;
    let eye = [at[0], ground + height, at[1]];
    let target = [to[0], ground + 0.8 * height, to[1]];
    let camera = Camera::looking_at_world(eye, target, 0.8, [0.5, 12_000.0], SIZE);
    let offscreen = Offscreen::new(&gpu, SIZE).expect("allocated");
    let mut view = scene.view(Quality::default()).expect("made");
    view.set(camera).expect("valid");
    for _ in 0..200 {
        gpu.try_run("detail", |encoder| scene.record(encoder, &mut [&mut view])).expect("recorded");
        if scene.terrain_statistics(land).expect("endless").ready == 1.0 {
            break;
        }
    }
    let mut renderer = Renderer::new(&gpu, offscreen.format()).expect("a format");
    renderer.prepare(&scene).expect("compiled");
    let drawn = gpu.try_run("picture", |encoder| -> Result<(), relievo::Error> {
        scene.record(encoder, &mut [&mut view])?;
        let draw = |pass: &mut wgpu::RenderPass<'_>| renderer.draw(pass, &scene, &view, Layer::Color);
        Ok(offscreen.record(encoder, [0.42, 0.58, 0.8], draw)?)
    });
    drawn.expect("drawn");
    let image = offscreen.read(&gpu).expect("read");
    check_golden(name, &image, Tolerance::IMAGE).map_or_else(|error| panic!("{error}"), drop);
}

#[test]
fn walked() {
    check(2.0, "endless_walked");
}

#[test]
fn flown() {
    check(900.0, "endless_flown");
}

/// A road through a valley, injected into the ground.
#[test]
fn edited() {
    let config = config();
    let natural =
        region(&config, &TerrainFeatures::default(), Region { first: [-150, -150], width: 901, coarser: 0 });
    let mut files = std::collections::BTreeMap::new();
    for (column, row) in (-100..700_i32).flat_map(|row| (-100..200_i32).map(move |column| (column, row))) {
        let middle = 40.0 + 40.0 * (f64::from(row) / 90.0).sin();
        let aside = (f64::from(column) - middle).abs();
        // A flat road, and slopes beside it at every fourth sample.
        let is_slope = aside < 70.0 && column % 4 == 0 && row % 4 == 0;
        if aside > 4.5 && !is_slope {
            continue;
        }
        let ground = |column: i32, row: i32| {
            f64::from(natural[((row + 150) * 901 + column + 150) as usize]) / 65_536.0
        };
        let own = ground(column, row);
        // The road is level with the ground around it, and a little below.
        let near = (-6..=6).map(|at| ground(middle as i32, row + 8 * at)).sum::<f64>() / 13.0;
        let road = near - 18.0;
        let part = ((aside - 4.5) / 65.0).clamp(0.0, 1.0);
        let height = road + (own - road) * part * part * (3.0 - 2.0 * part);
        let patch = [column, row].map(|at| at.div_euclid(64));
        let points: &mut Vec<f64> = files.entry(patch).or_default();
        points.extend([column.rem_euclid(64).into(), row.rem_euclid(64).into(), height]);
    }
    let file =
        |(patch_coordinates, precomputed_heights)| FeatureFile { patch_coordinates, precomputed_heights };
    let files: Vec<FeatureFile> = files.into_iter().map(file).collect();
    let features = TerrainFeatures::new(&config, &files, FeatureMode::Keep).expect("valid");
    let recipe = TerrainRecipe { features, ..TerrainRecipe::new(config) };
    let source = TerrainSource::from(recipe).with_limits(limits());
    check_view(&source, ([60.0, -40.0], 70.0), [60.0, 60.0], "endless_edited");
}

/// A volcano of an elevation map with eight samples of the terrain between its own, and generated ground around it.
#[test]
fn mapped() {
    let config = config();
    let size = [300_u32, 300];
    let height = |at: u32| {
        let [x, y] = [at % size[0], at / size[0]].map(|at| (f64::from(at) - 150.0) / 60.0);
        let (away, turn) = (x.hypot(y), y.atan2(x));
        let ridges = 0.12 * (9.0 * turn + 1.5 * away).cos() * (1.0 - away).clamp(0.0, 1.0).sqrt();
        let crater = 0.5 * (-(away / 0.22).powi(4)).exp();
        (900.0 * ((-1.6 * away).exp() - crater + ridges * away) - 60.0) as f32
    };
    let layout = ElevationLayout { spacing: 8, first: [-150, -150], size };
    let heights = (0..size[0] * size[1]).map(height).collect();
    let tiles = ElevationTiles::new(&config, &ElevationMap { layout, heights, margin: 60 }).expect("valid");
    let source = TerrainSource::endless(config).with_elevation(Arc::new(tiles)).with_limits(limits());
    check_view(&source, ([-1_200.0, -1_500.0], 420.0), [0.0, 0.0], "endless_mapped");
}

/// Slopes that have slid, and gullies that rain has dug.
#[test]
fn eroded() {
    let thermal = Some(Thermal { iterations: 16, talus: 2.0 });
    let hydraulic = Some(Hydraulic { iterations: 6, ..Hydraulic::default() });
    let recipe = TerrainRecipe { thermal, hydraulic, ..TerrainRecipe::new(config()) };
    let limits =
        EndlessLimits { erosion_depth: 4.0, view_distance: Some(1_000.0), node_size: 33, ..limits() };
    let source = TerrainSource::from(recipe).with_limits(limits);
    check_view(&source, ([60.0, -40.0], 40.0), [160.0, 160.0], "endless_eroded");
}
