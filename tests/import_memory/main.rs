//! What an import allocates: never more than the document's bytes account for, whatever its counts say; and documents
//! that are damaged anywhere are read or refused.

mod packages;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../animation/scene.rs"]
mod scene;

use std::io::Cursor;
use std::path::Path;
use std::sync::{Mutex, MutexGuard};

use peak_alloc::PeakAlloc;
use relievo::InputError;
use relievo::asset::Model;
use serde_json::{Value, json};

use scene::Scene;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What small documents may take at most.
const SMALL: usize = 24 << 20;

/// The allocator counts all threads, so one test runs at a time.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// The outcome, and the most bytes that were allocated at once on the way.
fn import(bytes: &[u8], folder: Option<&Path>) -> (Result<Model, InputError>, usize) {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let outcome = Model::from_gltf(bytes, folder);
    (outcome, MEMORY.peak_usage().saturating_sub(before))
}

fn refused(scene: &Scene, field: &str) {
    let bytes = scene.gltf();
    let (outcome, peak) = import(&bytes, None);
    let error = outcome.err().unwrap_or_else(|| panic!("{field} is accepted, with {peak} bytes"));
    assert_eq!(error.path, field, "{error}");
    assert!(peak < 1 << 20, "{field}: {peak} bytes for {}", bytes.len());
}

fn texture(size: [u32; 2]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = image::GrayImage::new(size[0], size[1]);
    image::DynamicImage::ImageLuma8(image).write_to(&mut bytes, image::ImageFormat::Png).expect("encoded");
    bytes.into_inner()
}

/// Two joints, a skinned mesh with everything that a mesh may have, a rigid one, keys of all kinds, two scenes.
fn full() -> Scene {
    let mut scene = Scene::of_two_bones();
    let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
    scene.json["accessors"][positions]["max"] = json!([1, 1, 0]);
    let normals = scene.floats("VEC3", &[0.0, 0.0, 1.0].repeat(4));
    let uv = scene.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let weights = scene.floats("VEC4", &[0.5, 0.5, 0.0, 0.0].repeat(4));
    let joints = scene.integers("VEC4", 1, &[0, 1, 0, 0].repeat(4));
    let indices = scene.integers("SCALAR", 2, &[0, 1, 2, 1, 3, 2]);
    let (at, value) = (scene.view(&[2]), scene.view(&1.0_f32.to_le_bytes().repeat(3)));
    let delta = scene.push(
        "accessors",
        json!({"componentType": 5126, "type": "VEC3", "count": 4, "sparse": {
            "count": 1, "indices": {"bufferView": at, "componentType": 5121}, "values": {"bufferView": value}}}),
    );
    let binds = scene.floats("MAT4", &glam::Mat4::IDENTITY.to_cols_array().repeat(2));
    scene.json["skins"][0]["inverseBindMatrices"] = json!(binds);
    let image = scene.view(&texture([4, 4]));
    scene.json["images"] = json!([{"bufferView": image, "mimeType": "image/png"}]);
    scene.json["samplers"] = json!([{"magFilter": 9728}]);
    scene.json["textures"] = json!([{"source": 0, "sampler": 0}]);
    scene.json["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    let rigid = json!({"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uv});
    let mut skinned = rigid.clone();
    (skinned["JOINTS_0"], skinned["WEIGHTS_0"]) = (json!(joints), json!(weights));
    scene.json["meshes"] = json!([
        {"primitives": [{"attributes": skinned, "indices": indices, "targets": [{"POSITION": delta}], "material": 0}],
            "weights": [0.5]},
        {"primitives": [{"attributes": rigid, "mode": 5}]},
    ]);
    scene.push("nodes", json!({"mesh": 0, "skin": 0}));
    scene.push("nodes", json!({"mesh": 1, "scale": [2, 2, 2], "children": [4]}));
    scene.push("nodes", json!({"mesh": 1, "translation": [1, 0, 0]}));
    scene.json["scenes"] = json!([{"nodes": [0, 2, 3]}, {"nodes": []}]);
    scene.json["scene"] = json!(0);
    let times = scene.floats("SCALAR", &[0.0, 1.0]);
    let turns = scene.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    let places = scene.floats("VEC3", &[0.5; 18]);
    let shares = scene.floats("SCALAR", &[0.0, 1.0]);
    scene.push(
        "animations",
        json!({
            "samplers": [{"input": times, "output": turns}, {"input": times, "output": shares},
                {"input": times, "output": places, "interpolation": "CUBICSPLINE"}],
            "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}},
                {"sampler": 1, "target": {"node": 2, "path": "weights"}},
                {"sampler": 2, "target": {"node": 4, "path": "translation"}}],
        }),
    );
    scene
}

