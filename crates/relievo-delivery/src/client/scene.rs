//! A scene file from a server, whose objects appear as they arrive.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use relievo::scene::View;
use relievo::{Error, InputError};
use relievo_scene_file::{BuiltIns, LoadedScene, SceneFile, World};

use super::beside;
use super::fetcher::{Fetcher, FetcherOptions, FileKey, ModelKey, Want};
use super::transport::Transport;

/// Weight of an object that no view sees: its coarsest level is fetched after everything else, so that something is there when it
/// comes into view.
const UNSEEN: f32 = 1e-6;

/// Loads a scene file over HTTP. The scene is there once its terrain can be made; meshes and characters appear with their coarsest
/// level, and become finer as views need it.
///
/// ```no_run
/// use std::time::Instant;
///
/// use relievo::gpu::Gpu;
/// use relievo::render::Renderer;
/// use relievo_delivery::client::{FetcherOptions, HttpTransport, StreamedScene};
///
/// # fn example(gpu: &Gpu, renderer: &mut Renderer) -> Result<(), relievo::Error> {
/// let begun = Instant::now();
/// let url = "http://127.0.0.1:8080/scenes/walk.json";
/// let mut streamed = StreamedScene::open(url, HttpTransport::new(), FetcherOptions::default());
/// let loaded = loop {
///     if let Some(loaded) = streamed.begin(begun.elapsed(), &relievo_samples::Samples)? {
///         break loaded;
///     }
/// };
/// let mut world = loaded.build(gpu)?;
/// let view = world.scene.view(world.quality)?;
/// // In each frame, once the view has a camera:
/// if streamed.update(&mut world, &[&view], begun.elapsed())? {
///     renderer.prepare(&world.scene)?;
/// }
/// # Ok(())
/// # }
/// ```
pub struct StreamedScene<T> {
    fetcher: Fetcher<T>,
    url: String,
    /// The scene file, as long as it is fetched.
    text: Option<FileKey>,
    file: Option<SceneFile>,
    /// The files that the scene needs at once.
    files: BTreeMap<PathBuf, FileKey>,
    packages: BTreeMap<PathBuf, ModelKey>,
    /// Packages of which something is shown.
    shown: BTreeSet<ModelKey>,
    /// Packages of which something was taken in, but not shown.
    fetched: BTreeSet<ModelKey>,
    loaded: Option<LoadedScene>,
    /// Whether packages are fetched whole, whatever the views need.
    fetches_all: bool,
}

impl<T: Transport> StreamedScene<T> {
    /// Begins to fetch the scene file at an address.
    pub fn open(url: &str, transport: T, options: FetcherOptions) -> Self {
        let mut fetcher = Fetcher::new(transport, options);
        let text = Some(fetcher.add_file(url));
        let (file, files, packages, shown, fetched, loaded) = Default::default();
        let url = url.to_owned();
        Self { fetcher, url, text, file, files, packages, shown, fetched, loaded, fetches_all: false }
    }

    /// A scene file that is there already, whose names are relative to `url`. What the fetcher has of its files is not fetched
    /// again.
    pub fn with_file(file: SceneFile, url: &str, fetcher: Fetcher<T>) -> Self {
        let (files, packages, shown, fetched, loaded) = Default::default();
        let url = url.to_owned();
        let (text, fetches_all) = (None, false);
        let mut own =
            Self { fetcher, url, text, file: None, files, packages, shown, fetched, loaded, fetches_all };
        own.set_file(file);
        own
    }

    /// Ends with what was fetched, for another scene of the same files.
    pub fn into_fetcher(self) -> Fetcher<T> {
        self.fetcher
    }

    fn set_file(&mut self, file: SceneFile) {
        for path in file.packages() {
            let key = self.fetcher.add(&beside(&self.url, &path));
            self.packages.insert(path, key);
        }
        for path in file.files().into_iter().filter(|path| !self.packages.contains_key(path)) {
            let key = self.fetcher.add_file(&beside(&self.url, &path));
            self.files.insert(path, key);
        }
        self.file = Some(file);
    }

