//! Loading: reads a file and what it names, prepares the scene, and puts it on the device, while the viewer shows something else.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

use glam::DVec3;
use image::RgbaImage;
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::scene::HeightMap;
use relievo::{Error, InputError};
use relievo_samples::Samples;
use relievo_scene_file::{BuiltIns, SceneFile, World, WorldKind};

use crate::document::{Content, Document};
use crate::eye::Eye;
use crate::images::{self, Decoded};
use crate::source::{Source, Throttled, sleep};
use crate::stage::Stage;
use crate::streaming::{Fetching, Streaming};

/// What to load.
pub(crate) struct Job {
    pub gpu: Gpu,
    /// The name of the file, relative to the source.
    pub name: PathBuf,
    pub source: Arc<dyn Source>,
    /// Bits a second at which files arrive; `None` for no limit.
    pub rate: Option<f64>,
    /// The scene instead of the file's, and models that were prepared before: to build a changed scene anew.
    pub changed: Option<Changed>,
    /// What a scene of a site, which is built anew, has fetched.
    pub fetching: Option<Fetching>,
}

/// A changed scene, with what was read and prepared for it before.
#[derive(Clone)]
pub(crate) struct Changed {
    pub document: Document,
    pub known: Known,
}

/// Files that were read, and models with their levels of detail, by their names in the scene.
#[derive(Clone, Default)]
pub(crate) struct Known {
    files: HashMap<PathBuf, Arc<[u8]>>,
    models: HashMap<String, Arc<Model>>,
}

impl Known {
    /// Adds files that are there already.
    pub fn add_files(&mut self, files: impl Iterator<Item = (PathBuf, Vec<u8>)>) {
        self.files.extend(files.map(|(name, bytes)| (name, bytes.into())));
    }
}

/// Seconds until a server is asked again for a file that it is preparing.
const PAUSE: f64 = 2.0;

/// A file that arrived.
#[derive(Debug, Clone, PartialEq)]
pub struct Arrival {
    /// The name of the file.
    pub name: String,
    /// Its bytes.
    pub bytes: usize,
    /// Seconds from the request to the last byte.
    pub seconds: f64,
}

/// What a job tells.
pub(crate) enum News {
    /// What it does now.
    Step(String),
    /// From now on, the device is busy with the scene.
    Building,
    Arrived(Arrival),
    Ready(Box<Ready>),
    Failed(String),
}

/// A scene that can be shown.
pub(crate) struct Ready {
    pub document: Document,
    pub known: Known,
    pub stage: Stage,
    pub eye: Eye,
    /// The size of what the camera frames, in world units: how fast keys fly.
    pub extent: f64,
    pub source: Arc<dyn Source>,
    /// What the scene still fetches; `None` for one whose files were read whole.
    pub streaming: Option<Streaming>,
}

/// A job that runs.
pub(crate) struct Task {
    news: Receiver<News>,
}

