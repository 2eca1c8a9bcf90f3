//! Everything that a server has.

use std::collections::BTreeMap;
use std::hash::Hash;
use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};

use axum::body::Bytes;
use futures_util::future::BoxFuture;
use quick_cache::Weighter;
use quick_cache::sync::Cache as MemoryCache;
use relievo::InputError;
use relievo::asset::Model;
use relievo_scene_file::BuiltIns;
use tokio::runtime::Handle;

use super::cooking::{Cache, CachedPackage, Source, object_name};
use super::metrics::Metrics;
use super::options::ServeOptions;
use super::resource::{Compression, Content, Lifetime, Resource};
use super::scenes::{SceneSource, built_in};
use super::store::Store;
use super::terrain::{PatchFeatures, terrain};
use super::{ServeError, terrain::CONFIG};
use crate::catalog::{CATALOG, Catalog, CatalogModel, ModelState};
use crate::mesh_json::MeshJson;

/// Files by their path below the base.
pub(super) type Files = BTreeMap<String, Resource>;

/// Folder of the cache beside the models.
const CACHE: &str = ".relievo";

/// Extensions of models, in lower case.
const MODELS: [&str; 4] = ["glb", "gltf", "obj", "rlv"];

/// Whether a file is a model, by its extension.
pub(super) fn is_model(name: &str) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    MODELS.contains(&ending.to_ascii_lowercase().as_str())
}

/// Values that were asked for last, up to a number of bytes. Several requests for a value that is missing make it once.
type InMemory<Key, Value> = MemoryCache<Key, Value, InBytes>;

/// Size of a value in bytes.
#[derive(Clone)]
struct InBytes;

impl Weighter<String, Bytes> for InBytes {
    fn weight(&self, _: &String, bytes: &Bytes) -> u64 {
        bytes.len().max(1) as u64
    }
}

impl Weighter<MeshKey, Arc<Resource>> for InBytes {
    fn weight(&self, _: &MeshKey, mesh: &Arc<Resource>) -> u64 {
        mesh.memory().max(1)
    }
}

/// A cache of values up to this number of bytes together.
fn in_memory<Key: Eq + Hash, Value: Clone>(bytes: u64) -> InMemory<Key, Value>
where
    InBytes: Weighter<Key, Value>,
{
    // A shard has at least 32 values, and its part of the bytes: for so few values, there is one, which has them all.
    MemoryCache::with_weighter(32, bytes, InBytes)
}

/// Everything that a server has. Clones share it.
#[derive(Clone)]
pub struct Site(pub(super) Arc<Inner>);

pub(super) struct Inner {
    pub options: ServeOptions,
    models: Option<Store>,
    pub cache: Cache,
    built_ins: Box<dyn BuiltIns + Send + Sync>,
    scenes: Vec<SceneSource>,
    /// Why scenes could not be prepared, by their paths.
    failed_scenes: RwLock<BTreeMap<String, String>>,
    files: RwLock<Files>,
    packages: RwLock<BTreeMap<String, Package>>,
    pub features: PatchFeatures,
    /// Meshes as JSON, the ones last asked for.
    meshes: InMemory<MeshKey, Arc<Resource>>,
    /// Packages, the ones last asked for, by their hashes.
    objects: InMemory<String, Bytes>,
    pub metrics: Metrics,
}

/// A model of the folder of models.
#[derive(Debug, Clone)]
struct Package {
    /// The name of its file.
    file: String,
    state: ModelState,
    package: Option<CachedPackage>,
}

/// A mesh as JSON: levels count from 0, the finest.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct MeshKey {
    /// Hash of the package.
    pub package: String,
    /// The coarser level of a difference; `None` for a whole mesh.
    pub from: Option<usize>,
    pub level: usize,
}

/// What a server knows about a model or a scene.
pub(super) enum Found<T> {
    /// There is none of this name.
    Missing,
    /// It is being prepared.
    Cooking,
    /// It could not be prepared, and why.
    Failed(String),
    Ready(T),
}

impl Site {
    /// Reads everything but models, which [`Site::cook`] makes into packages. `built_ins` has the models that scene files name
    /// with the prefix `builtin:`.
    ///
    /// # Errors
    /// [`ServeError`] for options out of bounds, for files that cannot be read or used, and for a cache that cannot be written.
    pub async fn open(
        options: ServeOptions,
        built_ins: Box<dyn BuiltIns + Send + Sync>,
    ) -> Result<Self, ServeError> {
        Self::opened(options, built_ins).await
    }