/// An accessor of zeros without a buffer view, of which one is said to be another.
fn zeros(scene: &mut Scene, kind: &str, count: u64) -> usize {
    let (at, value) = (scene.view(&[0, 0]), scene.view(&[0; 128]));
    scene.push(
        "accessors",
        json!({"componentType": 5126, "type": kind, "count": count, "sparse": {
            "count": 1, "indices": {"bufferView": at, "componentType": 5121}, "values": {"bufferView": value}}}),
    )
}

#[test]
fn the_full_document_is_right() {
    let _alone = alone();
    let (model, peak) = import(&full().gltf(), None);
    let model = model.expect("valid");
    assert_eq!((model.meshes.len(), model.clips.len(), model.images.len()), (3, 1, 1));
    assert!(peak < 1 << 20, "{peak}");
}

/// An accessor of some hundred bytes that claims 80 million vectors of zeros; the count is checked before
/// anything is allocated.
#[test]
fn zeros_are_counted_before_they_are_made() {
    let _alone = alone();
    for count in [80_000_000, 1 << 33, u64::MAX] {
        for (kind, place) in [
            ("VEC3", "/meshes/0/primitives/0/attributes/POSITION"),
            ("VEC3", "/meshes/0/primitives/0/attributes/NORMAL"),
            ("VEC2", "/meshes/0/primitives/0/attributes/TEXCOORD_0"),
            ("VEC4", "/meshes/0/primitives/0/attributes/WEIGHTS_0"),
            ("VEC3", "/meshes/0/primitives/0/targets/0/POSITION"),
            ("MAT4", "/skins/0/inverseBindMatrices"),
            ("SCALAR", "/animations/0/samplers/0/input"),
            ("VEC4", "/animations/0/samplers/0/output"),
            ("SCALAR", "/animations/0/samplers/1/output"),
            ("VEC3", "/animations/0/samplers/2/output"),
        ] {
            let mut scene = full();
            let accessor = zeros(&mut scene, kind, count);
            (scene.json["accessors"][accessor]["min"], scene.json["accessors"][accessor]["max"]) =
                (json!([0, 0, 0]), json!([1, 1, 0]));
            *scene.json.pointer_mut(place).expect("there") = json!(accessor);
            refused(&scene, &format!("accessors[{accessor}].count"));
            // The same without anything sparse.
            scene.json["accessors"][accessor].as_object_mut().expect("an object").remove("sparse");
            refused(&scene, &format!("accessors[{accessor}].count"));
            // And with the bytes of a view that has too few.
            scene.json["accessors"][accessor]["bufferView"] = json!(0);
            refused(&scene, &format!("accessors[{accessor}].count"));
        }
    }
    // As many as glTF may need stay.
    let mut scene = full();
    let accessor = zeros(&mut scene, "VEC3", 4);
    scene.json["accessors"][accessor].as_object_mut().expect("an object").remove("sparse");
    scene.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = json!(accessor);
    let model = import(&scene.gltf(), None).0.expect("valid");
    assert!(model.meshes[0].targets[0].vertices.is_empty());
}

