//! Endless terrain whose ground is eroded near the views.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

use glam::DVec3;
use relievo::ops::terrain::field::field;
use relievo::ops::terrain::hydraulic::Hydraulic;
use relievo::ops::terrain::thermal::Thermal;
use relievo::ops::terrain::thermal::reference::thermal as thermal_reference;
use relievo::scene::{
    Camera, ElevationTiles, EndlessLimits, FeatureMode, Ray, Scene, TerrainConfig, TerrainFeatures,
    TerrainMorph, TerrainRecipe, TerrainSource,
};

use crate::edited::features;
use crate::endless::{
    Path, ROUNDING, World, between, flight, hits, holes, largest, offsets, picture, small_nodes, some,
};
use crate::harness::{Difference, gpu};

/// Steep mountains, whose coarsest nodes are a kilometre wide.
fn config() -> TerrainConfig {
    TerrainConfig { scale_factor: 150.0, coarse_levels: 4, ..crate::endless::config() }
}

/// The most that erosion may move a height, in world units.
const DEPTH: f64 = 0.25;

/// Slopes slide, and rain digs.
fn recipe() -> TerrainRecipe {
    let thermal = Some(Thermal { iterations: 3, talus: 4.0 });
    let hydraulic = Some(Hydraulic { iterations: 2, ..Hydraulic::default() });
    TerrainRecipe { thermal, hydraulic, ..TerrainRecipe::new(config()) }
}

fn source(recipe: TerrainRecipe) -> TerrainSource {
    TerrainSource::from(recipe).with_limits(limits())
}

fn limits() -> EndlessLimits {
    EndlessLimits { view_distance: Some(400.0), erosion_depth: DEPTH, ..small_nodes() }
}

/// Nodes that are cut from shared squares of eroded ground: they are less than four times as wide as erosion reaches.
fn small(recipe: TerrainRecipe) -> TerrainSource {
    TerrainSource::from(recipe).with_limits(EndlessLimits {
        node_size: 9,
        nodes_per_frame: 256,
        capacity: 4096,
        ..limits()
    })
}

/// The heights of a patch without erosion and with it.
type PatchHeights = Arc<[Vec<i32>; 2]>;

/// The finest heights, eroded patch by patch, and the patches that are known.
struct Truth {
    recipes: [TerrainRecipe; 2],
    patches: Mutex<HashMap<[i32; 2], PatchHeights>>,
    /// Number of heights that erosion would move farther than it may.
    limited: AtomicU32,
}

impl Truth {
    fn new() -> Self {
        Self::of(recipe())
    }

    fn of(recipe: TerrainRecipe) -> Self {
        let plain = TerrainRecipe::new(recipe.config.clone());
        Self { recipes: [plain, recipe], patches: Mutex::default(), limited: AtomicU32::new(0) }
    }

    fn patch(&self, patch: [i32; 2]) -> PatchHeights {
        if let Some(known) = self.patches.lock().expect("whole").get(&patch) {
            return known.clone();
        }
        let [plain, eroded] =
            self.recipes.each_ref().map(|recipe| field(recipe, &[patch], 0).expect("valid").remove(0));
        let most = (DEPTH * 65_536.0) as i32;
        let limited = |(plain, eroded): (&i32, i32)| {
            if (eroded - plain).abs() > most {
                self.limited.fetch_add(1, Ordering::Relaxed);
            }
            plain + (eroded - plain).clamp(-most, most)
        };
        let eroded = plain.iter().zip(eroded).map(limited).collect();
        let heights = Arc::new([plain, eroded]);
        self.patches.lock().expect("whole").insert(patch, heights.clone());
        heights
    }

    /// The height of a sample without erosion and with it.
    fn sample(&self, [column, row]: [i64; 2]) -> [i32; 2] {
        let patch = [column, row].map(|at| at.div_euclid(64) as i32);
        let [column, row] = [column, row].map(|at| at.rem_euclid(64) as usize);
        self.patch(patch).each_ref().map(|heights| heights[row * 65 + column])
    }

    fn at(&self, x: f64, z: f64) -> f64 {
        height([x, z], &|sample| self.sample(sample)[1])
    }