    /// Takes in what has arrived, without blocking. Returns the scene once everything but its packages is there. Names with the
    /// prefix `builtin:` come from `built_ins`.
    ///
    /// # Errors
    /// [`Error::File`] for files that cannot be fetched; [`Error::InputFile`] with the path of a mistake in the scene file.
    pub fn begin(&mut self, now: Duration, built_ins: &dyn BuiltIns) -> Result<Option<&LoadedScene>, Error> {
        self.fetcher.update(now);
        let path = PathBuf::from(&self.url);
        let in_file = |source: InputError| Error::InputFile { path: path.clone(), source };
        if let (None, Some(text)) = (&self.file, self.text) {
            let Some(text) = self.fetcher.file(text).map_err(Error::from)? else { return Ok(None) };
            let text = str::from_utf8(text).map_err(|error| {
                in_file(InputError::new("scene", "bytes", format!("must be text: {error}")))
            })?;
            let file = SceneFile::from_json(text).map_err(in_file)?;
            self.set_file(file);
        }
        if self.loaded.is_none() {
            self.want(None, &[])?;
        }
        let mut contents = BTreeMap::new();
        for (path, key) in &self.files {
            let Some(bytes) = self.fetcher.file(*key).map_err(Error::from)? else { return Ok(None) };
            contents.insert(path.as_path(), bytes);
        }
        if let (None, Some(file)) = (&self.loaded, &self.file) {
            let read = |path: &Path| {
                let found = contents.get(path).map(|bytes| bytes.to_vec());
                found.ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))
            };
            self.loaded = Some(file.load_without_packages(&read, built_ins).map_err(in_file)?);
        }
        Ok(self.loaded.as_ref())
    }

    /// Shows what has arrived, and asks for what views with cameras need next. Call it once a frame, before
    /// [`Scene::record`](relievo::scene::Scene::record). Whether the scene has changed, so that renderers must be prepared again.
    ///
    /// # Errors
    /// [`Error`] for packages that do not suit the scene, and for failures of the device. What cannot be fetched is told by
    /// [`StreamedScene::fetcher`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn update(&mut self, world: &mut World, views: &[&View], now: Duration) -> Result<bool, Error> {
        let gpu = world.scene.gpu().clone();
        gpu.block_on(self.update_async(world, views, now))
    }

    /// Same as `StreamedScene::update`, but completes once the device has reported its errors.
    ///
    /// # Errors
    /// Same as `StreamedScene::update`.
    pub async fn update_async(
        &mut self,
        world: &mut World,
        views: &[&View],
        now: Duration,
    ) -> Result<bool, Error> {
        self.receive(now);
        self.show_async(world, views).await
    }

    /// Takes in what has arrived, without showing it.
    pub fn receive(&mut self, now: Duration) {
        self.fetched.extend(self.fetcher.update(now).into_iter().map(|own| own.model));
    }

    /// Shows what was taken in, and asks for what views with cameras need next. Whether the scene has changed.
    ///
    /// # Errors
    /// Same as `StreamedScene::update`.
    pub async fn show_async(&mut self, world: &mut World, views: &[&View]) -> Result<bool, Error> {
        let fetched = std::mem::take(&mut self.fetched);
        let mut has_changed = false;
        for (path, key) in &self.packages {
            let is_here = self.fetcher.count(*key).is_some_and(|own| own.levels > 0);
            let is_new = fetched.contains(key) || !self.shown.contains(key);
            let is_new = is_here && is_new;
            let Some(loaded) = self.loaded.as_mut().filter(|_| is_new) else { continue };
            let in_file = |source| Error::InputFile { path: path.clone(), source };
            // One that is refused is not tried again before it has more.
            self.shown.insert(*key);
            let Some(model) = self.fetcher.model(*key).map_err(in_file)? else { continue };
            loaded.set_package(path, model).map_err(in_file)?;
            world.show_package_async(loaded, path).await?;
            has_changed = true;
        }
        self.want(Some(world), views)?;
        Ok(has_changed)
    }

    /// What fetches the packages: its states, and what came over the wire.
    pub fn fetcher(&self) -> &Fetcher<T> {
        &self.fetcher
    }

    /// Mutable form of [`StreamedScene::fetcher`].
    pub fn fetcher_mut(&mut self) -> &mut Fetcher<T> {
        &mut self.fetcher
    }

    /// The contents of the files that the scene needs at once, as far as they are there.
    pub fn files(&self) -> impl Iterator<Item = &[u8]> {
        self.files.values().filter_map(|key| self.fetcher.file(*key).ok().flatten())
    }

    /// The packages of the scene, by their paths in the scene file.
    pub fn packages(&self) -> impl Iterator<Item = (&Path, ModelKey)> {
        self.packages.iter().map(|(path, key)| (path.as_path(), *key))
    }

    /// From now on, packages are fetched whole, whatever the views need.
    pub fn fetch_all(&mut self) {
        self.fetches_all = true;
    }

    /// Whether all that views need is there, or cannot be fetched.
    pub fn is_settled(&self) -> bool {
        self.loaded.is_some() && self.fetcher.is_settled()
    }

    /// Tells the fetcher what views need of the objects of each package.
    fn want(&mut self, world: Option<&World>, views: &[&View]) -> Result<(), Error> {
        let mut wants = Vec::new();
        for (path, key) in &self.packages {
            let mut want = Want { model: *key, error: f32::MAX, weight: UNSEEN };
            let name = path.display().to_string();
            let objects =
                world.iter().flat_map(|world| &world.objects).filter(|object| object.source == name);
            for object in objects {
                let Some(scene) = world.map(|world| &world.scene) else { continue };
                if let Some(wanted) = scene.wanted(object.object, views)? {
                    want.error = want.error.min(wanted.error);
                    want.weight += wanted.area;
                }
            }
            if self.fetches_all {
                (want.error, want.weight) = (0.0, want.weight.max(1.0));
            }
            wants.push(want);
        }
        self.fetcher.want(&wants);
        Ok(())
    }
}

/// Fetches a scene file and all files that it names, while the caller waits. Packages come whole.
///
/// # Errors
/// As for [`StreamedScene::begin`].
#[cfg(not(target_arch = "wasm32"))]
pub fn get_scene(url: &str, token: Option<&str>, built_ins: &dyn BuiltIns) -> Result<LoadedScene, Error> {
    let in_file = |source: InputError| Error::InputFile { path: url.into(), source };
    let agent = super::native::agent();
    let get = |url: &str| super::download::get_by(&agent, url, token);
    let text = String::from_utf8(get(url)?)
        .map_err(|error| in_file(InputError::new("scene", "bytes", format!("must be text: {error}"))))?;
    let read = |path: &Path| get(&beside(url, path)).map_err(io::Error::other);
    SceneFile::from_json(&text).and_then(|file| file.load(&read, built_ins)).map_err(in_file)
}
