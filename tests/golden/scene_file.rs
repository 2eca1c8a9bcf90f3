//! Scenes of `examples/scenes/`, drawn through the library as the command line draws them.

use std::path::Path;

use image::RgbaImage;
use image::imageops::{FilterType, resize};
use relievo::scene::Ray;
use relievo_lab::measure::{Player, Rendering};
use relievo_scene_file::{SceneFile, WorldKind};
use serde_json::{Value, json};

use crate::harness::{Difference, Tolerance, check_golden, gpu};

/// The pictures: a scene file, and a time in it.
const PICTURES: &[(&str, &str, f32)] = &[
    ("scene_ruins", "ruins.json", 0.0),
    ("scene_far", "far.json", 0.25),
    ("scene_herd", "herd.json", 2.5),
    (NEAR, "herd.json", 2.5),
    (WALK, "walk.json", 0.0),
    ("ground_walk_plain", "walk.json", 0.0),
    (FAR, "overlook.json", 0.0),
    ("ground_far_plain", "overlook.json", 0.0),
    (RELIEF, "scree.json", 0.0),
];

/// Ground by height and slope, as somebody sees it who walks there, and from afar. The plain ones have the same world with no more
/// than its default zones.
const WALK: &str = "ground_walk";
const FAR: &str = "ground_far";
const RELIEF: &str = "ground_relief";

/// The herd from so near that a creature covers more of the picture than may differ; from the file's own camera it does not.
const NEAR: &str = "scene_herd_near";

/// The size of a golden. Frames have one sample a pixel at twice that size, and are averaged.
const SIZE: [u32; 2] = [208, 136];

/// The scene of a golden: what its file says, but for the camera of the near one, and the look of plain ground.
fn scene_of(name: &str, file: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes").join(file);
    let text = std::fs::read_to_string(path).expect("there");
    let mut scene: Value = serde_json::from_str(&text).expect("JSON");
    if name == NEAR {
        scene["camera"] = json!({ "near": 0.2, "at": [59.5, 6.5, 83], "look": [60, 3.6, 74] });
    }
    if name.ends_with("_plain") {
        let config = scene["terrain"]["config"].as_object_mut().expect("a configuration");
        config.retain(|field, _| {
            ["patchSize", "scaleFactor", "seed", "terrainScale"].contains(&field.as_str())
        });
    }
    scene
}

/// A player of a scene, whose first frame at a time is drawn.
fn player(scene: &Value, seconds: f32) -> Player {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let file = SceneFile::from_json(&scene.to_string()).expect("valid");
    let loaded =
        file.load(&|name| std::fs::read(folder.join(name)), &relievo_samples::Samples).expect("valid");
    let rendering = Rendering {
        size: SIZE.map(|edge| 2 * edge),
        samples: 1,
        quality: loaded.file().quality(),
        ..Rendering::default()
    };
    let world = loaded.build(&gpu()).expect("built");
    let mut player = Player::new(world, rendering).expect("prepared");
    player.frame(seconds).expect("drawn");
    player
}

fn picture(player: &Player) -> RgbaImage {
    resize(&player.picture().expect("read"), SIZE[0], SIZE[1], FilterType::Triangle)
}

#[test]
fn scenes_of_files_equal_their_goldens() {
    let wrong: Vec<String> = (PICTURES.iter())
        .filter_map(|(name, file, seconds)| {
            let actual = picture(&player(&scene_of(name, file), *seconds));
            let compared = check_golden(name, &actual, Tolerance::IMAGE);
            compared.map(|difference| println!("{name}: {difference:?}")).err()
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// How a picture differs from a golden.
fn difference(name: &str, actual: &RgbaImage) -> Difference {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("goldens").join(format!("{name}.png"));
    let golden = relievo_testing::picture(path).into_rgba8();
    Difference::of_golden(actual, &golden, Tolerance::IMAGE.levels)
}

/// A creature that is missing is missed: the one in front is hidden, and nothing else is changed.
#[test]
fn a_creature_that_is_missing_is_seen() {
    let mut player = player(&scene_of(NEAR, "herd.json"), 2.5);
    let with = difference(NEAR, &picture(&player));
    assert!(with.within(Tolerance::IMAGE), "{with:?}");
    let ray = Ray::through(&player.camera(), [92.0, 120.0]).expect("a pixel");
    let world = player.world_mut();
    let hit = world.scene.pick(&ray).expect("a ray").expect("a hit");
    let kind = world.objects.iter().find(|object| object.object == hit.object).map(|object| object.kind);
    assert_eq!(kind, Some(WorldKind::Character));
    world.scene.set_visibility_mask(hit.instance, 0).expect("there");
    player.frame(0.0).expect("drawn");
    let without = difference(NEAR, &picture(&player));
    println!("{with:?} without the creature {without:?}");
    assert!(!without.within(Tolerance::IMAGE), "{without:?}");
}

/// Shadows that are missing are missed.
#[test]
fn a_shadow_that_is_missing_is_seen() {
    let mut scene = scene_of("scene_ruins", "ruins.json");
    let shadow = scene["light"].as_object_mut().and_then(|light| light.remove("shadow"));
    assert!(shadow.is_some(), "the file has a shadow");
    let difference = difference("scene_ruins", &picture(&player(&scene, 0.0)));
    println!("without shadow: {difference:?}");
    assert!(!difference.within(Tolerance::IMAGE), "{difference:?}");
}

/// Ground that lacks any part of its look is missed.
#[test]
fn ground_without_a_part_of_its_look_is_seen() {
    let with = |name: &str, file: &str, change: &dyn Fn(&mut Value)| {
        let mut scene = scene_of(name, file);
        change(&mut scene["terrain"]["config"]);
        difference(name, &picture(&player(&scene, 0.0)))
    };
    let of_zones = |config: &mut Value, field: &str| {
        for zone in config["zones"].as_array_mut().expect("zones") {
            zone.as_object_mut().expect("a zone").remove(field);
        }
    };
    let mut flat = scene_of(RELIEF, "scree.json");
    flat["terrain"].as_object_mut().expect("terrain").remove("relief");
    let flat = difference(RELIEF, &picture(&player(&flat, 0.0)));
    assert!(!flat.within(Tolerance::IMAGE), "without relief: {flat:?}");
    let same = with(WALK, "walk.json", &|_| ());
    assert!(same.within(Tolerance::IMAGE), "{same:?}");
    for (what, found) in [
        ("slopes", with(WALK, "walk.json", &|config| of_zones(config, "slope"))),
        ("height maps", with(WALK, "walk.json", &|config| of_zones(config, "heightBlend"))),
        ("repeats", with(WALK, "walk.json", &|config| of_zones(config, "repeats"))),
        ("triplanar", with(WALK, "walk.json", &|config| config["triplanar"] = json!(false))),
        ("variation", with(FAR, "overlook.json", &|config| config["variation"] = json!(0))),
        ("smooth", with(FAR, "overlook.json", &|config| config["interpolation"] = json!("linear"))),
    ] {
        println!("without {what}: {found:?}");
        assert!(!found.within(Tolerance::IMAGE), "without {what}: {found:?}");
    }
}
