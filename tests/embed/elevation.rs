//! Elevation maps in endless terrain: what is drawn is the map, and generated ground around it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use relievo::Error;
use relievo::ops::terrain::config::{HEIGHT_ONE, HeightInterpolation};
use relievo::ops::terrain::elevation::TILE_SIZE;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::region;
use relievo::ops::terrain::window::Region;
use relievo::scene::{
    Camera, ElevationInfo, ElevationLayout, ElevationLoader, ElevationMap, ElevationSource, ElevationTile,
    ElevationTiles, EndlessLimits, FeatureMode, HeightGenerator, TerrainConfig, TerrainFeatures,
    TerrainRecipe, TerrainSource, TileNumber,
};

use crate::edited::{features, road};
use crate::endless::{
    Path, ROUNDING, World, flight, hits, holes, largest, offsets, picture, small_nodes, some,
};
use crate::harness::Difference;

pub fn config() -> TerrainConfig {
    TerrainConfig {
        coarse_levels: 6,
        interpolation: HeightInterpolation::Smooth,
        ..TerrainConfig::new(65, 160.0, "elevation").expect("valid")
    }
}

/// A map of waves, sharp ridges and stones.
pub fn map(first: [i32; 2], size: [u32; 2], spacing: u32, margin: u32) -> ElevationMap {
    let height = |at: u32| {
        let [x, y] = [at % size[0], at / size[0]].map(|at| f64::from(at * spacing));
        let stone = f64::from((at.wrapping_mul(2_654_435_761) >> 24) % 8) * 0.2;
        let waves = 50.0 * (x / 70.0).sin() * (y / 90.0).cos();
        (waves + 24.0 * (x * 0.031 + y * 0.017).sin().abs() + stone) as f32
    };
    let heights = (0..size[0] * size[1]).map(height).collect();
    ElevationMap { layout: ElevationLayout { spacing, first, size }, heights, margin }
}

fn source(config: &TerrainConfig, elevation: Arc<dyn ElevationSource>) -> TerrainSource {
    TerrainSource::endless(config.clone()).with_limits(small_nodes()).with_elevation(elevation)
}

/// The height of the finest triangles over a map with the terrain's spacing, from the tiles of level 0 and the generator alone.
fn truth(config: &TerrainConfig, tiles: &ElevationTiles, x: f64, z: f64) -> f64 {
    let ElevationLayout { first, size, .. } = tiles.info().layout;
    let sample = |at: [i64; 2]| {
        let is_inside = (0..2).all(|axis| {
            let from = at[axis] - i64::from(first[axis]);
            (0..i64::from(size[axis])).contains(&from)
        });
        let height = if is_inside {
            let tile = i64::from(TILE_SIZE);
            let number = TileNumber { level: 0, at: at.map(|at| at.div_euclid(tile) as i32) };
            let own = tiles.tile(number).expect("there").expect("there");
            own.heights[(at[1].rem_euclid(tile) * tile + at[0].rem_euclid(tile)) as usize]
        } else {
            region(config, &Features::default(), Region { first: at, width: 1, coarser: 0 })[0]
        };
        f64::from(height) / HEIGHT_ONE
    };
    let [column, row] = [x, z].map(|at| at.floor() as i64);
    let [a, b, c, d] = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[dx, dy]| sample([column + dx, row + dy]));
    let [u, v] = [x - x.floor(), z - z.floor()];
    if u + v <= 1.0 { a + (b - a) * u + (c - a) * v } else { d + (c - d) * (1.0 - u) + (b - d) * (1.0 - v) }
}