    fn opened(
        options: ServeOptions,
        built_ins: Box<dyn BuiltIns + Send + Sync>,
    ) -> BoxFuture<'static, Result<Self, ServeError>> {
        Box::pin(async move {
            options.validate()?;
            let models = options.models.as_deref().map(Store::open).transpose()?;
            let folder_of = |path: &Path| path.parent().unwrap_or(Path::new("")).join(CACHE);
            let cache = match (&options.cache, &models, &options.terrain, options.scenes.first()) {
                (Some(folder), ..) => Store::folder(folder)?,
                (None, Some(models), ..) => models.below(CACHE),
                (None, None, Some(terrain), _) => Store::folder(&terrain.join(CACHE))?,
                (None, None, None, Some(scene)) => Store::folder(&folder_of(scene))?,
                (None, None, None, None) => Store::folder(CACHE.as_ref())?,
            };
            let mut files = Files::new();
            let mut features = PatchFeatures::default();
            if let Some(folder) = &options.terrain {
                features = terrain(folder, &cache, &mut files).await?;
            }
            let mut scenes = Vec::new();
            for path in &options.scenes {
                scenes.push(SceneSource::open(path, &*built_ins, &mut files)?);
            }
            if let Some(folder) = &options.page {
                for name in files_below(folder)? {
                    let bytes = read_file(&folder.join(&name))?;
                    files.insert(name.clone(), Resource::named(bytes, &name, Lifetime::Revalidated));
                }
            }
            let mut packages = BTreeMap::new();
            if let Some(models) = &models {
                for file in models.names().await? {
                    let Some((name, _)) = file.rsplit_once('.').filter(|_| is_model(&file)) else { continue };
                    let package = Package { file: file.clone(), state: ModelState::Cooking, package: None };
                    if let Some(other) = packages.insert(name.to_owned(), package) {
                        let bound = format!("must have another name than {}, without extensions", other.file);
                        return Err(InputError::new("models", file, bound).into());
                    }
                }
            }
            // Half of the memory each.
            let half = options.limits.memory / 2;
            let cache = Cache::new(cache, options.cache_quota)?;
            let site = Self(Arc::new(Inner {
                options,
                models,
                cache,
                built_ins,
                scenes,
                failed_scenes: RwLock::default(),
                files: RwLock::new(files),
                packages: RwLock::new(packages),
                features,
                meshes: in_memory(half),
                objects: in_memory(half),
                metrics: Metrics::new(),
            }));
            site.0.list();
            Ok(site)
        })
    }

    /// Makes all models into packages, unless the cache has them. A server may answer requests meanwhile. `watch` gets the name of
    /// a model and the completed fraction. Returns the models that could not be made, with the reasons; the others are served.
    pub async fn cook(&self, watch: &(dyn Fn(&str, f32) + Sync)) -> Vec<(String, ServeError)> {
        self.cooked(watch).await
    }

    fn cooked<'a>(
        &'a self,
        watch: &'a (dyn Fn(&str, f32) + Sync),
    ) -> BoxFuture<'a, Vec<(String, ServeError)>> {
        Box::pin(async move {
            let mut failed = Vec::new();
            let names: Vec<_> = self.0.packages().keys().cloned().collect();
            for name in names {
                let made = self.0.cook_model(&name, watch).await;
                let (state, package) = match made {
                    Ok(package) => (ModelState::Ready, Some(package)),
                    Err(error) => {
                        let why = error.to_string();
                        failed.push((name.clone(), error));
                        (ModelState::Failed(why), None)
                    }
                };
                if let Some(package) = &package {
                    self.0.add_package(package);
                }
                let mut packages = self.0.packages.write().unwrap_or_else(PoisonError::into_inner);
                if let Some(own) = packages.get_mut(&name) {
                    (own.state, own.package) = (state, package);
                }
                drop(packages);
                self.0.list();
            }
            for scene in &self.0.scenes {
                match self.0.cook_scene(scene, watch).await {
                    Ok(resource) => self.0.insert(scene_path(scene), resource),
                    Err(error) => {
                        self.0.failed_scene(scene_path(scene), error.to_string());
                        failed.push((scene.path.display().to_string(), error));
                    }
                }
            }
            self.0.list();
            failed
        })
    }

    /// What the server has now.
    pub fn catalog(&self) -> Catalog {
        self.0.catalog()
    }
}

