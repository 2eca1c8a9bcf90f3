//! The scene file that is shown, as JSON, with the changes that the viewer's controls make to it.

use std::path::Path;

use glam::DVec3;
use relievo::InputError;
use relievo::asset::{Light, Model};
use relievo::scene::Quality;
use relievo_delivery::file_names::{each_file_name, models_mut};
use relievo_scene_file::SceneFile;
use serde_json::{Map, Value, json};

/// Extensions of files with a model.
const MODELS: [&str; 4] = ["glb", "gltf", "obj", "rlv"];

/// What a file contains, as its name and its first bytes tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// A scene file.
    Scene,
    /// A model: glTF, Wavefront OBJ, or a package.
    Model,
    /// A configuration of terrain.
    Terrain,
}

impl Content {
    /// What a file contains.
    ///
    /// # Errors
    /// [`InputError`] for a file that is none of these.
    pub fn of(name: &Path, bytes: &[u8]) -> Result<Self, InputError> {
        let ending = name.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        if ending.is_some_and(|ending| MODELS.contains(&ending.as_str())) {
            return Ok(Self::Model);
        }
        if bytes.starts_with(b"glTF") || bytes.starts_with(b"RLV\n") {
            return Ok(Self::Model);
        }
        let refused = |bound: &str| InputError::new("file", name.display(), bound);
        let text = str::from_utf8(bytes).map_err(|_| refused(KNOWN))?;
        let root: Value = match serde_json::from_str(text) {
            Ok(root) => root,
            // A mistake in a scene is told with its line.
            Err(_) if text.trim_start().starts_with('{') => return Ok(Self::Scene),
            Err(_) => return Err(refused(KNOWN)),
        };
        match () {
            () if root.get("asset").is_some() => Ok(Self::Model),
            () if root.get("patchSize").is_some() => Ok(Self::Terrain),
            () => Ok(Self::Scene),
        }
    }
}

const KNOWN: &str = "must be a scene file, a model (.glb, .gltf, .obj, .rlv) or a configuration of terrain";

/// A scene file as JSON.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    root: Map<String, Value>,
}

impl Document {
    /// Reads a scene file.
    ///
    /// # Errors
    /// As for [`SceneFile::from_json`].
    pub fn from_json(text: &str) -> Result<Self, InputError> {
        SceneFile::from_json(text)?;
        match serde_json::from_str(text) {
            Ok(Value::Object(root)) => Ok(Self { root }),
            _ => Err(InputError::new("scene", "no object", "must be an object")),
        }
    }

    /// A scene with one instance of a model in an automatic light. The camera is set later.
    pub fn of_model(name: &Path, model: &Model) -> Self {
        let name = name.to_string_lossy();
        let list = if model.clips.is_empty() { "meshes" } else { "characters" };
        let root = json!({
            list: [{ "file": name, "instances": [{ "at": [0, 0, 0] }] }],
            "light": { "direction": [0.45, 0.8, 0.65], "color": [1.2, 1.17, 1.1], "ambient": 0.3 },
            "camera": { "at": [0, 1, 4], "look": [0, 0, 0] },
            "background": [0.2, 0.22, 0.25],
        });
        Self::of(root)
    }

    /// A scene with the terrain of a configuration: endless, where the configuration has coarse levels and no erosion or border
    /// that needs patches; else nine patches. The camera is set later.
    ///
    /// # Errors
    /// [`InputError`] for text that is not JSON. Other mistakes are found when the scene is read.
    pub fn of_terrain(text: &str) -> Result<Self, InputError> {
        let config: Value = serde_json::from_str(text).map_err(|error| {
            InputError::new("terrain.config", "no JSON", format!("must be JSON: {error}"))
        })?;
        let is_coarse = config.get("coarseLevels").and_then(Value::as_u64).is_some_and(|levels| levels > 0);
        let needs_patches = |name: &&str| config.get(name).is_some();
        let is_endless = is_coarse && !["thermal", "hydraulic", "thermalAfter"].iter().any(needs_patches);
        let terrain = if is_endless {
            json!({ "config": config, "endless": true })
        } else {
            let patches: Vec<[i32; 2]> = (0..9).map(|at| [at % 3 - 1, at / 3 - 1]).collect();
            json!({ "config": config, "patches": patches })
        };
        Ok(Self::of(json!({
            "terrain": terrain,
            "light": { "direction": [-0.8, 0.5, 0.35], "color": [1.4, 1.3, 1.12], "ambient": 0.28 },
            "camera": { "at": [0, 1, 4], "look": [0, 0, 0] },
            "quality": { "pixels": 2, "triangles": 400_000 },
            "background": [0.42, 0.58, 0.8],
        })))
    }

    fn of(root: Value) -> Self {
        match root {
            Value::Object(root) => Self { root },
            _ => Self { root: Map::new() },
        }
    }