/// A flight over a map and beyond its border: nothing is missing, and all points lie within a pixel of the map's heights, and of
/// generated ones around it. The map ends in a margin, or at a cliff.
#[test]
fn a_flight_over_a_map_keeps_its_promise() {
    for (interpolation, margin) in [(HeightInterpolation::Smooth, 40), (HeightInterpolation::Linear, 0)] {
        let config = TerrainConfig { interpolation, ..config() };
        let tiles =
            Arc::new(ElevationTiles::new(&config, &map([-170, -310], [420, 380], 1, margin)).expect("valid"));
        let mut world = World::of(&source(&config, tiles.clone()), [96, 54]);
        let path = Path { from: [40.0, 110.0], frames: 12, metres: 240.0, height: 160.0, every: 4, step: 2 };
        let flight = flight(&mut world, &|x, z| truth(&config, &tiles, x, z), &path);
        println!("{flight:?}");
        assert_eq!(flight.holes, 0);
        assert!(flight.ready[0] <= 1.0 + ROUNDING && flight.ready[1] <= 1.0 + ROUNDING, "{flight:?}");
        assert!(flight.ready_frames >= 6 && flight.made > 2, "{flight:?}");
        // Far above, the map is smaller than the coarsest cells of its tiles.
        let camera = world.above([40.0, 2_000.0], 1_500.0);
        world.view.set(camera).expect("valid");
        world.settle();
        let drawn = some(&world.positions(&camera), 5);
        let found = offsets(&|x, z| truth(&config, &tiles, x, z), &camera, &drawn);
        assert!(largest(&found) <= 1.0 + ROUNDING, "{}", largest(&found));
    }
}

/// Between the samples of a coarse map, heights are generated: the host's ground passes through the samples, and the device draws
/// this ground. Noise takes maps of the terrain's own spacing.
#[test]
fn heights_between_samples_are_generated() {
    let fbm = TerrainConfig {
        generator: HeightGenerator::Fbm,
        interpolation: HeightInterpolation::Linear,
        ..config()
    };
    for (config, spacing) in [(config(), 8), (fbm, 1)] {
        let map = map([-20, -30], [60, 50], spacing, 6);
        let elevation = Arc::new(ElevationTiles::new(&config, &map).expect("valid"));
        let mut world = World::of(&source(&config, elevation), [160, 90]);
        let ground = |world: &World, x: f64, z: f64| {
            world.scene.ground(world.land, x, z).expect("valid").expect("ground").height
        };
        let spacing = f64::from(spacing);
        for (column, row) in [(7_u32, 8_u32), (30, 25), (52, 41)] {
            let [x, z] = [column, row].map(f64::from);
            let at = [(x - 20.0) * spacing, (z - 30.0) * spacing];
            let wanted = f64::from(map.heights[(row * 60 + column) as usize]);
            assert!((ground(&world, at[0], at[1]) - wanted).abs() < 1e-4, "{column} {row}");
        }
        if spacing > 1.0 {
            let [a, b] = [0.0, 8.0].map(|x| ground(&world, x, 0.0));
            let between = ground(&world, 4.0, 0.0) - 0.5 * (a + b);
            assert!(between.abs() > 0.01, "nothing is generated between the samples: {between}");
        }
        let plain = World::of(&TerrainSource::endless(config.clone()), [16, 9]);
        for at in [[900.0, 20.0], [-170.0 * spacing, 3.0]] {
            assert_eq!(ground(&world, at[0], at[1]), ground(&plain, at[0], at[1]), "around the map");
        }
        for (at, height) in [([10.0, 60.0], 3.0), ([300.0, 500.0], 120.0)] {
            let camera = world.above(at, height);
            world.view.set(camera).expect("valid");
            world.settle();
            let drawn = world.positions(&camera);
            let found = offsets(&|x, z| ground(&world, x, z), &camera, &some(&drawn, 7));
            assert!(found.iter().flatten().count() > 500);
            assert!(largest(&found) <= 1.0 + ROUNDING, "{}", largest(&found));
            assert_eq!(holes(&world, &camera, &drawn), 0);
        }
    }
}