impl Task {
    /// Starts a job: in a thread of its own, or between the frames of a page.
    pub fn start(job: Job, wake: impl Fn() + wgpu::WasmNotSend + 'static) -> Self {
        let (to, news) = channel();
        let teller = Teller { to, wake: Box::new(wake) };
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || {
            let gpu = job.gpu.clone();
            let all = async {
                run(job, teller).await;
                Ok::<(), Error>(())
            };
            // An end without news tells that the device was lost.
            let _ = gpu.block_on(all);
        });
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(run(job, teller));
        Self { news }
    }

    /// The next news, if there are any.
    pub fn next(&self) -> Option<News> {
        match self.news.try_recv() {
            Ok(news) => Some(news),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(News::Failed("loading ended before its time".to_owned())),
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
type Wake = Box<dyn Fn() + Send>;
#[cfg(target_arch = "wasm32")]
type Wake = Box<dyn Fn()>;

/// Tells the viewer how a job goes on.
struct Teller {
    to: Sender<News>,
    wake: Wake,
}

impl Teller {
    /// Returns whether somebody listens: not a viewer that has ended or opened something else.
    fn tell(&self, news: News) -> bool {
        let is_heard = self.to.send(news).is_ok();
        (self.wake)();
        is_heard
    }

    /// Tells what is done now, and lets a page show it.
    async fn step(&self, what: impl Into<String>) {
        self.tell(News::Step(what.into()));
        #[cfg(target_arch = "wasm32")]
        crate::web::next_frame().await;
    }
}

async fn run(job: Job, teller: Teller) {
    let (files, decoded) = Default::default();
    let loader = Loader { teller: &teller, gpu: job.gpu.clone(), files, decoded };
    let news = match loader.load(job).await {
        Ok(ready) => News::Ready(Box::new(ready)),
        Err(error) => News::Failed(error.to_string()),
    };
    teller.tell(news);
}

struct Loader<'a> {
    teller: &'a Teller,
    gpu: Gpu,
    files: RefCell<HashMap<PathBuf, Arc<[u8]>>>,
    /// Files whose images were decoded beforehand.
    decoded: RefCell<Decoded>,
}

impl Loader<'_> {
    /// Decodes the images that are noted. Returns whether there were some.
    async fn decode(&self) -> bool {
        let files = images::decode(&self.gpu).await;
        let has_some = !files.is_empty();
        self.decoded.borrow_mut().0.extend(files);
        has_some
    }

    async fn load(&self, job: Job) -> Result<Ready, Error> {
        let Job { name, source, rate, changed, fetching, .. } = job;
        let throttled = Throttled { source: &*source, rate };
        let mut fetching = fetching;
        let (document, known, is_framed) = match changed {
            Some(Changed { document, known }) => {
                self.files.replace(known.files);
                (document, known.models, true)
            }
            None => {
                let url = source.url(&name);
                let mut own = url.is_some().then(|| Fetching::new(rate));
                let found = self.document(&name, &throttled, own.as_mut().zip(url)).await?;
                fetching = own;
                (found.0, HashMap::new(), found.1)
            }
        };
        let in_file = |source: InputError| Error::InputFile { path: name.clone(), source };
        // Models that are known have levels of detail, and are not read again.
        let built_ins = Prepared(&known);
        let renamed = document.renamed(|field, name| {
            let is_known = field == "file" && known.contains_key(name);
            is_known.then(|| format!("builtin:{PREPARED}{name}"))
        });
        let file = renamed.file().map_err(in_file)?;
        if let (Some(url), Some(fetching), true) = (source.url(&name), fetching, Streaming::suits(&file)) {
            let streaming = Streaming::new(file, &url, fetching);
            return self.streamed(document, streaming, source, is_framed).await;
        }
        self.fetch_all(&file, &throttled).await.map_err(in_file)?;
        let loaded = self
            .retried(&throttled, "preparing levels of detail", |read| file.load(read, &built_ins))
            .await
            .map_err(in_file)?;
        self.teller.tell(News::Building);
        self.teller.step("building the scene on the device").await;
        let world = loaded.build_async(&self.gpu).await.map_err(|error| match error {
            Error::Input(source) => in_file(source),
            other => other,
        })?;
        self.ready(document, world, known, source, is_framed).await
    }

    /// Tells that the server does not answer. Returns whether somebody listens.
    fn waits(&self, why: &str) -> bool {
        self.teller.tell(News::Step(format!("waiting for the server: {why}")))
    }

    /// Builds a scene of a site, as soon as there is something to show.
    async fn streamed(
        &self,
        document: Document,
        mut streaming: Streaming,
        source: Arc<dyn Source>,
        is_framed: bool,
    ) -> Result<Ready, Error> {
        self.teller.step("waiting for what the scene needs").await;
        let loaded = streaming.begin(&self.gpu, |why| _ = self.waits(why)).await?;
        self.teller.tell(News::Building);
        self.teller.step("building the scene on the device").await;
        let mut world = loaded.build_async(&self.gpu).await?;
        self.teller.step("waiting for the coarsest level").await;
        streaming.appear(&mut world, |why| _ = self.waits(why)).await?;
        for arrival in streaming.arrivals() {
            self.teller.tell(News::Arrived(arrival));
        }
        // Its models are not known: they become finer.
        let mut ready = self.ready(document, world, HashMap::new(), source, is_framed).await?;
        ready.known.models.clear();
        Ok(Ready { streaming: Some(streaming), ..ready })
    }

    /// Frames the scene, and compiles its pipelines.
    async fn ready(
        &self,
        mut document: Document,
        mut world: World,
        mut models: HashMap<String, Arc<Model>>,
        source: Arc<dyn Source>,
        is_framed: bool,
    ) -> Result<Ready, Error> {
        for object in &mut world.objects {
            for name in [&mut object.name, &mut object.source] {
                if let Some(own) = name.strip_prefix("builtin:").and_then(|name| name.strip_prefix(PREPARED))
                {
                    *name = own.to_owned();
                }
            }
            // A model that a mesh shows at rest has no clips, and one of several levels has several names.
            let is_one = !object.source.contains(", ");
            if let (Some(model), true, WorldKind::Character) = (&object.model, is_one, object.kind) {
                models.insert(object.source.clone(), model.clone());
            }
        }
        let extent = match is_framed {
            true => extent(&world),
            false => frame(&mut document, &mut world)?,
        };
        self.teller.step("compiling shaders").await;
        let stage = Stage::new(world).await?;
        let camera = stage.world.camera.camera(0.0, [960, 600], relievo::scene::Depth::Forward);
        let distance = focus_distance(&stage.world, &camera).unwrap_or(extent);
        let known = Known { files: self.files.take(), models };
        Ok(Ready { document, known, stage, eye: Eye::of(&camera, distance), extent, source, streaming: None })
    }

    /// The scene of a file, and whether it says where the camera is. Of a site's package, only the coarsest level is fetched.
    async fn document(
        &self,
        name: &Path,
        source: &Throttled<'_>,
        site: Option<(&mut Fetching, String)>,
    ) -> Result<(Document, bool), Error> {
        let in_file = |source: InputError| Error::InputFile { path: name.to_owned(), source };
        self.teller.step(format!("reading {}", name.display())).await;
        let is_package = name.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("rlv"));
        if let Some((fetching, url)) = site.filter(|_| is_package) {
            let model = fetching.coarsest(&url, |why| _ = self.waits(why)).await?;
            return Ok((Document::of_model(name, &model), false));
        }
        let called = name.display().to_string();
        self.fetch(name, called, source).await.map_err(|error| Error::file(name, error))?;
        let bytes = self.files.borrow()[name].clone();
        let text = || {
            str::from_utf8(&bytes)
                .map_err(|_| in_file(InputError::new("file", name.display(), "must be text")))
        };
        match Content::of(name, &bytes).map_err(in_file)? {
            Content::Scene => Ok((Document::from_json(text()?).map_err(in_file)?, true)),
            Content::Terrain => Ok((Document::of_terrain(text()?).map_err(in_file)?, false)),
            Content::Model => {
                let folder = name.parent().unwrap_or(Path::new(""));
                let model = self
                    .retried(source, "reading the model", |read| {
                        Model::from_bytes_beside(name, &bytes, &|beside| read(&folder.join(beside)))
                    })
                    .await;
                Ok((Document::of_model(name, &model.map_err(in_file)?), false))
            }
        }
    }

    /// Reads the files that a scene names.
    async fn fetch_all(&self, file: &SceneFile, source: &Throttled<'_>) -> Result<(), InputError> {
        for name in file.files() {
            let called = file.package_name(&name).map_or_else(|| name.display().to_string(), str::to_owned);
            self.teller.step(format!("reading {called}")).await;
            // One that is missing is told by the scene, with the path in it.
            let _ = self.fetch(&name, called, source).await;
        }
        Ok(())
    }

    /// Reads a file, if it was not read before. The panel lists it as `called`.
    async fn fetch(&self, name: &Path, called: String, source: &Throttled<'_>) -> io::Result<()> {
        if self.files.borrow().contains_key(name) {
            return Ok(());
        }
        let start = web_time::Instant::now();
        let bytes = loop {
            match source.read(name).await {
                Err(error)
                    if error.kind() == io::ErrorKind::ResourceBusy
                        && self.waits(&format!("it is preparing {called}")) =>
                {
                    sleep(PAUSE).await;
                }
                read => break read?,
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        self.teller.tell(News::Arrived(Arrival { name: called, bytes: bytes.len(), seconds }));
        self.files.borrow_mut().insert(name.to_owned(), bytes);
        Ok(())
    }

    /// Does work that reads files, again after those that it lacked have arrived, until it lacks none.
    async fn retried<T>(
        &self,
        source: &Throttled<'_>,
        what: &str,
        work: impl Fn(&dyn Fn(&Path) -> io::Result<Vec<u8>>) -> Result<T, InputError>,
    ) -> Result<T, InputError> {
        // Why files cannot be read.
        let mut refused: BTreeMap<PathBuf, (io::ErrorKind, String)> = BTreeMap::new();
        loop {
            self.teller.step(what).await;
            self.files.borrow().values().for_each(|file| images::note(file));
            self.decode().await;
            let lacking = RefCell::new(BTreeSet::new());
            let read = |name: &Path| match (self.files.borrow().get(name), refused.get(name)) {
                (Some(bytes), _) => Ok(bytes.to_vec()),
                (None, Some((kind, why))) => Err(io::Error::new(*kind, why.clone())),
                (None, None) => {
                    lacking.borrow_mut().insert(name.to_owned());
                    Err(io::ErrorKind::NotFound.into())
                }
            };
            let done = work(&read);
            // Also those whose texels are read later.
            let has_decoded = self.decode().await;
            let lacking = lacking.into_inner();
            if done.is_ok() || (lacking.is_empty() && !has_decoded) {
                return done;
            }
            for name in lacking {
                self.teller.step(format!("reading {}", name.display())).await;
                let called = name.display().to_string();
                if let Err(error) = self.fetch(&name, called, source).await {
                    refused.insert(name, (error.kind(), error.to_string()));
                }
            }
        }
    }
}

/// Prefix of the names of models that were prepared before.
const PREPARED: &str = "prepared ";

/// Built-in models, and those that were prepared before.
struct Prepared<'a>(&'a HashMap<String, Arc<Model>>);