    /// The scene file as JSON.
    pub(crate) fn value(&self) -> Value {
        Value::Object(self.root.clone())
    }

    /// The scene file as text.
    pub fn text(&self) -> String {
        serde_json::to_string_pretty(&self.root).unwrap_or_default() + "\n"
    }

    /// The checked scene file.
    ///
    /// # Errors
    /// As for [`SceneFile::from_json`].
    pub fn file(&self) -> Result<SceneFile, InputError> {
        SceneFile::from_json(&self.text())
    }

    /// Whether the terrain is endless.
    pub fn is_endless(&self) -> bool {
        self.root.get("terrain").is_some_and(|terrain| terrain.get("endless").is_some())
    }

    /// The number of a terrain's configuration, if it has one.
    pub(crate) fn terrain_number(&self, name: &str) -> Option<f64> {
        self.root.get("terrain")?.get("config")?.get(name)?.as_f64()
    }

    /// Puts the camera to a place, in place of a path.
    pub fn set_camera(&mut self, at: DVec3, look: DVec3) {
        self.part("camera", |camera| {
            camera.remove("path");
            camera.insert("at".to_owned(), json!(rounded(at)));
            camera.insert("look".to_owned(), json!(rounded(look)));
        });
    }

    /// Sets the distances of the near and the far plane.
    pub fn set_planes(&mut self, near: f64, far: Option<f64>) {
        self.part("camera", |camera| {
            camera.insert("near".to_owned(), json!(near));
            set(camera, "far", far.map(|far| json!(far)));
        });
    }

    /// Sets how fine the scene is.
    pub fn set_quality(&mut self, quality: Quality) {
        self.part("quality", |own| {
            own.insert("pixels".to_owned(), json!(f64::from(quality.pixels)));
            set(own, "triangles", quality.triangles.map(|triangles| json!(triangles)));
            set(own, "milliseconds", quality.milliseconds.map(|time| json!(f64::from(time))));
        });
    }

    /// Sets the transition of all objects.
    pub fn set_transition(&mut self, name: &str) {
        self.part("quality", |quality| set(quality, "transition", Some(json!(name))));
        models_mut(&mut self.root).for_each(|object| _ = object.remove("transition"));
    }

    /// Sets the light, and the background.
    pub fn set_light(&mut self, light: Light, background: [f32; 3]) {
        self.part("light", |own| {
            own.insert("direction".to_owned(), json!(light.direction.to_array().map(f64::from)));
            own.insert("color".to_owned(), json!(light.color.to_array().map(f64::from)));
            own.insert("ambient".to_owned(), json!(f64::from(light.ambient)));
        });
        self.root.insert(
            "background".to_owned(),
            json!(background.map(|channel| f64::from(channel.clamp(0.0, 1.0)))),
        );
    }

    /// Sets how the levels of detail of an object are chosen, by its number among meshes and then characters.
    pub fn set_level_of_detail(&mut self, object: usize, lod: Value) {
        if let Some(entry) = models_mut(&mut self.root).nth(object) {
            entry.insert("lod".to_owned(), lod);
        }
    }

    /// Sets a field of all characters; `None` removes it.
    pub fn set_characters(&mut self, name: &str, value: Option<&Value>) {
        let Some(Value::Array(all)) = self.root.get_mut("characters") else { return };
        for character in all.iter_mut().filter_map(Value::as_object_mut) {
            set(character, name, value.cloned());
        }
    }

    /// The field of the first character that has it.
    pub fn of_characters(&self, name: &str) -> Option<&Value> {
        self.root.get("characters")?.as_array()?.iter().find_map(|character| character.get(name))
    }

    /// The same scene with other names of files. `rename` gets the field and the name of each file, and returns another
    /// name or `None`.
    pub(crate) fn renamed(&self, rename: impl Fn(&str, &str) -> Option<String>) -> Self {
        let mut root = self.value();
        each_file_name(&mut root, &mut |field, name| {
            if let Some(other) = rename(field, name) {
                *name = other;
            }
        });
        Self::of(root)
    }

    /// The names of the files of meshes and then characters; `None` for one without a single file.
    pub(crate) fn names(&self) -> Vec<Option<String>> {
        let lists = ["meshes", "characters"].into_iter().filter_map(|list| self.root.get(list)?.as_array());
        lists.flatten().map(|entry| Some(entry.get("file")?.as_str()?.to_owned())).collect()
    }

    /// Changes the object in a field, which is made if there is none.
    fn part(&mut self, name: &str, change: impl FnOnce(&mut Map<String, Value>)) {
        let entry = self.root.entry(name).or_insert(Value::Null);
        if !entry.is_object() {
            *entry = json!({});
        }
        entry.as_object_mut().map(change);
    }
}