    /// The height on the way from the ground without erosion to the eroded one.
    fn at_time(&self, time: f64, x: f64, z: f64) -> f64 {
        height([x, z], &|sample| blended(self.sample(sample), time))
    }
}

/// The height of a place on the triangles between samples.
fn height(place: [f64; 2], of: &dyn Fn([i64; 2]) -> i32) -> f64 {
    between(&config(), place, |region| {
        let [column, row] = region.first;
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, z]| of([column + x, row + z])).to_vec()
    })
}

/// The height at a time on the way from one to another.
pub fn blended([from, to]: [i32; 2], time: f64) -> i32 {
    from + ((i64::from(to - from) * (time * 65_536.0).round() as i64) >> 16) as i32
}

/// Near and far, what is drawn is within a pixel of the eroded ground, which is not the ground without erosion.
#[test]
fn what_is_drawn_is_within_a_pixel_of_the_eroded_ground() {
    let truth = Truth::new();
    let mut world = World::of(&source(recipe()), [96, 54]);
    let mut plain = World::of(&source(TerrainRecipe::new(config())), [96, 54]);
    for (at, height, apart) in [([10.0, 20.0], 2.0, 1.0), ([9.0e6, -9.5e6], 60.0, 0.0)] {
        let camera = world.above(at, height);
        world.view.set(camera).expect("valid");
        let frames = world.settle();
        let drawn = world.positions(&camera);
        assert_eq!(holes(&world, &camera, &drawn), 0, "{height} above");
        let some = some(&drawn, 7);
        let most = largest(&offsets(&|x, z| truth.at(x, z), &camera, &some));
        let nodes = world.scene.terrain_statistics(world.land).expect("endless");
        plain.view.set(camera).expect("valid");
        plain.settle();
        let without = plain.positions(&camera);
        let without = largest(&offsets(&|x, z| truth.at(x, z), &camera, &crate::endless::some(&without, 7)));
        println!("{height} above: {frames} frames, {most} px off, {without} without erosion; {nodes:?}");
        assert!(most <= 1.0 + ROUNDING && most > 0.05, "{most}");
        assert!(without > apart, "{without}");
    }
}

#[test]
fn a_flight_over_eroded_ground_has_no_holes_and_keeps_its_promise() {
    let truth = Truth::new();
    let mut world = World::of(&source(recipe()), [96, 54]);
    let path = Path { from: [1.0e6, 40.0], frames: 24, metres: 300.0, height: 120.0, every: 6, step: 7 };
    let flight = flight(&mut world, &|x, z| truth.at(x, z), &path);
    println!("{flight:?}");
    assert_eq!(flight.holes, 0);
    assert!(flight.ready[0] <= 1.0 + ROUNDING && flight.ready[1] <= 1.0 + ROUNDING, "{flight:?}");
    assert!(flight.ready_frames >= 8 && flight.made > 20, "{flight:?}");
}

/// The ground of the host is the eroded one, and rays hit it.
#[test]
fn the_ground_of_the_host_is_eroded() {
    let truth = Truth::new();
    let mut world = World::of(&source(recipe()), [64, 36]);
    let camera = world.above([100.0, 100.0], 40.0);
    world.view.set(camera).expect("valid");
    world.frame();
    let (mut moved, mut hits) = (0, 0);
    for at in 0..200 {
        let (x, z) = (37.3 * f64::from(at) + 0.25, 40.0 - 11.7 * f64::from(at));
        let point = world.scene.ground(world.land, x, z).expect("valid").expect("ground");
        assert!((point.height - truth.at(x, z)).abs() < 1e-6, "{x} {z}: {}", point.height);
        moved += usize::from((point.height - field_height(x, z)).abs() > 0.1);
    }
    assert!(moved > 20, "{moved} of 200 places are eroded");
    assert!(truth.limited.load(Ordering::Relaxed) > 100, "the limit is never reached");
    for at in 0..20 {
        let turn = 0.3 * f64::from(at);
        let direction = DVec3::new(turn.cos(), -0.3, turn.sin()).normalize();
        let origin = DVec3::new(100.0, truth.at(100.0, 100.0) + 40.0, 100.0);
        let Some(hit) =
            world.scene.pick(&Ray { limit: 400.0, ..Ray::new(origin, direction) }).expect("valid")
        else {
            continue;
        };
        let [x, y, z] = hit.world().to_array();
        assert!((y - truth.at(x, z)).abs() < 1e-6 * hit.distance.max(1.0), "{at}: {y}");
        hits += 1;
    }
    assert!(hits > 10, "{hits}");
    // The bounds of finer nodes change no hit.
    let coarse = self::hits(&world, [100.0, 100.0], 40.0);
    world.settle();
    assert_eq!(self::hits(&world, [100.0, 100.0], 40.0), coarse);
    assert!(coarse.iter().flatten().count() > 60, "{coarse:?}");
}