impl BuiltIns for Prepared<'_> {
    fn model(&self, name: &str) -> Result<Model, InputError> {
        match name.strip_prefix(PREPARED).and_then(|name| self.0.get(name)) {
            Some(model) => Ok(Model::clone(model)),
            None => Samples.model(name),
        }
    }

    fn map(&self, name: &str) -> Result<(HeightMap, RgbaImage), InputError> {
        Samples.map(name)
    }
}

/// Low and high corner around all instances but those of endless terrain; `None` if there are none.
fn bounds(world: &World) -> Option<[DVec3; 2]> {
    let scene = &world.scene;
    let is_endless = |object| scene.terrain_statistics(object).is_ok();
    let objects = world.objects.iter().map(|object| object.object).filter(|object| !is_endless(*object));
    let instances = objects.filter_map(|object| scene.instances(object).ok()).flatten();
    let all = instances.filter_map(|instance| Some(scene.bounds(instance).ok()?.world()));
    all.reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)])
}

/// The size of a scene, in world units.
fn extent(world: &World) -> f64 {
    bounds(world).map_or(100.0, |[low, high]| (high - low).length().max(1e-3))
}

/// The distance of what the middle of a camera's picture shows, in world units.
fn focus_distance(world: &World, camera: &relievo::scene::Camera) -> Option<f64> {
    let middle = camera.viewport.map(|edge| 0.5 * edge as f32);
    let ray = relievo::scene::Ray::through(camera, middle).ok()?;
    let hit = world.scene.pick(&ray).ok()??;
    Some(hit.world().distance(camera.world()).max(1e-3))
}