/// The same bytes used repeatedly: instances of a mesh, primitives, targets, keys, tracks, buffers, images.
#[test]
fn what_is_repeated_is_counted_too() {
    let _alone = alone();
    let repeated = |change: &dyn Fn(&mut Scene)| {
        let mut scene = full();
        change(&mut scene);
        let bytes = scene.gltf();
        let (outcome, peak) = import(&bytes, None);
        // 128 elements a byte, of some 20 bytes each, may be repeated.
        let most = SMALL.max(2600 * bytes.len());
        assert!(peak < most, "{peak} bytes for {}", bytes.len());
        (outcome, peak)
    };
    let large = |scene: &mut Scene, count: usize| {
        let accessor = scene.push(
            "accessors",
            json!({"componentType": 5126, "type": "VEC3", "count": count, "min": [0, 0, 0], "max": [0, 0, 0]}),
        );
        let primitive = json!({"attributes": {"POSITION": accessor}});
        scene.json["meshes"].as_array_mut().expect("a list").push(json!({"primitives": [primitive]}));
        (accessor, scene.json["meshes"].as_array().expect("a list").len() - 1)
    };
    // Of 60,000 zeros each, which one alone may have.
    let (instances, _) = repeated(&|scene| {
        let (_, mesh) = large(scene, 60_000);
        let nodes: Vec<usize> = (0..1000).map(|_| scene.push("nodes", json!({"mesh": mesh}))).collect();
        scene.json["scenes"][0]["nodes"] = json!(nodes);
    });
    assert!(instances.is_err());
    assert!(repeated(&|scene| _ = large(scene, 60_000)).0.is_ok());
    let (primitives, _) = repeated(&|scene| {
        let (accessor, mesh) = large(scene, 60_000);
        let primitive = json!({"attributes": {"POSITION": accessor}});
        scene.json["meshes"][mesh]["primitives"] = json!(vec![primitive; 300]);
        scene.json["nodes"][4]["mesh"] = json!(mesh);
    });
    assert!(primitives.is_err());
    let (targets, _) = repeated(&|scene| {
        let (accessor, mesh) = large(scene, 30_000);
        let (at, value) = (scene.view(&[0, 0, 1, 0]), scene.view(&1.0_f32.to_le_bytes().repeat(6)));
        let sparse = scene.push("accessors", json!({"componentType": 5126, "type": "VEC3", "count": 30_000, "sparse": {
            "count": 2, "indices": {"bufferView": at, "componentType": 5123}, "values": {"bufferView": value}}}));
        let targets = vec![json!({"POSITION": sparse, "NORMAL": sparse}); 500];
        scene.json["meshes"][mesh]["primitives"] =
            json!([{"attributes": {"POSITION": accessor}, "targets": targets}]);
        scene.json["nodes"][4]["mesh"] = json!(mesh);
    });
    assert!(targets.is_err());
    let (keys, _) = repeated(&|scene| {
        let times =
            scene.push("accessors", json!({"componentType": 5126, "type": "SCALAR", "count": 60_000}));
        let values = scene.push("accessors", json!({"componentType": 5126, "type": "VEC3", "count": 60_000}));
        let animation = json!({"samplers": [{"input": times, "output": values}],
            "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]});
        scene.json["animations"] = json!(vec![animation; 500]);
    });
    assert!(keys.is_err());
    let (tracks, _) = repeated(&|scene| {
        let first = scene.json["nodes"].as_array().expect("a list").len();
        (0..3000).for_each(|_| _ = scene.push("nodes", json!({})));
        let joints: Vec<usize> = (first..first + 3000).collect();
        scene.push("skins", json!({"joints": joints}));
        scene.json["scenes"][0]["nodes"] = json!([&[0, 2, 3][..], &joints].concat());
        scene.json["animations"] = json!(vec![json!({"samplers": [], "channels": []}); 3000]);
    });
    assert!(tracks.is_err());
}

#[test]
fn images_are_counted_before_they_are_decoded() {
    let _alone = alone();
    // A header that lies, in a file of 70 bytes.
    let mut scene = full();
    let mut png = texture([4, 4]);
    png[16..24].copy_from_slice(&[0, 0, 0x20, 0, 0, 0, 0x20, 0]);
    let crc = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&crc.to_be_bytes());
    let view = scene.view(&png);
    scene.json["images"][0]["bufferView"] = json!(view);
    refused(&scene, "images[0]");
    // Images of one view, of 4 million texels each.
    let mut scene = full();
    let view = scene.view(&texture([2048, 2048]));
    scene.json["images"] = json!(vec![json!({"bufferView": view, "mimeType": "image/png"}); 40]);
    let textures: Vec<Value> = (0..40).map(|image| json!({"source": image})).collect();
    scene.json["textures"] = json!(textures);
    let material = |at| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": at}}});
    scene.json["materials"] = (0..40).map(material).collect();
    let attributes = scene.json["meshes"][1]["primitives"][0]["attributes"].clone();
    let primitive = |at| json!({"attributes": attributes, "mode": 5, "material": at});
    scene.json["meshes"][1]["primitives"] = (0..40).map(primitive).collect();
    let (outcome, peak) = import(&scene.gltf(), None);
    let error = outcome.expect_err("too many");
    assert!(error.bound.contains("texels") && error.path.starts_with("images["), "{error}");
    assert!(peak < 128 << 20, "{peak}");
}

fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

/// One file beside the document, named by many buffers in several ways.
#[test]
fn files_are_read_once() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("zeros.bin"), vec![0; 1 << 20]).expect("writable");
    let mut scene = Scene::new();
    scene.json["skins"] = json!([]);
    let mut animations = Vec::new();
    let mut buffers = Vec::new();
    for at in 0..200 {
        let uri = ["zeros.bin", "./zeros.bin", "%7Aeros.bin"][at % 3];
        buffers.push(json!({"byteLength": 1 << 20, "uri": uri}));
        let view = scene.push("bufferViews", json!({"buffer": at, "byteLength": 16}));
        let times = scene.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5126, "type": "SCALAR", "count": 1}),
        );
        let values = scene.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5126, "type": "VEC3", "count": 1}),
        );
        animations.push(json!({"samplers": [{"input": times, "output": values}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}));
    }
    scene.push("nodes", json!({}));
    (scene.json["buffers"], scene.json["animations"]) = (json!(buffers), json!(animations));
    let (model, peak) = import(&scene.gltf(), Some(folder.path()));
    assert_eq!(model.expect("valid").clips.len(), 200);
    assert!(peak < 16 << 20, "{peak}");
}