/// The height without erosion.
fn field_height(x: f64, z: f64) -> f64 {
    let config = config();
    between(&config, [x, z], |region| {
        relievo::ops::terrain::field::region(&config, &Default::default(), region)
    })
}

/// Ground erodes while the time runs. At each time, what is drawn is within a pixel of the heights on the way from ground without erosion
/// to eroded ground, and so is the host's ground; no node is made because of the time. So with small nodes, which share eroded ground.
#[test]
fn ground_erodes_as_time_goes_by() {
    let truth = Truth::new();
    for source in [source, small] {
        let plain = TerrainRecipe::new(config());
        let aging = source(plain).with_target(recipe(), TerrainMorph { time: 0.0 });
        let mut world = World::of(&aging, [96, 54]);
        let camera = world.above([10.0, 20.0], 3.0);
        world.view.set(camera).expect("valid");
        world.settle();
        for time in [0.0, 0.5, 1.0] {
            world.scene.morph_terrain(world.land, TerrainMorph { time }).expect("a target");
            let drawn = world.positions(&camera);
            let statistics = world.scene.terrain_statistics(world.land).expect("endless");
            assert_eq!((statistics.made, statistics.ready), (0, 1.0), "{time}: {statistics:?}");
            assert_eq!(holes(&world, &camera, &drawn), 0, "at {time}");
            let some = some(&drawn, 7);
            let off = |time: f64| largest(&offsets(&|x, z| truth.at_time(time, x, z), &camera, &some));
            let (own, ends) = (off(time), [off(0.0), off(1.0)]);
            println!("at {time}: {own} px off, {ends:?} from both ends");
            assert!(own <= 1.0 + ROUNDING, "{own} px at {time}");
            assert!(ends[0].max(ends[1]) > 1.05, "{ends:?} px at {time}");
            for at in 0..20 {
                let (x, z) = (37.3 * f64::from(at) + 0.25, 40.0 - 11.7 * f64::from(at));
                let point = world.scene.ground(world.land, x, z).expect("valid").expect("ground");
                assert!((point.height - truth.at_time(time, x, z)).abs() < 1e-6, "{time}: {x} {z}");
            }
        }
    }
}

/// Both recipes are eroded, each by its own erosion.
#[test]
fn each_end_has_its_own_erosion() {
    let other = TerrainConfig { scale_factor: 75.0, seed: "the other end".to_owned(), ..config() };
    let thermal = Some(Thermal { iterations: 8, talus: 2.0 });
    let other = TerrainRecipe { thermal, ..TerrainRecipe::new(other) };
    let truths = [recipe(), other.clone()].map(Truth::of);
    let both = source(recipe()).with_target(other, TerrainMorph::default());
    let mut world = World::of(&both, [96, 54]);
    for time in [0.0, 0.3, 1.0] {
        world.scene.morph_terrain(world.land, TerrainMorph { time }).expect("a target");
        let camera = world.above([10.0, 20.0], 3.0);
        world.view.set(camera).expect("valid");
        world.settle();
        let drawn = world.positions(&camera);
        assert_eq!(holes(&world, &camera, &drawn), 0, "at {time}");
        let some = some(&drawn, 7);
        let [without, off] = [0, 1].map(|end| {
            let of = |sample| blended(truths.each_ref().map(|truth| truth.sample(sample)[end]), time);
            largest(&offsets(&|x, z| height([x, z], &of), &camera, &some))
        });
        println!("at {time}: {off} px off, {without} from the ground without erosion");
        assert!(off <= 1.0 + ROUNDING, "{off} px at {time}");
        assert!(without > 1.2, "{without} px at {time}");
    }
}