/// Heights that are injected beside a map: its samples have them where they lie on it, and all others are generated with them. A flight
/// keeps its promise. Injected at run time, they give the same picture to the bit; without them again, the first picture.
#[test]
fn injected_heights_lie_on_the_map() {
    use FeatureMode::{Additive, Keep};
    let cases = [(1, Keep, 30.0, HeightInterpolation::Linear), (8, Keep, 60.0, HeightInterpolation::Smooth)];
    for (spacing, mode, height, interpolation) in
        cases.into_iter().chain([(1, Additive, -15.0, HeightInterpolation::Smooth)])
    {
        let config = TerrainConfig { interpolation, ..config() };
        let (first, size) = if spacing == 1 { ([-170, -110], [420, 180]) } else { ([-20, -12], [60, 20]) };
        let tiles = Arc::new(ElevationTiles::new(&config, &map(first, size, spacing, 4)).expect("valid"));
        let is_of_map = |at: [i32; 2]| {
            let inside = |axis: usize| {
                let place = at[axis].div_euclid(spacing as i32) - first[axis];
                at[axis] % spacing as i32 == 0 && (0..size[axis] as i32).contains(&place)
            };
            inside(0) && inside(1)
        };
        let points = road(height);
        let (on_map, around): (Vec<_>, Vec<_>) = points.iter().copied().partition(|(at, _)| is_of_map(*at));
        assert!(on_map.len() > 8 && around.len() > 500, "{} {}", on_map.len(), around.len());
        let with = |points: &[([i32; 2], f64)]| {
            let recipe = TerrainRecipe {
                features: features(&config, points, mode),
                ..TerrainRecipe::new(config.clone())
            };
            TerrainSource::from(recipe).with_limits(small_nodes()).with_elevation(tiles.clone())
        };
        let mut world = World::of(&with(&points), [96, 54]);
        let [mut other, plain, apart] =
            [&points[..], &[], &around].map(|points| World::of(&with(points), [16, 9]));
        let ground = |world: &World, [x, z]: [f64; 2]| {
            world.scene.ground(world.land, x, z).expect("valid").expect("ground").height
        };
        // With a map of the terrain's own spacing, heights on it are known without the generator.
        let exact = |x: f64, z: f64| {
            let sample = |at: [i64; 2]| {
                let at = at.map(|at| at as i32);
                let own = on_map.iter().find(|(place, _)| *place == at).map(|(_, height)| *height);
                match (own, mode) {
                    (Some(height), Keep) => height,
                    (own, _) => ground(&apart, at.map(f64::from)) + own.unwrap_or(0.0),
                }
            };
            let [column, row] = [x, z].map(|at| at.floor() as i64);
            let [a, b, c, d] =
                [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[dx, dy]| sample([column + dx, row + dy]));
            let [u, v] = [x - x.floor(), z - z.floor()];
            if u + v <= 1.0 {
                a + (b - a) * u + (c - a) * v
            } else {
                d + (c - d) * (1.0 - u) + (b - d) * (1.0 - v)
            }
        };
        for (at, injected) in points.iter().step_by(37) {
            let place = at.map(f64::from);
            let found = ground(&other, place);
            match mode {
                Keep => assert!((found - injected).abs() < 1e-4, "{at:?}: {found}, not {injected}"),
                Additive if is_of_map(*at) => {
                    let wanted = ground(&plain, place) + injected;
                    assert!((found - wanted).abs() < 1e-4, "{at:?}: {found}, not {wanted}");
                }
                Additive => {}
            }
            if spacing == 1 {
                let [x, z] = place.map(|at| at + 0.37);
                assert!((ground(&other, [x, z]) - exact(x, z)).abs() < 1e-4, "{at:?}");
            }
        }
        let far = [-300.0, 300.0];
        assert_eq!(ground(&apart, far), ground(&other, far), "features of the map change heights around it");
        let path = Path { from: [24.0, 60.0], frames: 9, metres: 220.0, height: 150.0, every: 4, step: 2 };
        let flight = flight(&mut world, &|x, z| ground(&other, [x, z]), &path);
        println!("{spacing} {mode:?}: {flight:?}");
        assert_eq!(flight.holes, 0);
        assert!(flight.ready[0] <= 1.0 + ROUNDING && flight.ready[1] <= 1.0 + ROUNDING, "{flight:?}");
        assert!(flight.ready_frames >= 4, "{flight:?}");
        // The same as from the beginning, and as without.
        let mut edited = World::of(&with(&[]), [96, 54]);
        let (place, above) = ([20.0, 20.0], 90.0);
        let camera = world.above(place, above);
        let settled = |world: &mut World| {
            world.view.set(camera).expect("valid");
            world.settle();
            picture(world)
        };
        let (whole, before) = (settled(&mut world), settled(&mut edited));
        edited.scene.set_terrain_features(edited.land, &features(&config, &points, mode)).expect("valid");
        edited.frame();
        let drawn = edited.positions(&camera);
        assert_eq!(holes(&edited, &camera, &drawn), 0);
        // Other nodes bound the ground otherwise, and all rays hit the same.
        let hit = hits(&edited, place, above);
        assert_eq!(hit, hits(&world, place, above));
        other.view.set(camera).expect("valid");
        other.frame();
        assert_eq!(hit, hits(&other, place, above));
        assert!(settled(&mut edited) == whole && whole != before, "{spacing} {mode:?}");
        edited.scene.set_terrain_features(edited.land, &TerrainFeatures::default()).expect("valid");
        assert!(settled(&mut edited) == before, "{spacing} {mode:?}");
    }
}

