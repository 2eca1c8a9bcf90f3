//! Every mistake in a scene file is refused with its path, and nothing is written.

use serde_json::Value;

use crate::assert_refused;
use crate::scene_file::{Folder, good};

/// Endless terrain.
const ENDLESS: &str = r#"{"config": {"patchSize": 65, "scaleFactor": 9, "seed": "good"}, "endless": true}"#;

/// Endless terrain whose view is farther than its coarsest nodes reach.
const ENDLESS_FAR: &str =
    r#"{"config": {"patchSize": 65, "scaleFactor": 9, "seed": "far"}, "endless": true, "view": 1000}"#;

/// Endless terrain with a hole that is none.
const ENDLESS_HOLE: &str = r#"{"config": {"patchSize": 65, "scaleFactor": 9, "seed": "hole"}, "endless": true,
    "holes": [{"at": [1, 2], "radius": 0}]}"#;

/// Endless terrain with holes of two kinds at once.
const ENDLESS_HOLES: &str = r#"{"config": {"patchSize": 65, "scaleFactor": 9, "seed": "hole"}, "endless": true,
    "holes": [{"image": "mask.png", "radius": 2}]}"#;
const ENDLESS_FIRST: &str = r#"{"config": {"patchSize": 65, "scaleFactor": 9, "seed": "hole"}, "endless": true,
    "holes": [{"at": [1, 2], "radius": 3, "first": [1, 2]}]}"#;

/// Endless terrain with an elevation map whose margin is none.
const ELEVATION: &str = r#"{"config": {"patchSize": 65, "scaleFactor": 9, "seed": "e", "coarseLevels": 1}, "endless": true,
    "elevation": {"file": "map.png", "range": [-20, 20], "spacing": 8, "first": [-3, 4], "margin": -2}}"#;

