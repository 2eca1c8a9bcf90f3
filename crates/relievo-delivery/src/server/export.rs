//! The files of a site as plain files, for any web server or content delivery network.

use std::fs;
use std::path::{Path, PathBuf};

use futures_util::future::LocalBoxFuture;
use object_store::ObjectStoreExt as _;
use serde::{Deserialize, Serialize};

use super::ServeError;
use super::resource::{Content, Lifetime, Resource};
use super::site::{Found, MeshKey, Site};
use crate::catalog::ModelState;

/// The list of exported files: `manifest.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// All files, by path.
    pub files: Vec<Exported>,
}

/// An exported file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Exported {
    /// Path below the folder.
    pub path: String,
    /// Media type.
    pub media: String,
    /// Number of bytes.
    pub bytes: u64,
    /// SHA-256 of the bytes.
    pub sha256: String,
    /// Whether the path contains the hash of the content, so that a client may keep the file for ever.
    pub immutable: bool,
    /// Endings of the same file in other encodings beside it (`br`, `zst`, `gz`), the smallest first.
    pub encodings: Vec<String>,
}

/// Writes everything that a site has into a folder: what its server would answer with, and `manifest.json` at last. Of the
/// differences between levels, those to the next finer level are written. Each file appears as a whole. `watch` gets the path of
/// each file.
///
/// # Errors
/// [`ServeError`] for files that cannot be read or written.
pub async fn export(site: &Site, folder: &Path, watch: &dyn Fn(&str)) -> Result<Manifest, ServeError> {
    exported(site, folder, watch).await
}

fn exported<'a>(
    site: &'a Site,
    folder: &'a Path,
    watch: &'a dyn Fn(&str),
) -> LocalBoxFuture<'a, Result<Manifest, ServeError>> {
    Box::pin(async move {
        let mut files: Vec<(String, Resource)> = site.0.all_files().into_iter().collect();
        for model in site.catalog().models.into_iter().filter(|model| model.state == ModelState::Ready) {
            let Found::Ready(package) = site.0.model(&model.name) else { continue };
            let name = &model.name;
            files.push((format!("models/{name}.rlv"), site.0.resource_of(&package, Lifetime::Revalidated)));
            for level in 0..model.levels.len() {
                let key = MeshKey { package: package.hash.clone(), from: None, level };
                let whole = site.0.mesh(key.clone()).await?;
                files.push((format!("models/{name}/{level}.json"), (*whole).clone()));
                if level + 1 < model.levels.len() {
                    let from = level + 1;
                    let difference = site.0.mesh(MeshKey { from: Some(from), ..key }).await?;
                    files.push((format!("models/{name}/{from}-{level}.json"), (*difference).clone()));
                }
            }
        }
        for patch @ [x, y] in site.0.features.patches() {
            let text = site.0.features.of(patch);
            let name = format!("terrain/features/{x},{y}.json");
            files.push((name.clone(), Resource::named(text, &name, Lifetime::Revalidated)));
        }
        let mut manifest = Manifest { files: Vec::new() };
        for (path, resource) in files {
            let place = folder.join(&path);
            match &resource.content {
                Content::Memory(bytes) => write(&place, bytes)?,
                Content::Stored(object) => {
                    let store = site.0.cache.store().raw();
                    write(&place, &store.get(object).await?.bytes().await?)?;
                }
            }
            for (encoding, bytes) in &resource.encoded {
                let mut name = place.clone().into_os_string();
                name.push(format!(".{}", encoding.ending()));
                write(&PathBuf::from(name), bytes)?;
            }
            watch(&path);
            manifest.files.push(Exported {
                path,
                media: resource.media.to_owned(),
                bytes: resource.length,
                sha256: resource.hash,
                immutable: resource.lifetime == Lifetime::Immutable,
                encodings: resource
                    .encoded
                    .iter()
                    .map(|(encoding, _)| encoding.ending().to_owned())
                    .collect(),
            });
        }
        let text = serde_json::to_vec_pretty(&manifest)
            .map_err(|error| ServeError::io("manifest.json", error.into()))?;
        write(&folder.join("manifest.json"), &text)?;
        Ok(manifest)
    })
}

/// Writes a file, which appears as a whole.
fn write(path: &Path, bytes: &[u8]) -> Result<(), ServeError> {
    let failed = |error| ServeError::io(path.display(), error);
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(failed)?;
    let mut staged = path.as_os_str().to_owned();
    staged.push(".part");
    fs::write(&staged, bytes).and_then(|()| fs::rename(&staged, path)).map_err(failed)
}
