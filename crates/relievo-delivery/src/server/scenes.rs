//! Scene files of a server. The files that they name are served by the hashes of their contents; models become packages.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use relievo::InputError;
use relievo_scene_file::{BuiltIns, SceneFile};
use serde_json::Value;

use super::ServeError;
use super::resource::{Compression, Lifetime, Resource};
use super::site::{Files, is_model, read_file};
use crate::file_names::{BUILT_IN, each_file_name, models_mut};
use crate::sha256;

/// A scene file, and the models that it names.
pub(super) struct SceneSource {
    pub path: PathBuf,
    /// The name below `scenes/`, without extension.
    pub name: String,
    text: Value,
    /// Names of models that become packages, as the scene file has them.
    pub models: Vec<String>,
}

impl SceneSource {
    /// Reads a scene file, and adds the files that are not models.
    pub fn open(path: &Path, built_ins: &dyn BuiltIns, files: &mut Files) -> Result<Self, ServeError> {
        let in_file = |source: InputError| ServeError::File { path: path.to_owned(), source };
        let text = read_file(path)?;
        let text = String::from_utf8(text)
            .map_err(|error| in_file(InputError::new("scene", "bytes", format!("must be text: {error}"))))?;
        SceneFile::from_json(&text).map_err(in_file)?;
        let json = |error| in_file(InputError::new("scene", "JSON", format!("cannot be read: {error}")));
        let mut text: Value = serde_json::from_str(&text).map_err(json)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut models = Vec::new();
        let mut renamed = BTreeMap::new();
        let mut refused = None;
        each_file_name(&mut text, &mut |field, name| {
            let is_model = field == "file" && (is_model(name) || built_ins.has_model(built_in(name)));
            if is_model {
                models.push(name.clone());
            } else if field == "levels" && !name.starts_with(BUILT_IN) && !name.ends_with(".glb") {
                let bound = "must be a .glb file: files beside others are not served";
                let error = InputError::new("levels", name.as_str(), bound);
                refused = refused.take().or(Some(ServeError::File { path: path.to_owned(), source: error }));
            } else if !name.starts_with(BUILT_IN) {
                match added(path, name, files) {
                    Ok(object) => drop(renamed.insert(name.clone(), object)),
                    Err(error) => refused = refused.take().or(Some(error)),
                }
            }
        });
        if let Some(error) = refused {
            return Err(error);
        }
        rename(&mut text, &renamed);
        models.sort();
        models.dedup();
        Ok(Self { path: path.to_owned(), name, text, models })
    }

    /// Reads a file that the scene file, or one of its models in the same folder, names.
    pub fn read(&self, name: &Path) -> io::Result<Vec<u8>> {
        std::fs::read(self.path.parent().unwrap_or(Path::new("")).join(name))
    }

    /// The scene file with the paths of packages, by the names of models, in the place of these names.
    pub fn with_packages(&self, packages: &BTreeMap<String, String>) -> Resource {
        let mut text = self.text.clone();
        name_objects(&mut text, packages);
        let relative = packages.iter().map(|(name, path)| (name.clone(), format!("../{path}"))).collect();
        rename(&mut text, &relative);
        Resource::new(
            text.to_string().into_bytes(),
            "application/json",
            Lifetime::Revalidated,
            Compression::Allowed,
        )
    }
}

/// The name of a built-in model; for other names, one that does not exist.
pub(super) fn built_in(name: &str) -> &str {
    name.strip_prefix(BUILT_IN).unwrap_or_default()
}

/// Adds a file by the hash of its content. Returns its path relative to the scene file.
fn added(scene: &Path, name: &str, files: &mut Files) -> Result<String, ServeError> {
    let path = scene.parent().unwrap_or(Path::new("")).join(name);
    let bytes = read_file(&path)?;
    let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let object = format!("objects/{}.{}", sha256(&bytes), ending.as_deref().unwrap_or("bin"));
    let resource = Resource::named(bytes, &object, Lifetime::Immutable);
    files.insert(object.clone(), resource);
    Ok(format!("../{object}"))
}

/// Names the objects of packages after their files, since the address of a package tells nobody what it is.
fn name_objects(text: &mut Value, packages: &BTreeMap<String, String>) {
    for entry in text.as_object_mut().into_iter().flat_map(models_mut) {
        let file = entry.get("file").and_then(Value::as_str).filter(|file| packages.contains_key(*file));
        if let (Some(file), false) = (file, entry.contains_key("name")) {
            let name = file.rsplit('/').next().unwrap_or(file).to_owned();
            entry.insert("name".to_owned(), Value::String(name));
        }
    }
}

fn rename(text: &mut Value, names: &BTreeMap<String, String>) {
    each_file_name(text, &mut |_, name| {
        if let Some(new) = names.get(name.as_str()) {
            name.clone_from(new);
        }
    });
}