/// A source whose tiles arrive after some requests.
#[derive(Debug)]
struct Late {
    tiles: ElevationTiles,
    asked: Mutex<BTreeMap<TileNumber, u32>>,
}

impl ElevationSource for Late {
    fn info(&self) -> ElevationInfo {
        self.tiles.info()
    }

    fn tile(&self, number: TileNumber) -> Result<Option<Arc<ElevationTile>>, Error> {
        let mut asked = self.asked.lock().expect("not poisoned");
        let count = asked.entry(number).or_default();
        *count += 1;
        if *count > 6 { self.tiles.tile(number) } else { Ok(None) }
    }
}

/// Tiles that arrive late, and tiles that a thread reads from files, give the picture of the whole map to the bit. Until they are there,
/// coarser ones are drawn, and the host has no ground.
#[test]
fn tiles_that_arrive_one_by_one_give_the_same_picture() {
    let config = config();
    let tiles = ElevationTiles::new(&config, &map([-300, -700], [700, 900], 1, 30)).expect("valid");
    let camera =
        Camera::looking_at_world([20.0, 95.0, 60.0], [30.0, 60.0, -60.0], 0.9, [0.5, 12_000.0], [96, 54]);
    let shown = |source: &TerrainSource| {
        let mut world = World::of(source, [96, 54]).within(2.0);
        world.view.set(camera).expect("valid");
        let mut awaited = 0;
        for _ in 0..3_000 {
            world.frame();
            let statistics = world.scene.terrain_statistics(world.land).expect("endless");
            awaited = awaited.max(statistics.awaited);
            if statistics.ready == 1.0 {
                return (picture(&mut world), awaited, world);
            }
        }
        panic!("{:?}", world.scene.terrain_statistics(world.land));
    };
    let (whole, awaited, _) = shown(&source(&config, Arc::new(tiles.clone())));
    assert_eq!(awaited, 0);
    let late = Late { tiles: tiles.clone(), asked: Mutex::default() };
    let (picture, awaited, _) = shown(&source(&config, Arc::new(late)));
    assert!(awaited > 0 && picture == whole);
    let folder = tempfile::tempdir().expect("a folder");
    let mut written = 0;
    tiles.write(folder.path(), || written += 1).expect("written");
    assert_eq!(written, tiles.tiles().count());
    let loader = ElevationLoader::from_folder(folder.path()).expect("read");
    assert_eq!(loader.info(), tiles.info());
    let (picture, awaited, world) = shown(&source(&config, Arc::new(loader)));
    assert!(awaited > 0 && picture == whole);
    // The host asks for tiles, too, and has the ground once they are there.
    let far = || world.scene.ground(world.land, 390.0, 190.0).expect("valid");
    let start = std::time::Instant::now();
    while far().is_none() {
        assert!(start.elapsed().as_secs() < 60, "the tile never arrives");
        std::thread::yield_now();
    }
    // A tile that cannot be read is told, by the frame and by the host.
    let broken = tempfile::tempdir().expect("a folder");
    std::fs::copy(folder.path().join("elevation.json"), broken.path().join("elevation.json"))
        .expect("copied");
    let loader = ElevationLoader::from_folder(broken.path()).expect("read");
    let mut world = World::of(&source(&config, Arc::new(loader)), [96, 54]).within(2.0);
    world.view.set(camera).expect("valid");
    let error = (0..3_000).find_map(|_| {
        std::thread::yield_now();
        let World { gpu, scene, view, .. } = &mut world;
        let mut encoder = gpu.encoder("not submitted");
        scene.record(&mut encoder, &mut [view]).err()
    });
    let error = error.expect("a tile is missing").to_string();
    assert!(error.contains(".png"), "{error}");
    // Once the tiles are there, the next frames are as if nothing had happened.
    for level in std::fs::read_dir(folder.path()).expect("a folder") {
        let level = level.expect("an entry").path();
        if !level.is_dir() {
            continue;
        }
        let to = broken.path().join(level.file_name().expect("a name"));
        std::fs::create_dir_all(&to).expect("made");
        for file in std::fs::read_dir(&level).expect("a folder") {
            let file = file.expect("an entry").path();
            std::fs::copy(&file, to.join(file.file_name().expect("a name"))).expect("copied");
        }
    }
    let is_done = (0..3_000).any(|_| {
        std::thread::yield_now();
        let World { gpu, scene, view, land, .. } = &mut world;
        let recorded = gpu.try_run("again", |encoder| scene.record(encoder, &mut [view]));
        recorded.is_ok() && scene.terrain_statistics(*land).expect("endless").ready == 1.0
    });
    assert!(is_done && crate::endless::picture(&mut world) == whole);
}