/// While nodes are missing, some are eroded and others beside them are not, and yet the ground is closed: below it there is no sky.
#[test]
fn eroded_ground_is_closed_while_nodes_are_missing() {
    let limits = EndlessLimits {
        nodes_per_frame: 16,
        view_distance: Some(1_000.0),
        erosion_depth: 6.0,
        node_size: 17,
        ..small_nodes()
    };
    let thermal = Some(Thermal { iterations: 12, talus: 1.0 });
    let recipe = TerrainRecipe { thermal, ..TerrainRecipe::new(config()) };
    let size = [320, 180];
    let mut world = World::of(&source(recipe).with_limits(limits), size);
    let (mut unready, mut eroded, at) = (0, 0, [40.0, -700.0]);
    let ground = world.scene.ground(world.land, at[0], at[1]).expect("valid").expect("ground").height;
    // Down to the ground, from above all of it.
    let (eye, target) = ([at[0], ground + 150.0, at[1]], [at[0] + 1.0, ground - 20.0, at[1] - 150.0]);
    let camera = Camera::looking_at_world(eye, target, 0.9, [0.5, 12_000.0], size);
    world.view.set(camera).expect("valid");
    for frame in 0..60 {
        let drawn = world.positions(&camera);
        let statistics = world.scene.terrain_statistics(world.land).expect("endless");
        if frame > 4 {
            assert!(
                drawn.iter().all(Option::is_some),
                "{} pixels of sky in frame {frame}",
                drawn.iter().filter(|at| at.is_none()).count()
            );
        }
        if statistics.ready == 1.0 {
            break;
        }
        unready += 1;
        eroded = eroded.max(statistics.levels[..4].iter().sum::<u32>());
    }
    assert!(unready > 10 && eroded > 10, "{unready} {eroded}");
}

/// Erosion that reaches a few samples only is the same wherever nodes are made: a place has one picture.
#[test]
fn a_place_has_one_picture() {
    let place = [40.0, -700.0];
    let shown = |from: [f64; 2]| {
        let mut world = World::of(&source(recipe()), [64, 36]).within(2.0);
        let before = world.above(from, 30.0);
        world.view.set(before).expect("valid");
        world.settle();
        let camera = world.above(place, 30.0);
        world.view.set(camera).expect("valid");
        world.settle();
        picture(&mut world)
    };
    let one = shown([900.0, -700.0]);
    assert!(one == shown([-2_000.0, 5_000.0]));
    let mut plain = World::of(&source(TerrainRecipe::new(config())), [64, 36]).within(2.0);
    let camera = plain.above(place, 30.0);
    plain.view.set(camera).expect("valid");
    plain.settle();
    let difference = Difference::of(&one, &picture(&mut plain), 3);
    println!("{difference:?}");
    assert!(difference.outliers > 0.01, "{difference:?}");
}