/// Sets a field, or removes it.
fn set(object: &mut Map<String, Value>, name: &str, value: Option<Value>) {
    match value {
        Some(value) => object.insert(name.to_owned(), value),
        None => object.remove(name),
    };
}

/// Coordinates with as many digits as a file needs: a millionth of a unit, or f64's own precision far from the origin.
fn rounded(point: DVec3) -> [f64; 3] {
    point.to_array().map(|axis| (axis * 1e6).round() / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"{"terrain": {"config": {"patchSize": 33, "scaleFactor": 6, "seed": "meadow"}},
        "characters": [{"file": "builtin:creature", "scatter": {"count": 5, "seed": "herd"}}],
        "camera": {"near": 0.2, "path": [{"time": 0, "at": [0, 9, 0], "look": [9, 0, 9]}, {"time": 2, "at": [0, 9, 9], "look": [9, 0, 9]}]}}"#;

    #[test]
    fn contents_are_told_by_name_and_first_bytes() {
        let of = |name: &str, bytes: &[u8]| Content::of(Path::new(name), bytes);
        assert_eq!(of("A.GLB", b"no glb"), Ok(Content::Model));
        assert_eq!(of("a", b"RLV\nrest"), Ok(Content::Model));
        assert_eq!(of("a.json", br#"{"asset": {"version": "2.0"}}"#), Ok(Content::Model));
        assert_eq!(of("a.json", br#"{"patchSize": 65, "seed": "a"}"#), Ok(Content::Terrain));
        assert_eq!(of("a.json", SCENE.as_bytes()), Ok(Content::Scene));
        assert_eq!(of("a.json", b"{ \"camera\": oops"), Ok(Content::Scene));
        for bytes in [&b"\xff\xfe\x00"[..], b"o cube", b""] {
            let error = of("a.txt", bytes).expect_err("unknown").to_string();
            assert!(error.starts_with("file = a.txt: must be a scene file, a model"), "{error}");
        }
    }

    #[test]
    fn changes_are_in_the_file_that_is_saved() {
        let mut document = Document::from_json(SCENE).expect("a scene");
        assert!(!document.is_endless());
        document.set_camera(DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.123_456_78));
        document.set_quality(Quality { pixels: 2.5, triangles: Some(9000), milliseconds: None });
        document.set_transition("dither");
        document.set_light(Light { ambient: 0.5, ..Light::default() }, [0.1, 0.2, 0.3]);
        document.set_characters("gate", Some(&json!({ "mode": "budget", "bones": 40 })));
        let file = document.file().expect("still a scene");
        assert_eq!(file.quality(), Quality { pixels: 2.5, triangles: Some(9000), milliseconds: None });
        assert_eq!(file.camera().end(), 0.0);
        let text = document.text();
        for part in ["\"near\": 0.2", "6.123457", "\"dither\"", "\"bones\": 40", "\"ambient\": 0.5"] {
            assert!(text.contains(part), "{part} in {text}");
        }
        document.set_characters("gate", None);
        assert_eq!(document.of_characters("gate"), None);
    }

    #[test]
    fn all_files_of_a_scene_get_other_names() {
        let text = r#"{"terrain": {"config": {"patchSize": 33, "scaleFactor": 6, "seed": "m", "zones": [{"min": -9, "max": 9, "texture": "moss.png"}]}},
            "meshes": [{"file": "wall.obj", "material": {"relief": "bricks.png"}, "instances": [{"at": [0, 0, 0]}]}],
            "camera": {"at": [0, 9, 0], "look": [9, 0, 9]}}"#;
        let document = Document::from_json(text).expect("a scene");
        let renamed =
            document.renamed(|_, name| (name != "wall.obj").then(|| format!("http://there/{name}"))).text();
        for name in ["\"http://there/moss.png\"", "\"http://there/bricks.png\"", "\"wall.obj\""] {
            assert!(renamed.contains(name), "{name} in {renamed}");
        }
    }

    #[test]
    fn terrain_is_endless_where_it_can_be() {
        let of = |text: &str| Document::of_terrain(text).expect("JSON");
        let endless = r#"{"patchSize": 65, "scaleFactor": 900, "seed": "a", "coarseLevels": 6}"#;
        assert!(of(endless).is_endless() && of(endless).file().is_ok());
        for text in [
            r#"{"patchSize": 65, "scaleFactor": 9, "seed": "a"}"#,
            r#"{"patchSize": 65, "scaleFactor": 9, "seed": "a", "coarseLevels": 2, "thermal": {"iterations": 2}}"#,
        ] {
            assert!(!of(text).is_endless());
            assert_eq!(of(text).file().map(|_| ()), Ok(()), "{text}");
        }
        assert!(Document::of_terrain("{").is_err());
    }
}
