//! Endless terrain on the way from one recipe to another.

use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::region as heights;
use relievo::scene::{
    Camera, Despike, EndlessLimits, Scene, TerrainConfig, TerrainMorph, TerrainRecipe, TerrainSource,
};

use crate::endless::{ROUNDING, World, between, holes, largest, offsets, picture, small_nodes, some};
use crate::endless_erosion::blended;
use crate::harness::{Difference, gpu};

/// Ground whose coarsest nodes are two kilometres wide.
fn config() -> TerrainConfig {
    TerrainConfig { scale_factor: 150.0, coarse_levels: 5, ..crate::endless::config() }
}

/// Lower ground of another seed, which is rougher.
fn target() -> TerrainConfig {
    TerrainConfig { scale_factor: 75.0, roughness: 0.85, seed: "the other end".to_owned(), ..config() }
}

fn limits() -> EndlessLimits {
    EndlessLimits { view_distance: Some(800.0), finer_normals: false, ..small_nodes() }
}

fn source(time: f64) -> TerrainSource {
    let target = TerrainRecipe::new(target());
    TerrainSource::endless(config()).with_limits(limits()).with_target(target, TerrainMorph { time })
}

/// The finest height at a time, from the definition.
fn truth(time: f64, x: f64, z: f64) -> f64 {
    let (from, to) = (config(), target());
    between(&from, [x, z], |region| {
        let [from, to] = [&from, &to].map(|config| heights(config, &Features::default(), region));
        from.into_iter().zip(to).map(|(from, to)| blended([from, to], time)).collect()
    })
}

/// What a camera sees of terrain, at a time to which it is set after it was added.
fn seen(source: &TerrainSource, time: Option<f64>) -> image::RgbaImage {
    let mut world = World::of(source, [64, 36]);
    if let Some(time) = time {
        world.scene.morph_terrain(world.land, TerrainMorph { time }).expect("a target");
    }
    let (eye, at) = ([40.0, 200.0, -700.0], [42.0, 160.0, -740.0]);
    let camera = Camera::looking_at_world(eye, at, 0.9, [0.5, 12_000.0], [64, 36]);
    world.view.set(camera).expect("valid");
    world.settle();
    picture(&mut world)
}

/// At both ends, the picture is that of the recipe there.
#[test]
fn at_both_ends_it_is_the_terrain_of_one_recipe() {
    let alone = |config: TerrainConfig| seen(&TerrainSource::endless(config).with_limits(limits()), None);
    let [start, end] = [config(), target()].map(alone);
    let between = Difference::of(&start, &end, 3);
    assert!(between.flip > 0.1, "the ends look alike: {between:?}");
    // Nodes are as fine as both recipes need them, so their normals are finer than those of one recipe.
    for (time, alone) in [(0.0, &start), (1.0, &end)] {
        let blended = seen(&source(time), None);
        assert!(blended == seen(&source(0.3), Some(time)), "{time}");
        let difference = Difference::of(&blended, alone, 3);
        println!("at {time}: {difference:?}, of {between:?}");
        assert!(difference.outliers < 0.03 && difference.flip < 0.02, "{time}: {difference:?}");
        // From the other side.
        let (from, to) = (TerrainRecipe::new(target()), TerrainMorph { time: 1.0 - time });
        let back = TerrainSource::from(from).with_limits(limits());
        let back = back.with_target(TerrainRecipe::new(config()), to);
        assert!(blended == seen(&back, None), "{time}, from the other side");
    }
    // With itself as its target, it is what it is; the bounds of its errors are larger by what blending rounds.
    let same = TerrainSource::endless(config()).with_limits(limits());
    let same = same.with_target(TerrainRecipe::new(config()), TerrainMorph { time: 0.37 });
    let same = Difference::of(&seen(&same, None), &start, 1);
    assert!(same.outliers == 0.0, "{same:?}");
}