/// Puts the camera where it shows the whole scene. Returns the scene's extent.
fn frame(document: &mut Document, world: &mut World) -> Result<f64, Error> {
    let (at, look, extent) = if document.is_endless() { over_land(document, world) } else { before(world) };
    document.set_camera(at, look);
    match document.is_endless() {
        true => document.set_planes(2e-5 * extent, Some(2.0 * extent)),
        false => document.set_planes(1e-3 * extent, None),
    }
    world.camera = document.file()?.camera().clone();
    Ok(if document.is_endless() { 0.02 * extent } else { extent })
}

/// A place before a model or over patches, from which all of it fills the picture; and its extent.
fn before(world: &World) -> (DVec3, DVec3, f64) {
    let is_model = |object: &relievo_scene_file::WorldObject| object.kind != WorldKind::Terrain;
    let tight = world.objects.iter().filter(|object| is_model(object)).find_map(|object| {
        let instance = *world.scene.instances(object.object).ok()?.first()?;
        Some(world.scene.tight_bounds(instance).ok()?.world())
    });
    let [low, high] = tight.or_else(|| bounds(world)).unwrap_or([DVec3::ZERO, DVec3::ONE]);
    let (middle, extent) = (0.5 * (low + high), (high - low).length().max(1e-6));
    let distance = 0.5 * extent / (0.5_f64 * 0.8).sin() * 1.02;
    let up = if tight.is_some() { 0.28 } else { 0.75 };
    (middle + distance * DVec3::new(0.42, up, 0.86).normalize(), middle, extent)
}

/// A place above endless terrain that shows it up to the horizon; and the distance up to which the terrain is drawn.
fn over_land(document: &Document, world: &World) -> (DVec3, DVec3, f64) {
    let number = |name: &str, otherwise: f64| document.terrain_number(name).unwrap_or(otherwise);
    let edge = (number("patchSize", 65.0) - 1.0) * number("terrainScale", 1.0);
    let spacing = edge * 2.0_f64.powf(number("coarseLevels", 0.0));
    let land = world.objects.iter().find(|object| object.kind == WorldKind::Terrain);
    let height = |x: f64, z: f64| {
        land.and_then(|land| Some(world.scene.ground(land.object, x, z).ok()??.height)).unwrap_or(0.0)
    };
    // Above the highest of some places around, looking along the valley that lies lowest.
    let around = (0..16).map(|at| f64::from(at) * std::f64::consts::TAU / 16.0);
    let spots = around.map(|angle| (0.12 * spacing * DVec3::new(angle.sin(), 0.0, angle.cos()), angle));
    let above = 0.025 * spacing + height(0.0, 0.0);
    let lowest =
        spots.map(|(spot, _)| spot.with_y(height(spot.x, spot.z))).min_by(|a, b| a.y.total_cmp(&b.y));
    let look = lowest.unwrap_or(DVec3::new(0.0, 0.0, -spacing));
    let at = DVec3::new(0.0, above.max(look.y + 0.05 * spacing), 0.0);
    (at, look.with_y(0.5 * (at.y + look.y)), 1.5 * spacing)
}