fn collect(value: &Value, pointer: String, numbers: &mut Vec<String>) {
    match value {
        Value::Object(object) => {
            object.iter().for_each(|(key, value)| collect(value, format!("{pointer}/{key}"), numbers));
        }
        Value::Array(array) => {
            (array.iter().enumerate())
                .for_each(|(at, value)| collect(value, format!("{pointer}/{at}"), numbers));
        }
        Value::Number(_) => numbers.push(pointer),
        _ => {}
    }
}

/// Every number of the document replaced, every kind of byte: an error or a model, in little memory.
#[test]
fn damaged_documents_allocate_little() {
    let _alone = alone();
    let mut numbers = Vec::new();
    collect(&full().json, String::new(), &mut numbers);
    let (mut read, mut failed, mut largest) = (0, 0, 0);
    let mut look = |bytes: &[u8], what: &str| {
        let (outcome, peak) = import(bytes, None);
        match outcome {
            Ok(model) => {
                assert!(model.meshes.iter().all(|mesh| mesh.validate(&model.skins) == Ok(())), "{what}");
                read += 1;
            }
            Err(_) => failed += 1,
        }
        assert!(peak < SMALL, "{what}: {peak} bytes for {}", bytes.len());
        largest = largest.max(peak);
    };
    for pointer in &numbers {
        for value in [0, 1, 3, 255, 65_535, 65_536, 1 << 24, u64::from(u32::MAX), 1 << 53] {
            let mut scene = full();
            *scene.json.pointer_mut(pointer).expect("collected") = json!(value);
            look(&scene.gltf(), &format!("{pointer} = {value}"));
        }
    }
    let glb = full().glb();
    let mut state = 1_u32;
    let mut random = |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below
    };
    for case in 0..600 {
        let mut damaged = glb.clone();
        for _ in 0..=case % 5 {
            damaged[random(glb.len())] = random(256) as u8;
        }
        if case % 7 == 0 {
            damaged.truncate(random(glb.len()));
        }
        look(&damaged, &format!("case {case}"));
    }
    assert!(numbers.len() > 130 && read > 300 && failed > 300, "{} {read} {failed}", numbers.len());
    println!("{read} read, {failed} refused, at most {largest} bytes");
}

/// What OBJ takes at most for each byte of the file: a mesh a face, whose name takes a letter, is the worst.
const OBJ: usize = 200;