/// The same map at the origin and 10⁷ samples away has the same picture.
#[test]
fn a_map_looks_the_same_far_from_the_origin() {
    let config = config();
    let shown = |away: i32| {
        let map = map([-400 + away, -900 - away], [900, 1_000], 1, 0);
        let elevation = Arc::new(ElevationTiles::new(&config, &map).expect("valid"));
        let mut world = World::of(&source(&config, elevation), [160, 90]).within(3.0);
        let [x, z] = [f64::from(away), -f64::from(away)];
        let (eye, target) = ([x + 20.0, 95.0, z + 60.0], [x + 30.0, 40.0, z - 60.0]);
        let camera = Camera::looking_at_world(eye, target, 0.7, [0.5, 900.0], [160, 90]);
        world.view.set(camera).expect("valid");
        world.settle();
        picture(&mut world)
    };
    let difference = Difference::of(&shown(0), &shown(1 << 24), 1);
    println!("{difference:?}");
    assert!(difference.flip < 0.002, "{difference:?}");
}

#[test]
fn mistakes_are_refused() {
    let config = config();
    let good = || map([0, 0], [40, 30], 4, 5);
    let refused = |map: ElevationMap, path: &str, words: &str| {
        let error = ElevationTiles::new(&config, &map).expect_err(path).to_string();
        assert!(error.contains(path) && error.contains(words), "{error}");
    };
    let layout = |change: fn(&mut ElevationLayout)| {
        let mut map = good();
        change(&mut map.layout);
        map
    };
    refused(layout(|layout| layout.spacing = 3), "spacing = 3", "power of two");
    refused(layout(|layout| layout.spacing = 4_096), "spacing = 4096", "at most 2048");
    refused(layout(|layout| layout.size[1] = 1), "size[1] = 1", "2..=16384");
    refused(layout(|layout| layout.first[0] = i32::MAX), "first[0]", "must fit i32");
    refused(layout(|layout| layout.size[1] = 31), "heights.len = 1200", "1240");
    refused(ElevationMap { margin: 16, ..good() }, "margin = 16", "0..=15");
    let mut holed = good();
    holed.heights[7] = f32::NAN;
    refused(holed, "heights[7] = NaN", "finite");
    let steep = ElevationMap {
        heights: (0..1_200).map(|at| if at % 2 == 0 { 16e3 } else { -16e3 }).collect(),
        ..good()
    };
    refused(steep, "heights", "could reach");
    let noise = TerrainConfig {
        generator: HeightGenerator::Ridged,
        interpolation: HeightInterpolation::Linear,
        ..config.clone()
    };
    let error = ElevationTiles::new(&noise, &good()).expect_err("noise").to_string();
    assert!(error.contains("spacing = 4") && error.contains("diamondSquare"), "{error}");
    let tiles: Arc<dyn ElevationSource> = Arc::new(ElevationTiles::new(&config, &good()).expect("valid"));
    let mut scene = relievo::scene::Scene::new(&crate::harness::gpu()).expect("made");
    let patches = TerrainSource::new(config.clone()).with_elevation(tiles.clone());
    let error = scene.add_terrain(&patches).expect_err("patches").to_string();
    assert!(error.contains("elevation") && error.contains("endless"), "{error}");
    let other = TerrainConfig { coarse_levels: 0, ..TerrainConfig::new(5, 1.0, "").expect("valid") };
    let limits = EndlessLimits { node_size: 9, ..EndlessLimits::default() };
    let error = scene.add_terrain(&TerrainSource::endless(other).with_limits(limits).with_elevation(tiles));
    let error = error.expect_err("another terrain").to_string();
    assert!(error.contains("node_size") || error.contains("elevation.spacing = 4"), "{error}");
}
