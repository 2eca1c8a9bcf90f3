//! Terrain of a server: the configuration, injected heights by patch, and tiles of an elevation map.

use std::collections::BTreeMap;
use std::path::Path;

use relievo::InputError;
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::recipe::Recipe;
use serde_json::{Map, Value, json};

use super::ServeError;
use super::resource::{Compression, Lifetime, Resource};
use super::site::{Files, files_below, read_file};
use super::store::Store;

/// Path of the configuration below the base.
pub(super) const CONFIG: &str = "terrain/config.json";

/// File of the cache with the seed of terrain whose configuration has none.
const SEED: &str = "seed";

/// Injected heights by patch.
#[derive(Debug, Clone, Default)]
pub(super) struct PatchFeatures(BTreeMap<[i32; 2], Vec<f64>>);

impl PatchFeatures {
    /// The injected heights of a patch, as thesis B's JSON. Most patches have none.
    pub fn of(&self, patch: [i32; 2]) -> Vec<u8> {
        let none = Vec::new();
        let heights = self.0.get(&patch).unwrap_or(&none);
        json!({ "patchCoordinates": patch, "precomputedHeights": heights }).to_string().into_bytes()
    }

    /// The patches that have injected heights.
    pub fn patches(&self) -> impl Iterator<Item = [i32; 2]> {
        self.0.keys().copied()
    }
}

/// Reads the folder of a terrain. A configuration without a seed gets one from the system's entropy, which is kept in the cache:
/// so all servers of one cache give all clients the same.
pub(super) async fn terrain(
    folder: &Path,
    cache: &Store,
    files: &mut Files,
) -> Result<PatchFeatures, ServeError> {
    let path = folder.join("config.json");
    let text = read_file(&path)?;
    let in_file = |source: InputError| ServeError::File { path: path.clone(), source };
    let mut config: Map<String, Value> = serde_json::from_slice(&text)
        .map_err(|error| in_file(InputError::new("config", "JSON", format!("cannot be read: {error}"))))?;
    if !config.contains_key("seed") {
        config.insert("seed".to_owned(), seed(cache).await?.into());
    }
    let text = Value::Object(config).to_string();
    let recipe = Recipe::from_json(&text).map_err(in_file)?;
    // Shorter than the headers of a compressed answer would be (thesis B, §4.1).
    let resource =
        Resource::new(text.into_bytes(), "application/json", Lifetime::Revalidated, Compression::Never);
    files.insert(CONFIG.to_owned(), resource);
    for name in files_below(&folder.join("elevation"))? {
        let bytes = read_file(&folder.join("elevation").join(&name))?;
        files.insert(
            format!("terrain/elevation/{name}"),
            Resource::named(bytes, &name, Lifetime::Revalidated),
        );
    }
    let mut patches = PatchFeatures::default();
    let mut features = Features::new(&recipe.config, &[], FeatureMode::default())?;
    for name in files_below(&folder.join("features"))?.into_iter().filter(|name| name.ends_with(".json")) {
        let path = folder.join("features").join(&name);
        let in_file = |source: InputError| ServeError::File { path: path.clone(), source };
        let text = read_file(&path)?;
        let file = FeatureFile::from_json(&String::from_utf8_lossy(&text)).map_err(in_file)?;
        features.add(&recipe.config, &file).and_then(|()| features.check(&recipe.config)).map_err(in_file)?;
        patches.0.entry(file.patch_coordinates).or_default().extend(file.precomputed_heights);
    }
    Ok(patches)
}

async fn seed(cache: &Store) -> Result<String, ServeError> {
    let mut random = [0; 16];
    let failed = |error: getrandom::Error| ServeError::io("entropy", std::io::Error::other(error));
    getrandom::fill(&mut random).map_err(failed)?;
    let own: String = random.iter().map(|byte| format!("{byte:02x}")).collect();
    if cache.create(SEED, own.clone()).await? {
        return Ok(own);
    }
    let kept = cache.read(SEED).await?.unwrap_or_default();
    Ok(String::from_utf8_lossy(&kept).into_owned())
}