/// Erosion of an elevation map, of the terrain's own spacing and of a coarser one, with injected heights on it and around it: inside the
/// map, across its border, and around it, the host has the heights of the terrain without erosion, eroded by the reference, and the
/// device draws them.
#[test]
fn an_elevation_map_is_eroded() {
    type Source = fn(TerrainRecipe) -> TerrainSource;
    // Small nodes share eroded ground.
    let cases: [(u32, u32, Source); 3] = [(1, 0, source), (1, 0, small), (8, 6, small)];
    for (spacing, margin, source) in cases {
        let config = crate::elevation::config();
        let map = crate::elevation::map([-60, -70], [90, 100], spacing, margin);
        let tiles = Arc::new(ElevationTiles::new(&config, &map).expect("valid"));
        let thermal = Thermal { iterations: 3, talus: 20.0 };
        // Pits, a sample each.
        let pits: Vec<_> = (-12..60).map(|at: i32| ([8 * at, 8 * (at % 5) - 16], -60.0)).collect();
        let features = features(&config, &pits, FeatureMode::Keep);
        let [mut eroded, plain] = [Some(thermal), None].map(|thermal| {
            let features = features.clone();
            let recipe = TerrainRecipe { thermal, features, ..TerrainRecipe::new(config.clone()) };
            World::of(&source(recipe).with_elevation(tiles.clone()), [96, 54])
        });
        let ground = |world: &World, at: [f64; 2]| {
            world.scene.ground(world.land, at[0], at[1]).expect("valid").expect("ground").height
        };
        // One window inside the map, one across its border, and one beyond its margin, which is eroded from the border inwards.
        let (wide, rings) = (24_usize, thermal.iterations as usize);
        let west = -60 * i64::from(spacing);
        let mut most = 0.0_f64;
        for first in [[-10, -15], [west - 12, -20], [west - i64::from(margin * spacing) - 22, 0]] {
            let at = |column: usize, row: usize| [first[0] + column as i64, first[1] + row as i64];
            let height =
                |world: &World, at: [i64; 2]| (ground(world, at.map(|at| at as f64)) * 65_536.0) as i32;
            let cells = || (0..wide).flat_map(|row| (0..wide).map(move |column| (column, row)));
            let before: Vec<i32> = cells().map(|(column, row)| height(&plain, at(column, row))).collect();
            let mut window = before.clone();
            for ring in 0..rings {
                window = thermal_reference(&window, wide - 2 * ring, thermal.fixed_threshold(1.0));
            }
            let (inside, limit) = (wide - 2 * rings, (DEPTH * 65_536.0) as i32);
            for (index, moved) in window.iter().enumerate() {
                let (column, row) = (index % inside + rings, index / inside + rings);
                let before = before[row * wide + column];
                let expected = before + (moved - before).clamp(-limit, limit);
                assert_eq!(
                    height(&eroded, at(column, row)),
                    expected,
                    "{spacing}: {column} {row} of {first:?}"
                );
                most = most.max(f64::from(expected - before).abs() / 65_536.0);
            }
        }
        println!("spacing {spacing}: erosion moves heights by {most}");
        assert!(most > 0.1, "erosion moves heights by {most}");
        let mut without = 0.0_f64;
        let far = (margin == 0).then_some(([300.0, 500.0], 120.0));
        for (at, above) in [([10.0, 20.0], 3.0), ([west as f64 - 4.0, 60.0], 12.0)].into_iter().chain(far) {
            let camera = eroded.above(at, above);
            eroded.view.set(camera).expect("valid");
            eroded.settle();
            let drawn = eroded.positions(&camera);
            let some = some(&drawn, 7);
            let [off, plain] = [&eroded, &plain]
                .map(|world| largest(&offsets(&|x, z| ground(world, [x, z]), &camera, &some)));
            println!(
                "spacing {spacing}, {above} above: {off} px off, {plain} from the ground without erosion"
            );
            assert!(off <= 1.0 + ROUNDING, "{off} px");
            assert_eq!(holes(&eroded, &camera, &drawn), 0);
            without = without.max(plain);
        }
        assert!(without > 1.5, "{without} px from the ground without erosion");
    }
}

/// Small nodes share eroded ground. What is drawn is within a pixel of the ground that is eroded patch by patch. Back from a place
/// where more ground is shared than the device keeps, the picture is the same.
#[test]
fn small_nodes_share_eroded_ground() {
    let truth = Truth::new();
    let mut world = World::of(&small(recipe()), [96, 54]);
    let mut plain = World::of(&small(TerrainRecipe::new(config())), [96, 54]);
    let camera = world.above([10.0, 20.0], 3.0);
    let apart = [&mut world, &mut plain].map(|world| {
        world.view.set(camera).expect("valid");
        world.settle();
        let drawn = world.positions(&camera);
        assert_eq!(holes(world, &camera, &drawn), 0);
        largest(&offsets(&|x, z| truth.at(x, z), &camera, &some(&drawn, 3)))
    });
    println!("{apart:?} px off, with erosion and without");
    assert!(apart[0] <= 1.0 + ROUNDING && apart[1] > 1.5, "{apart:?}");
    let before = picture(&mut world);
    let elsewhere = world.above([3_010.0, 4_020.0], 3.0);
    world.view.set(elsewhere).expect("valid");
    world.settle();
    let nodes = world.scene.terrain_statistics(world.land).expect("endless");
    println!("{nodes:?}");
    // A square is as wide as a node of level 2, and 64 squares are kept.
    assert!(nodes.levels[2] > 64, "{nodes:?}");
    assert!(picture(&mut world) != before);
    world.view.set(camera).expect("valid");
    world.settle();
    assert!(picture(&mut world) == before);
}