/// While the time runs and the camera flies, every frame is within a pixel of the heights of its time, without a hole, and no node is made
/// because of the time.
#[test]
fn every_time_keeps_the_promise() {
    let mut world = World::of(&source(0.0), [96, 54]);
    let camera = world.above([1.0e6, 40.0], 60.0);
    world.view.set(camera).expect("valid");
    world.settle();
    let mut most = 0.0_f64;
    for frame in 0..=4 {
        let time = f64::from(frame) / 4.0;
        world.scene.morph_terrain(world.land, TerrainMorph { time }).expect("a target");
        let drawn = world.positions(&camera);
        let statistics = world.scene.terrain_statistics(world.land).expect("endless");
        assert_eq!((statistics.made, statistics.ready), (0, 1.0), "{time}: {statistics:?}");
        assert_eq!(holes(&world, &camera, &drawn), 0, "at {time}");
        let off = largest(&offsets(&|x, z| truth(time, x, z), &camera, &some(&drawn, 5)));
        assert!(off <= 1.0 + ROUNDING, "{off} pixels at {time}");
        most = most.max(off);
    }
    assert!(most > 0.05, "{most}");
    // Another time than the one that is drawn is seen.
    let drawn = world.positions(&camera);
    assert!(largest(&offsets(&|x, z| truth(0.9, x, z), &camera, &some(&drawn, 5))) > 2.0);
    let mut ready = 0;
    for frame in 0..10 {
        let time = 1.0 - f64::from(frame) / 10.0;
        world.scene.morph_terrain(world.land, TerrainMorph { time }).expect("a target");
        let camera = world.above([1.0e6 + 6.0 * f64::from(frame), 40.0], 60.0);
        world.view.set(camera).expect("valid");
        let drawn = world.positions(&camera);
        assert_eq!(holes(&world, &camera, &drawn), 0, "at {time}");
        if world.scene.terrain_statistics(world.land).expect("endless").ready == 1.0 {
            let off = largest(&offsets(&|x, z| truth(time, x, z), &camera, &some(&drawn, 5)));
            assert!(off <= 1.0 + ROUNDING, "{off} pixels at {time}, in flight");
            ready += 1;
        }
    }
    assert!(ready > 2, "{ready}");
}

/// The ground answers at once, at every time.
#[test]
fn the_ground_is_that_of_the_time() {
    let mut world = World::of(&source(0.25), [64, 36]);
    for time in [0.25, 0.75, 0.0, 1.0] {
        world.scene.morph_terrain(world.land, TerrainMorph { time }).expect("a target");
        for (x, z) in [(0.25, 0.5), (-7_000.75, 33.125), (1.0e6 + 0.5, -1.0e6 - 0.25)] {
            let point = world.scene.ground(world.land, x, z).expect("valid").expect("ground");
            assert!((point.height - truth(time, x, z)).abs() < 1e-6, "{time}: {}", point.height);
        }
    }
    let refused = world.scene.morph_terrain(world.land, TerrainMorph { time: 1.5 }).expect_err("refused");
    assert_eq!(refused.path, "time");
}

#[test]
fn nodes_are_made_again_after_a_loss() {
    crate::endless::a_loss_leaves_no_trace(&source(0.6));
}

#[test]
fn targets_that_do_not_fit_are_refused() {
    let mut scene = Scene::new(&gpu()).expect("made");
    let mut refused = |target: TerrainRecipe| {
        let source = TerrainSource::endless(config()).with_target(target, TerrainMorph::default());
        match scene.add_terrain(&source) {
            Err(relievo::Error::Input(error)) => error.path,
            other => panic!("{other:?}"),
        }
    };
    let of = TerrainRecipe::new;
    assert_eq!(refused(of(TerrainConfig { coarse_levels: 4, ..target() })), "target.coarse_levels");
    assert_eq!(refused(of(TerrainConfig { patch_size: 33, ..target() })), "target.patch_size");
    let despike = Some(Despike { threshold: 1.0 });
    assert_eq!(refused(TerrainRecipe { despike, ..of(target()) }), "target.recipe");
    let thermal = Some(relievo::scene::Thermal { iterations: 129, talus: 20.0 });
    assert_eq!(refused(TerrainRecipe { thermal, ..of(target()) }), "target.iterations");
    let land = scene.add_terrain(&TerrainSource::endless(config())).expect("added");
    let without = scene.morph_terrain(land, TerrainMorph::default()).expect_err("refused").to_string();
    assert!(without.contains("with_target"), "{without}");
}