/// Mistakes: the place in the good scene, the JSON that comes there (`null` removes what is there; see [`value`]), and the
/// path with the value and some words of the message.
const MISTAKES: &[(&str, &str, &str, &str)] = &[
    // Fields.
    ("/typo", "1", "typo = 1", "terrain, meshes, characters"),
    ("/meshes/0/instance", "[]", "meshes[0].instance = []", "is no field here"),
    ("/meshes/0/clip", r#""walk""#, "meshes[0].clip = walk", "is no field here"),
    ("/meshes/0/instances/0/clip", "0", "meshes[0].instances[0].clip = 0", "is no field here"),
    ("/characters/0/scatter/seeds", r#""""#, "characters[0].scatter.seeds", "count, seed, area"),
    ("/camera/path/1/fovy", "1", "camera.path[1].fovy = 1", "time, at, look, fov"),
    // What is missing.
    ("/camera", "null", "camera = missing", "where the scene is seen from"),
    ("/meshes/0/file", "null", "meshes[0].file = missing", ".glb, .gltf, .obj or .rlv"),
    ("/meshes/0/instances", "null", "meshes[0].instances = missing", "or scatter"),
    ("/meshes/0/instances/1/at", "null", "meshes[0].instances[1].at = missing", "or on"),
    ("/characters/0/scatter/seed", "null", "characters[0].scatter.seed = missing", "any text"),
    ("/terrain/config", "null", "terrain.config = missing", "relievo terrain"),
    ("/camera/path/0/look", "null", "camera.path[0].look = missing", "where it looks"),
    ("/meshes/1/material/relief", "null", "meshes[1].material.relief = missing", "heights"),
    // Types.
    ("/terrain", "[]", "terrain = []", "must be an object"),
    ("/terrain/config", r#""file.json""#, "terrain.config = file.json", "must be an object"),
    ("/meshes", "{}", "meshes = {}", "must be a list"),
    ("/meshes/0", r#""still.glb""#, "meshes[0] = still.glb", "must be an object"),
    ("/meshes/0/file", "7", "meshes[0].file = 7", "must be a string"),
    ("/characters/0/scatter/count", r#""2""#, "characters[0].scatter.count = 2", "whole number"),
    ("/characters/0/scatter/count", "2.5", "characters[0].scatter.count = 2.5", "whole number"),
    ("/light/shadow", "1", "light.shadow = 1", "true, false, or an object"),
    ("/light/shadow/size", "2.5", "light.shadow.size = 2.5", "whole number"),
    ("/light/shadow/texels", "512", "light.shadow.texels = 512", "size, range"),
    ("/camera/path/0/at", "[1, 2]", "camera.path[0].at = [1,2]", "3 numbers"),
    ("/camera/path/0/at", r#"[1, "2", 3]"#, "camera.path[0].at[1] = 2", "must be a number"),
    ("/terrain/patches/1", "[0, 0.5]", "terrain.patches[1][1] = 0.5", "whole number"),
    // Ranges.
    ("/terrain/config/hydraulic", r#"{"rain": 2}"#, "terrain.config.hydraulic.rain = 2", "0..=1"),
    ("/terrain/config/thermalAfter", "{}", "terrain.config.thermalAfter = {}", "iterations"),
    ("/terrain/config/variation", r#""a""#, "terrain.config.variation = a", "must be a number"),
    ("/terrain/config/hue", "3", "terrain.config.hue = 3", "unknown field"),
    ("/terrain/config/patchSize", "18", "terrain.config.patchSize = 18", "2^n + 1"),
    ("/terrain/config/zones", "[]", "terrain.config.zones", "1 to 32"),
    ("/terrain/relief", r#"{"distance": 9}"#, "terrain.relief.depth = missing", "lowest texel"),
    ("/terrain/relief", r#"{"depth": 0, "distance": 9}"#, "terrain.relief.depth = 0", "0.000001"),
    (
        "/terrain/relief",
        r#"{"depth": 1, "distance": 9, "steps": 3}"#,
        "terrain.relief.steps",
        "depth, distance",
    ),
    ("/terrain/patches", "[]", "terrain.patches.len = 0", "1..=4096"),
    ("/terrain/patches", "LONG", "terrain.patches.len = 4097", "1..=4096"),
    ("/terrain/patches/1", "[0, 0]", "terrain.patches[1] = [0, 0]", "listed before"),
    ("/terrain/endless", "1", "terrain.endless = 1", "true or false"),
    ("/terrain/endless", "true", "terrain.patches", "where terrain is endless"),
    ("/terrain/view", "100", "terrain.endless = missing", "view distance"),
    ("/terrain/view", "0", "terrain.view = 0", "0.001..="),
    ("/terrain/holes", "[]", "terrain.endless = missing", "holes"),
    ("/terrain/features", r#"["gone.json"]"#, "terrain.features[0] = gone.json", "cannot be read"),
    ("/terrain/featureMode", "\"add\"", "terrain.featureMode = add", "keep"),
    ("/terrain/elevation", "{}", "terrain.endless = missing", "elevation map"),
    ("/terrain", ENDLESS_HOLES, "terrain.holes[0].radius = 2", "beside image"),
    ("/terrain", ENDLESS_FIRST, "terrain.holes[0].first = [1,2]", "beside image only"),
    ("/terrain", ELEVATION, "terrain.elevation.margin = -2", "0..="),
    ("/terrain", ENDLESS_FAR, "terrain.view = 1000", "coarseLevels"),
    ("/terrain", ENDLESS, "meshes[1].scatter.area = missing", "terrain is endless"),
    ("/terrain", ENDLESS_HOLE, "terrain.holes[0].radius = 0", "0.001..="),
    ("/terrain/patches/1", "[600000, 0]", "terrain.patches[1] = 600000", "i32"),
    ("/meshes/0/instances/0/scale", "0", "meshes[0].instances[0].scale = 0", "1e-6"),
    ("/meshes/0/instances/0/scale", "[1, 2, 1e9]", "meshes[0].instances[0].scale[2]", "1000000"),
    ("/meshes/0/instances/0/turn", "[0, 0, 0, 0]", "meshes[0].instances[0].turn", "not be 0"),
    ("/meshes/0/instances/1/at", "[1, 2e9, 3]", "meshes[0].instances[1].at[1]", "1000000000"),
    ("/meshes/1/material/scale", "1.5", "meshes[1].material.scale = 1.5", "0..=1"),
    ("/meshes/0/transition", r#""soft""#, "meshes[0].transition = soft", "geomorph"),
    ("/meshes/1/transition", r#""geomorph""#, "meshes[1].transition = geomorph", "must be hard"),
    ("/quality/transition", "1", "quality.transition = 1", "geomorph"),
    ("/meshes/1/material/method", r#""best""#, "meshes[1].material.method = best", "quadtree"),
    ("/meshes/1/material/shadow", r#""long""#, "meshes[1].material.shadow = long", "soft"),
    ("/characters/0/rate", "1e6", "characters[0].rate = 1000000", "100"),
    ("/characters/0/wrap", r#""bounce""#, "characters[0].wrap = bounce", "clamp"),
    ("/characters/0/scatter/scale", "[2, 1]", "characters[0].scatter.scale", "smaller scale first"),
    ("/characters/0/scatter/area", "[[5, 5], [1, 9]]", "characters[0].scatter.area", "smaller x"),
    ("/characters/0/gate", r#""random""#, "characters[0].gate = random", "an object with a mode"),
    ("/characters/0/gate", r#"{"mode": "uniform"}"#, "characters[0].gate.range = missing", "two distances"),
    (
        "/characters/0/gate",
        r#"{"mode": "uniform", "range": [9, 2]}"#,
        "characters[0].gate.range = [9,2]",
        "smaller",
    ),
    (
        "/characters/0/gate",
        r#"{"mode": "budget", "range": [1, 2]}"#,
        "characters[0].gate.range = [1,2]",
        "mode, bones",
    ),
    ("/characters/0/gate", r#"{"mode": "budget", "bones": -1}"#, "characters[0].gate.bones = -1", "0..="),
    (
        "/characters/0/gate",
        r#"{"mode": "skip-period", "range": [1, 2], "weights": [1, 1, 0, 0, 0, 0]}"#,
        "characters[0].gate.weights = [1,1,0,0,0,0]",
        "sum to 1",
    ),
    (
        "/characters/0/gate",
        r#"{"mode": "skip-period", "range": [1, 2], "period": 0}"#,
        "characters[0].gate.period = 0",
        "0.001..=65535",
    ),
    ("/characters/0/influences", r#"{"most": 9}"#, "characters[0].influences.most = 9", "1..=8"),
    ("/characters/0/influences", r#""few""#, "characters[0].influences = few", "most or fade"),
    (
        "/characters/0/influences",
        r#"{"most": 2, "fade": [1, 2]}"#,
        "characters[0].influences.fade",
        "beside most",
    ),
    ("/characters/0/priorities", "[]", "characters[0].priorities = []", "must be an object"),
    ("/characters/0/priorities", r#"{"hand": 2}"#, "characters[0].priorities.hand = 2", "0..=1"),
    (
        "/characters/0/priorities",
        r#"{"nobody": 1}"#,
        "characters[0].priorities.nobody = nobody",
        "an index below",
    ),
    ("/characters/0/tiers", "[0.5, 0.25, 0.2, 0.1]", "characters[0].tiers.len = 4", "0..=3"),
    ("/characters/0/tiers", "[0.5, 0.5]", "characters[0].tiers[1].bones = 0.5", "below 0.5"),
    (
        "/characters/0/tiers",
        r#"[{"rigid": true}]"#,
        "characters[0].tiers[0].bones = missing",
        "fraction of bones",
    ),
    ("/meshes/0/tiers", "[0.5]", "meshes[0].tiers = [0.5]", "is no field here"),
    ("/light/direction", "[0, 0, 0]", "light.direction = [0,0,0]", "towards the light"),
    ("/light/shadow/size", "8", "light.shadow.size = 8", "16..=8192"),
    ("/light/shadow/range", "0", "light.shadow.range = 0", "0.001..="),
    ("/light/shadow/range", "0.1", "light.shadow.range = 0.1", "beyond the camera's near"),
    ("/light/ambient", "1.5", "light.ambient = 1.5", "0..=1"),
    ("/quality/pixels", "-1", "quality.pixels = -1", "0..="),
    ("/background", "[0, 0, 2]", "background[2] = 2", "0..=1"),
    ("/camera/fov", "3.2", "camera.fov = 3.2", "3.1"),
    ("/camera/near", "0", "camera.near = 0", "0.0001"),
    ("/camera/far", "0.05", "camera.far = 0.05", "beyond near"),
    ("/camera/at", "[0, 0, 0]", "camera.at", "beside path"),
    ("/camera/path", "[]", "camera.path.len = 0", "1..=4096"),
    ("/camera/path/1/time", "0", "camera.path[1].time = 0", "later than 0"),
    ("/camera/path/0/look", "[10, 8, 30]", "camera.path[0].look", "apart from at"),
    // Levels of detail.
    (
        "/meshes/0/transition",
        r#"{"seconds": 1}"#,
        "meshes[0].transition.kind = missing",
        "name of the transition",
    ),
    (
        "/meshes/0/transition",
        r#"{"kind": "dither", "seconds": 0}"#,
        "meshes[0].transition.seconds = 0",
        "0.001",
    ),
    ("/meshes/0/transition", r#"{"kind": "dither", "band": 1}"#, "meshes[0].transition.band = 1", "0.999"),
    (
        "/meshes/0/transition",
        r#"{"kind": "fade_in", "band": 0.1, "seconds": 1}"#,
        "meshes[0].transition",
        "not both",
    ),
    (
        "/meshes/0/transition",
        r#"{"kind": "hard", "seconds": 1}"#,
        "meshes[0].transition.kind = hard",
        "must be a fade",
    ),
    (
        "/meshes/0/transition",
        r#"{"kind": "alpha", "opaque": 6}"#,
        "meshes[0].transition.gone = missing",
        "fades",
    ),
    (
        "/meshes/0/transition",
        r#"{"kind": "alpha", "opaque": 6, "gone": 9}"#,
        "meshes[0].transition = alpha",
        "criterion",
    ),
    ("/meshes/0/lod", r#"{"criterion": "near"}"#, "meshes[0].lod.criterion = near", "magnification"),
    ("/meshes/0/lod", r#"{"criterion": "distance"}"#, "meshes[0].lod.from = missing", "distances"),
    ("/meshes/0/lod", r#"{"criterion": "distance", "from": []}"#, "meshes[0].lod.from.len = 0", "1..=7"),
    ("/meshes/0/lod", r#"{"criterion": "distance", "from": [-1]}"#, "meshes[0].lod.from[0] = -1", "0..="),
    (
        "/meshes/0/lod",
        r#"{"criterion": "distance", "from": [9], "of": "box"}"#,
        "meshes[0].lod.of = box",
        "distance",
    ),
    (
        "/meshes/0/lod",
        r#"{"criterion": "size", "of": "cube", "below": [1]}"#,
        "meshes[0].lod.of = cube",
        "sphere",
    ),
    ("/meshes/0/lod", r#"{"criterion": "ratio", "near": 5}"#, "meshes[0].lod.far = missing", "distance"),
    (
        "/meshes/0/lod",
        r#"{"criterion": "ratio", "near": 5, "far": 5}"#,
        "meshes[0].lod.far = 5",
        "above near",
    ),
    ("/meshes/0/lod", r#"{"level": 8}"#, "meshes[0].lod.level = 8", "0..=7"),
    ("/meshes/0/lod", r#"{"hysteresis": 1}"#, "meshes[0].lod.hysteresis = 1", "0.999"),
    ("/meshes/0/lod", r#"{"rank": 8}"#, "meshes[0].lod.rank = 8", "0..=7"),
    ("/meshes/0/lod", r#"{"bias": 0}"#, "meshes[0].lod.bias = 0", "0.000001"),
    ("/meshes/0/lod", r#"{"culling": "no"}"#, "meshes[0].lod.culling = no", "frustum"),
    ("/meshes/0/lod", r#"{"speed": 1}"#, "meshes[0].lod.speed = 1", "is no field here"),
    ("/quality/triangles", "0", "quality.triangles = 0", "1..="),
    ("/quality/milliseconds", "0", "quality.milliseconds = 0", "0.001"),
    // Absurd counts.
    ("/meshes/1/scatter/count", "0", "meshes[1].scatter.count = 0", "1..=1048576"),
    ("/meshes/1/scatter/count", "1e12", "meshes[1].scatter.count", "1..=1048576"),
    ("/characters/0/scatter/count", "70000", "characters[0].scatter.count = 70000", "65536"),
    ("/characters", "MANY", "characters.len = 257", "0..=256"),
    ("/terrain", "HUGE", "terrain.patches.len = 5", "heights together"),
    // What cannot be together.
    ("/meshes/0/instances/1/on", "[1, 1]", "meshes[0].instances[1].on = [1,1]", "beside at"),
    ("/meshes/0/instances/1/lift", "1", "meshes[0].instances[1].lift = 1", "beside at"),
    ("/meshes/0/levels", r#"["still.glb", "still.glb"]"#, "meshes[0].levels = ", "beside file"),
    ("/terrain", "null", "meshes[0].instances[0].on = [4, 5]", "no terrain"),
    // Files.
    ("/meshes/0/file", r#""gone.glb""#, "meshes[0].file = gone.glb", "cannot be read"),
    ("/meshes/0/file", r#""cut.glb""#, "meshes[0].file = cut.glb", "GLB"),
    ("/meshes/0/file", r#""cycle.gltf""#, "meshes[0].file = cycle.gltf", "nodes"),
    ("/meshes/0/file", r#""scene.json""#, "meshes[0].file = scene.json", ".glb, .gltf, .obj or .rlv"),
    ("/meshes/0/file", r#""cow.obj""#, "meshes[0].file = cow.obj", "line 2"),
    ("/meshes/0/file", r#""builtin:cow""#, "meshes[0].file = builtin:cow", "creature, rock, wall"),
    ("/meshes/0/file", r#""points.gltf""#, "meshes[0].file = points.gltf", "must have a mesh"),
    ("/characters/0/file", r#""builtin:rock""#, "characters[0].file = builtin:rock", "must have clips"),
    ("/characters/0/file", r#""still.glb""#, "characters[0].file = still.glb", "must have clips"),
    ("/characters/0/clip", r#""fly""#, "characters[0].clip = fly", "wave"),
    ("/characters/0/instances/0/clip", "3", "characters[0].instances[0].clip = 3", "below 2"),
    ("/meshes/1/material/relief", r#""gone.png""#, "meshes[1].material.relief = gone.png", "cannot be read"),
    ("/meshes/1/material/relief", r#""broken.png""#, "meshes[1].material.relief = broken.png", "PNG"),
    ("/meshes/1/material/albedo", r#""wall.bmp""#, "meshes[1].material.albedo = wall.bmp", ".png or .jpg"),
    (
        "/terrain/config/zones",
        r#"[{"min": 0, "max": 1, "texture": "gone.png"}]"#,
        "terrain.config.zones[0].texture = gone.png",
        "cannot be read",
    ),
    (
        "/terrain/target",
        r#"{"patchSize": 33, "scaleFactor": 2, "seed": "cli"}"#,
        "terrain.target.patchSize = 33",
        "must be 17",
    ),
    ("/terrain/target", "3", "terrain.target = 3", "must be an object"),
    ("/terrain/time", "0.5", "terrain.target", "must be given"),
    ("/terrain/time", "2", "terrain.time = 2", "0..=1"),
    // What only the device's heights tell.
    ("/meshes/0/instances/0/on", "[4, 50]", "meshes[0].instances[0].on = [4, 50]", "on a patch"),
    ("/characters/0/scatter/area", "[[50, 50], [60, 60]]", "characters[0].scatter.area", "on the terrain"),
];

/// Five patches that have too many heights together.
const HUGE: &str = r#"{"config": {"patchSize": 4097, "scaleFactor": 2, "seed": "cli"},
    "patches": [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0]]}"#;

/// The value of a JSON text, or of a word for what is too large to be written.
fn value(text: &str) -> Value {
    match text {
        "LONG" => vec![0; 4097].into(),
        "MANY" => vec![1; 257].into(),
        "HUGE" => value(HUGE),
        text => serde_json::from_str(text).expect("JSON"),
    }
}

/// The good scene with a value in another place; `null` removes what is there.
pub fn with(pointer: &str, value: Value) -> String {
    let mut scene = good();
    let (parent, name) = pointer.rsplit_once('/').expect("a pointer");
    match scene.pointer_mut(parent).unwrap_or_else(|| panic!("no {parent}")) {
        Value::Object(fields) if value.is_null() => {
            fields.remove(name);
        }
        Value::Object(fields) => {
            fields.insert(name.to_owned(), value);
        }
        Value::Array(list) => list[name.parse::<usize>().expect("an index")] = value,
        _ => panic!("{parent} holds nothing"),
    }
    scene.to_string()
}

#[test]
fn every_mistake_is_refused_with_its_path_and_nothing_is_written() {
    let folder = Folder::new();
    assert!(MISTAKES.len() > 60);
    for (pointer, text, start, words) in MISTAKES {
        refused(&folder, &with(pointer, value(text)), &[start, words]);
    }
    let twice = good().to_string().replace(r#""ambient":0.3"#, r#""ambient":0.3,"ambient":0.4"#);
    refused(&folder, &twice, &["light.ambient = line 1", "given twice"]);
    let deep = format!("{}{}", "[".repeat(400), "]".repeat(400));
    for (text, words) in
        [("", "scene = "), ("[]", "must be an object"), ("{} {}", "scene = "), (&deep, "scene")]
    {
        refused(&folder, text, &[words]);
    }
    refused(&folder, r#"{"camera": {"at": [0, 1, 5], "look": [0, 0, 0]}}"#, &["scene = empty", "must have"]);
    let ground = r#"{"meshes": [{"file": "still.glb", "scatter": {"count": 1, "seed": "s"}}],
        "camera": {"at": [0, 1, 5], "look": [0, 0, 0]}}"#;
    refused(&folder, ground, &["meshes[0].scatter.area = missing", "no terrain"]);
}

fn refused(folder: &Folder, scene: &str, words: &[&str]) {
    let run = folder.run(scene, &["--size", "16x16"]);
    let start = &scene[..scene.len().min(60)];
    assert_refused(&run, &[start], &[&["scene.json: "][..], words].concat());
    assert!(!folder.path("out").exists(), "{words:?}: something was written");
}