fn scene_path(scene: &SceneSource) -> String {
    format!("scenes/{}.json", scene.name)
}

impl Inner {
    fn packages(&self) -> std::sync::RwLockReadGuard<'_, BTreeMap<String, Package>> {
        self.packages.read().unwrap_or_else(PoisonError::into_inner)
    }

    async fn cook_model(
        &self,
        name: &str,
        watch: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<CachedPackage, ServeError> {
        let file = self.packages().get(name).map(|package| package.file.clone()).unwrap_or_default();
        let missing = || InputError::new("models", &file, "must still be there");
        let models = self.models.as_ref().ok_or_else(missing)?;
        let bytes = models.read(&file).await?.ok_or_else(missing)?;
        let read = |path: &Path| {
            let path = path.to_string_lossy().replace('\\', "/");
            let found = Handle::current().block_on(models.read(&path)).map_err(std::io::Error::other)?;
            found.map(|bytes| bytes.to_vec()).ok_or_else(|| std::io::ErrorKind::NotFound.into())
        };
        let watch = |fraction| watch(name, fraction);
        let source = Source { name: &file, bytes: &bytes, read: &read, built_in: None, watch: &watch };
        self.cache.cooked(&source).await
    }

    async fn cook_scene(
        &self,
        scene: &SceneSource,
        watch: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<Resource, ServeError> {
        let mut paths = BTreeMap::new();
        for name in &scene.models {
            let is_built_in = self.built_ins.has_model(built_in(name));
            let make = || self.built_ins.model(built_in(name));
            let bytes = match is_built_in {
                true => Bytes::from(name.clone()),
                false => scene.read(name.as_ref()).map_err(|error| ServeError::io(name, error))?.into(),
            };
            let folder = Path::new(name).parent().unwrap_or(Path::new(""));
            let read = |path: &Path| scene.read(&folder.join(path));
            let watch = |fraction| watch(name, fraction);
            let built_in: Option<&(dyn Fn() -> Result<Model, InputError> + Sync)> =
                if is_built_in { Some(&make) } else { None };
            let source = Source { name, bytes: &bytes, read: &read, built_in, watch: &watch };
            let package = self.cache.cooked(&source).await?;
            paths.insert(name.clone(), object_name(&package.hash));
            self.add_package(&package);
        }
        Ok(scene.with_packages(&paths))
    }

    fn add_package(&self, package: &CachedPackage) {
        self.insert(object_name(&package.hash), self.resource_of(package, Lifetime::Immutable));
    }

    fn insert(&self, path: String, resource: Resource) {
        self.files.write().unwrap_or_else(PoisonError::into_inner).insert(path, resource);
    }

    fn catalog(&self) -> Catalog {
        let packages = self.packages();
        let models = packages.iter().map(|(name, package)| match &package.package {
            Some(found) => CatalogModel::ready(name, object_name(&found.hash), &found.header),
            None => CatalogModel::waiting(name, package.state.clone()),
        });
        let models = models.collect();
        let files = self.files.read().unwrap_or_else(PoisonError::into_inner);
        let scenes = self.scenes.iter().map(scene_path).filter(|path| files.contains_key(path)).collect();
        let terrain = files.contains_key(CONFIG).then(|| CONFIG.to_owned());
        Catalog { models, scenes, terrain }
    }

    /// Writes the catalog again.
    fn list(&self) {
        // A struct of lists, numbers and texts is always written.
        let text = serde_json::to_vec(&self.catalog()).unwrap_or_default();
        let lifetime = Lifetime::Revalidated;
        self.insert(
            CATALOG.to_owned(),
            Resource::new(text, "application/json", lifetime, Compression::Allowed),
        );
    }

    /// A file by its path.
    pub fn file(&self, path: &str) -> Option<Resource> {
        self.files.read().unwrap_or_else(PoisonError::into_inner).get(path).cloned()
    }

    /// All files by their paths.
    pub fn all_files(&self) -> Files {
        self.files.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Number of models in each state: being made, ready, failed.
    pub fn states(&self) -> [usize; 3] {
        let packages = self.packages();
        let count = |is: fn(&ModelState) -> bool| packages.values().filter(|own| is(&own.state)).count();
        [
            count(|state| *state == ModelState::Cooking),
            count(|state| *state == ModelState::Ready),
            count(|state| matches!(state, ModelState::Failed(_))),
        ]
    }

    fn failed_scene(&self, path: String, why: String) {
        self.failed_scenes.write().unwrap_or_else(PoisonError::into_inner).insert(path, why);
    }

    /// A scene file by its path.
    pub fn scene(&self, path: &str) -> Found<Resource> {
        if let Some(resource) = self.file(path) {
            return Found::Ready(resource);
        }
        let failed = self.failed_scenes.read().unwrap_or_else(PoisonError::into_inner).get(path).cloned();
        match failed {
            Some(why) => Found::Failed(why),
            None if self.scenes.iter().any(|scene| scene_path(scene) == path) => Found::Cooking,
            None => Found::Missing,
        }
    }

    pub fn model(&self, name: &str) -> Found<CachedPackage> {
        match self.packages().get(name) {
            None => Found::Missing,
            Some(Package { package: Some(found), .. }) => Found::Ready(found.clone()),
            Some(Package { state: ModelState::Failed(why), .. }) => Found::Failed(why.clone()),
            Some(_) => Found::Cooking,
        }
    }

    /// A package as a file.
    pub fn resource_of(&self, package: &CachedPackage, lifetime: Lifetime) -> Resource {
        Resource {
            media: "application/octet-stream",
            hash: package.hash.clone(),
            length: package.header.bytes() as u64,
            content: Content::Stored(self.cache.object(&package.hash)),
            encoded: Vec::new(),
            lifetime,
        }
    }

    /// A file that is answered with: a package comes from memory if it is not too large for it.
    pub async fn in_memory(&self, resource: &Resource) -> Result<Resource, ServeError> {
        let is_stored = matches!(resource.content, Content::Stored(_));
        if !is_stored || resource.length > self.options.limits.memory / 16 {
            return Ok(resource.clone());
        }
        let bytes = self.package(&resource.hash).await?;
        Ok(Resource { content: Content::Memory(bytes), ..resource.clone() })
    }

    /// A package's bytes, from memory if they were asked for before.
    async fn package(&self, hash: &str) -> Result<Bytes, ServeError> {
        self.objects.get_or_insert_async(hash, self.cache.package(hash)).await
    }

    /// A mesh as JSON, or the difference between two levels. It is made once, and kept while it is asked for.
    pub async fn mesh(&self, key: MeshKey) -> Result<Arc<Resource>, ServeError> {
        if let Some(found) = self.meshes.get(&key) {
            self.metrics.mesh_hit();
            return Ok(found);
        }
        let made_of = key.clone();
        let make = async {
            self.metrics.mesh_miss();
            let bytes = self.package(&made_of.package).await?;
            let made = tokio::task::spawn_blocking(move || mesh_of(&bytes, &made_of));
            Ok(Arc::new(made.await.map_err(|error| ServeError::io("mesh", std::io::Error::other(error)))??))
        };
        self.meshes.get_or_insert_async(&key, make).await
    }
}

fn mesh_of(package: &[u8], key: &MeshKey) -> Result<Resource, ServeError> {
    let mesh = MeshJson::of_package(package, key.level)?;
    let json =
        |written: serde_json::Result<Vec<u8>>| written.map_err(|error| ServeError::io("mesh", error.into()));
    let text = match key.from {
        None => json(serde_json::to_vec(&mesh))?,
        Some(from) => {
            let coarser = MeshJson::of_package(package, from)?;
            json(serde_json::to_vec(&mesh.difference_from(&coarser)?))?
        }
    };
    Ok(Resource::new(text, "application/json", Lifetime::Revalidated, Compression::Allowed))
}

/// Names of all files in a folder and below, relative to it, ascending; none if there is no such folder. Hidden files are left
/// out.
pub(super) fn files_below(folder: &Path) -> Result<Vec<String>, ServeError> {
    let mut names = Vec::new();
    if !folder.is_dir() {
        return Ok(names);
    }
    let failed = |error| ServeError::io(folder.display(), error);
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') {
            continue;
        }
        if entry.path().is_dir() {
            let below = files_below(&entry.path())?;
            names.extend(below.into_iter().map(|inner| format!("{name}/{inner}")));
        } else {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, ServeError> {
    std::fs::read(path).map_err(|error| ServeError::io(path.display(), error))
}