#[test]
fn nodes_are_made_again_after_a_loss() {
    crate::endless::a_loss_leaves_no_trace(&source(recipe()));
}

/// Heights that are injected at run time are eroded as those that were there from the beginning.
#[test]
fn edited_ground_is_eroded() {
    let wall: fn(i32) -> TerrainFeatures = |column| {
        let points: Vec<_> = (-60..0).map(|row| ([column, row], 300.0)).collect();
        features(&config(), &points, FeatureMode::Keep)
    };
    let with = |column: i32| TerrainRecipe { features: wall(column), ..recipe() };
    let shown = |world: &mut World| {
        let camera = world.above([31.0, 20.0], 90.0);
        world.view.set(camera).expect("valid");
        world.settle();
        picture(world)
    };
    let mut world = World::of(&small(with(30)), [64, 36]).within(2.0);
    let before = shown(&mut world);
    world.scene.set_terrain_features(world.land, &wall(34)).expect("edited");
    let after = shown(&mut world);
    assert!(after == shown(&mut World::of(&small(with(34)), [64, 36]).within(2.0)) && after != before);
}

/// Over tall ground, at the focal length of a large picture, coarse nodes stand beside the view and behind the eye.
#[test]
fn the_promise_holds_for_large_pictures_of_tall_ground() {
    let config = TerrainConfig { scale_factor: 600.0, ..crate::endless::config() };
    let thermal = Some(Thermal { iterations: 6, talus: 20.0 });
    let recipe = TerrainRecipe { thermal, ..TerrainRecipe::new(config) };
    let limits = EndlessLimits {
        nodes_per_frame: 256,
        view_distance: Some(1_500.0),
        node_size: 33,
        capacity: 4096,
        erosion_depth: DEPTH,
        ..EndlessLimits::default()
    };
    let truth = Truth::of(recipe.clone());
    let mut world = World::of(&source(recipe).with_limits(limits), [96, 54]).within(2.0);
    // The middle of a picture of 1920 × 1080 with a field of view of 0.9.
    let (at, height) = ([700.0, -300.0], 30.0);
    let ground = world.scene.ground(world.land, at[0], at[1]).expect("valid").expect("ground").height;
    let (eye, target) =
        ([at[0], ground + height, at[1]], [at[0] + 10.0, ground + height - 6.0, at[1] - 60.0]);
    let camera = Camera::looking_at_world(eye, target, 0.048, [0.5, 12_000.0], [96, 54]);
    world.view.set(camera).expect("valid");
    world.settle();
    let drawn = world.positions(&camera);
    let most = largest(&offsets(&|x, z| truth.at(x, z), &camera, &some(&drawn, 2)));
    println!("{height} above: {most} px, {:?}", world.scene.terrain_statistics(world.land).expect("endless"));
    assert!(most <= 2.0 + ROUNDING, "{most}");
    // With memory for all nodes, the promise is not relaxed.
    assert_eq!(world.scene.lod_bias(world.land), Ok(1.0));
}

#[test]
fn erosion_out_of_bounds_is_refused() {
    let mut scene = Scene::new(&gpu()).expect("made");
    let mut refused = |source: TerrainSource| match scene.add_terrain(&source) {
        Err(relievo::Error::Input(error)) => error.path,
        other => panic!("{other:?}"),
    };
    let deep = |erosion_depth: f64| {
        source(recipe()).with_limits(EndlessLimits { erosion_depth, ..EndlessLimits::default() })
    };
    assert_eq!(refused(deep(0.0)), "erosion_depth");
    assert_eq!(refused(deep(f64::NAN)), "erosion_depth");
    assert_eq!(refused(deep(1001.0)), "erosion_depth");
    let many = Some(Thermal { iterations: 127, talus: 20.0 });
    assert_eq!(refused(source(TerrainRecipe { thermal: many, ..recipe() })), "iterations");
}