#[test]
fn obj_takes_memory_for_its_bytes() {
    let _alone = alone();
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 1 0\n";
    let lines = |line: fn(usize) -> String| -> String { (0..20_000).map(line).collect() };
    let texts = [
        lines(|_| "f 1 2 3\n".to_owned()),
        lines(|at| format!("f 1/{}/1 2/1/{} 3/2/2\n", 1 + at % 2, 1 + at / 2 % 2)),
        lines(|_| "v 1 1 1\n".to_owned()) + "f -1 -2 -3\n",
        lines(|_| "v 1 1 1\nvt 0 0\nf -1/-1 -2/-1 -3/-1\n".to_owned()),
        format!("f {}\n", lines(|at| format!("{} ", 1 + at % 4))),
        lines(|at| format!("g {at}\nf 1 2 3\n")),
        lines(|at| format!("usemtl {at}\n")) + "f 1 2 3\n",
        lines(|at| format!("g {at}\n")) + "f 1 2 3\n",
        lines(|_| "\\\n".to_owned()) + "f 1 2 3\n",
    ];
    for text in texts {
        let bytes = (start.to_owned() + &text).into_bytes();
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let outcome = Model::from_obj(&bytes, None).map(|_| ());
        let peak = MEMORY.peak_usage().saturating_sub(before);
        let shown = &text[..30.min(text.len())];
        assert!(peak < OBJ * bytes.len(), "{shown:?}: {peak} bytes for {}, {outcome:?}", bytes.len());
    }
}

/// Compressed meshes whose bytes or counts are damaged take what any document of their size may take.
#[test]
fn damaged_compression_allocates_little() {
    let _alone = alone();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/truth/files");
    for name in ["draco.glb", "sequential.glb", "meshopt.glb"] {
        let whole = std::fs::read(folder.join(name)).expect("there");
        let length = u32::from_le_bytes(whole[12..16].try_into().expect("four bytes")) as usize;
        let mut json: Value = serde_json::from_slice(&whole[20..20 + length]).expect("JSON");
        let buffer = whole[28 + length..].to_vec();
        json["buffers"][0]["uri"] = json!("a.bin");
        // 128 elements a byte, of some 20 bytes each.
        let most = SMALL.max(2600 * whole.len());
        let (mut read, mut failed, mut largest) = (0, 0, 0);
        let mut look = |json: &Value, buffer: &[u8], what: &str| {
            let bytes = serde_json::to_vec(json).expect("JSON");
            let before = MEMORY.current_usage();
            MEMORY.reset_peak_usage();
            let outcome = Model::from_gltf_beside(&bytes, &|_| Ok(buffer.to_vec()));
            let peak = MEMORY.peak_usage().saturating_sub(before);
            assert!(peak < most, "{name}, {what}: {peak} bytes");
            largest = largest.max(peak);
            if outcome.is_ok() { read += 1 } else { failed += 1 }
        };
        look(&json, &buffer, "whole");
        // The first bytes of each view, where counts stand, and some others.
        for view in json["bufferViews"].as_array().expect("a list") {
            let place = view.pointer("/extensions/EXT_meshopt_compression").unwrap_or(view);
            let first = place["byteOffset"].as_u64().unwrap_or(0) as usize;
            let count = place["byteLength"].as_u64().expect("a length") as usize;
            for at in (0..count.min(40)).chain((40..count).step_by(97)) {
                for byte in [0, 0x7f, 0xff] {
                    let mut changed = buffer.clone();
                    changed[first + at] = byte;
                    look(&json, &changed, &format!("{byte} at {}", first + at));
                }
            }
        }
        let mut numbers = Vec::new();
        collect(&json["bufferViews"], "/bufferViews".to_owned(), &mut numbers);
        collect(&json["meshes"], "/meshes".to_owned(), &mut numbers);
        for pointer in &numbers {
            for value in [0, 3, 256, 99_999, 1 << 24, 1_u64 << 40] {
                let mut changed = json.clone();
                *changed.pointer_mut(pointer).expect("collected") = json!(value);
                look(&changed, &buffer, &format!("{value} at {pointer}"));
            }
        }
        println!("{name}: {read} read, {failed} refused, at most {largest} bytes");
        assert!(read > 50 && failed > 50, "{name}: {read} read, {failed} refused");
    }
}
