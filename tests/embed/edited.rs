//! Heights that are injected into endless terrain, from the beginning and at run time.

use relievo::ops::terrain::config::HeightInterpolation;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::region;
use relievo::ops::terrain::window::Region;
use relievo::scene::{
    Camera, FeatureFile, FeatureMode, HeightGenerator, TerrainConfig, TerrainFeatures, TerrainRecipe,
    TerrainSource,
};

use crate::endless::{Path, ROUNDING, World, flight, holes, picture, small_nodes};

fn config(interpolation: HeightInterpolation) -> TerrainConfig {
    TerrainConfig {
        coarse_levels: 5,
        interpolation,
        ..TerrainConfig::new(65, 80.0, "edited").expect("valid")
    }
}

/// Heights at samples of the whole plane, by column and row.
pub fn features(config: &TerrainConfig, points: &[([i32; 2], f64)], mode: FeatureMode) -> TerrainFeatures {
    let file = |([column, row], height): &([i32; 2], f64)| FeatureFile {
        patch_coordinates: [column.div_euclid(64), row.div_euclid(64)],
        precomputed_heights: vec![column.rem_euclid(64).into(), row.rem_euclid(64).into(), *height],
    };
    let files: Vec<FeatureFile> = points.iter().map(file).collect();
    TerrainFeatures::new(config, &files, mode).expect("valid")
}

/// A valley whose floor is a road, and towers of one sample far and near. `height` is that of the road.
pub fn road(height: f64) -> Vec<([i32; 2], f64)> {
    let along = (-200..100).flat_map(|row: i32| {
        let middle = 20 + (f64::from(row) / 30.0).sin().mul_add(12.0, 0.0) as i32;
        (-3..=3).map(move |aside| ([middle + aside, row], height + 0.01 * f64::from(row)))
    });
    let towers =
        (0..24_i32).map(|at| ([at * 37 % 400 - 200, -(at * 53 % 900)], height + 20.0 + f64::from(at)));
    let mut all: std::collections::BTreeMap<[i32; 2], f64> = towers.collect();
    all.extend(along);
    all.into_iter().collect()
}

fn source(config: &TerrainConfig, features: TerrainFeatures) -> TerrainSource {
    let recipe = TerrainRecipe { features, ..TerrainRecipe::new(config.clone()) };
    TerrainSource::from(recipe).with_limits(small_nodes())
}

/// The height of the finest triangles with injected heights, from the definition alone.
fn truth(config: &TerrainConfig, features: &Features, x: f64, z: f64) -> f64 {
    let first = [x, z].map(|at| at.floor() as i64);
    let heights = region(config, features, Region { first, width: 2, coarser: 0 });
    let [a, b, c, d] = [0, 1, 2, 3].map(|at| f64::from(heights[at]) / 65_536.0);
    let [u, v] = [x - x.floor(), z - z.floor()];
    if u + v <= 1.0 { a + (b - a) * u + (c - a) * v } else { d + (c - d) * (1.0 - u) + (b - d) * (1.0 - v) }
}

#[test]
fn a_flight_over_injected_heights_keeps_its_promise() {
    use FeatureMode::{Additive, Keep};
    use HeightInterpolation::{Linear, Smooth};
    for (interpolation, mode, height) in
        [(Smooth, Keep, 30.0), (Linear, Keep, -20.0), (Smooth, Additive, -8.0)]
    {
        let config = config(interpolation);
        let features = features(&config, &road(height), mode);
        let mut world = World::of(&source(&config, features.clone()), [96, 54]);
        let path = Path { from: [24.0, 60.0], frames: 12, metres: 200.0, height: 120.0, every: 4, step: 3 };
        let flight = flight(&mut world, &|x, z| truth(&config, &features, x, z), &path);
        println!("{interpolation:?} {mode:?}: {flight:?}");
        assert_eq!(flight.holes, 0);
        assert!(flight.ready[0] <= 1.0 + ROUNDING && flight.ready[1] <= 1.0 + ROUNDING, "{flight:?}");
        assert!(flight.ready_frames >= 7, "{flight:?}");
    }
}

/// Heights that are injected at run time give the picture of terrain that was made with them, to the bit; without them again, the
/// first picture. No pixel shows the sky in between. A change of one place is there in the next frame.
#[test]
fn edits_are_there_at_once() {
    let config = config(HeightInterpolation::Smooth);
    let none = TerrainFeatures::default();
    let mut world = World::of(&source(&config, none.clone()), [96, 54]);
    let ground = world.scene.ground(world.land, 23.0, -40.0).expect("valid").expect("ground").height;
    let (eye, target) = ([24.0, ground + 60.0, -10.0], [23.0, ground, -40.0]);
    let camera = Camera::looking_at_world(eye, target, 0.9, [0.5, 12_000.0], [96, 54]);
    let settled = |world: &mut World| {
        world.view.set(camera).expect("valid");
        world.settle();
        picture(world)
    };
    let first = settled(&mut world);
    let height =
        |world: &World| world.scene.ground(world.land, 23.0, -40.0).expect("valid").expect("ground").height;
    let before = height(&world);
    let dip = features(
        &config,
        &[([23, -40], before - 12.0), ([24, -39], before - 10.0), ([24, -40], before - 11.0)],
        FeatureMode::Keep,
    );
    let whole = features(&config, &road(before + 4.0), FeatureMode::Keep);
    for edited in [&dip, &whole, &none] {
        world.scene.set_terrain_features(world.land, edited).expect("valid");
        let ground = height(&world);
        world.frame();
        let statistics = world.scene.terrain_statistics(world.land).expect("endless");
        assert!((1..=128).contains(&statistics.made), "{statistics:?}");
        let drawn = world.positions(&camera);
        assert_eq!(holes(&world, &camera, &drawn), 0);
        if edited == &dip {
            assert!((ground - before + 12.0).abs() < 1e-4);
            // All triangles of the place are already the new ones.
            let near = |place: &&glam::DVec3| (place.x - 23.0).hypot(place.z + 40.0) < 4.0;
            let off = |place: &glam::DVec3| (place.y - truth(&config, edited, place.x, place.z)).abs();
            let most = drawn.iter().flatten().filter(near).map(off).fold(0.0, f64::max);
            assert!(most < 1.0 && drawn.iter().flatten().filter(near).count() > 3, "{most}");
        }
        let made = settled(&mut world);
        let mut other = World::of(&source(&config, edited.clone()), [96, 54]);
        assert!(made == settled(&mut other), "{} features", edited.len());
        assert_eq!(made == first, edited.is_empty());
    }
}

#[test]
fn features_are_refused_where_nothing_spreads_them() {
    let config = config(HeightInterpolation::Linear);
    let own = features(&config, &[([3, 4], 5.0)], FeatureMode::Keep);
    let noise = TerrainConfig { generator: HeightGenerator::Fbm, ..config };
    let mut world = World::of(&source(&noise, TerrainFeatures::default()), [16, 9]);
    let error = world.scene.set_terrain_features(world.land, &own).expect_err("noise").to_string();
    assert!(error.contains("diamondSquare"), "{error}");
}
