//! Scenes of a site, whose objects appear coarsest first: what is asked for, at which rate it may come, and what came.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use relievo::gpu::Gpu;
use relievo::scene::View;
use relievo::{Error, InputError};
#[cfg(target_arch = "wasm32")]
use relievo_delivery::client::BrowserTransport as Inner;
#[cfg(not(target_arch = "wasm32"))]
use relievo_delivery::client::HttpTransport as Inner;
use relievo_delivery::client::{
    Answer, FetchState, Fetcher, FetcherOptions, ModelKey, Request, RequestId, StreamedScene, Traffic,
    Transport, Want,
};
use relievo_samples::Samples;
use relievo_scene_file::{LoadedScene, SceneFile, World};
use web_time::Instant;

use crate::images::{self, Decoded};
use crate::load::Arrival;
use crate::source::sleep;

/// Seconds between two looks at what has arrived, while nothing is drawn.
const LOOK: f64 = 0.004;

/// A request that runs.
#[derive(Debug, Clone)]
pub struct Asked {
    /// The name of the package; for other files, the end of the address.
    pub name: String,
    /// The bytes that were asked for; `None` for the whole file.
    pub range: Option<Range<u64>>,
    /// Number of bytes that have come.
    pub bytes: usize,
    began: Instant,
}

/// The requests of a scene: lists them, and limits how fast their bytes come.
pub(crate) struct Wire {
    inner: Inner,
    /// Bits a second; `None` for no limit.
    rate: Option<f64>,
    /// Bytes that may come now, and when that was counted.
    credit: f64,
    counted: Instant,
    /// Parts of answers that may not come yet.
    held: VecDeque<(RequestId, Answer)>,
    asked: BTreeMap<RequestId, Asked>,
    /// Names of packages, by the names of their files.
    names: BTreeMap<String, String>,
    arrivals: Vec<Arrival>,
    /// Why the last answer failed, if it did.
    failure: Option<String>,
}

impl Wire {
    fn new(rate: Option<f64>) -> Self {
        let (held, asked, names, arrivals, failure) = Default::default();
        let (inner, counted) = (Inner::new(), Instant::now());
        Self { inner, rate, credit: 0.0, counted, held, asked, names, arrivals, failure }
    }

    /// Takes a request from the list.
    fn end(&mut self, id: RequestId) {
        let Some(asked) = self.asked.remove(&id).filter(|asked| asked.bytes > 0) else { return };
        let name = match &asked.range {
            Some(range) => format!("{} from {}", asked.name, range.start),
            None => asked.name,
        };
        self.arrivals.push(Arrival {
            name,
            bytes: asked.bytes,
            seconds: asked.began.elapsed().as_secs_f64(),
        });
    }

    /// The part of an answer that may come now; the rest is held back.
    fn allowed(&mut self, id: RequestId, mut bytes: Vec<u8>) -> Option<Vec<u8>> {
        if self.rate.is_some() {
            let rest = bytes.split_off(bytes.len().min(self.credit.max(0.0) as usize));
            self.credit -= bytes.len() as f64;
            if !rest.is_empty() {
                self.held.push_front((id, Answer::Bytes(rest)));
            }
        }
        (!bytes.is_empty()).then_some(bytes)
    }
}

impl Transport for Wire {
    fn start(&mut self, request: Request) -> RequestId {
        let file = request.url.rsplit('/').next().unwrap_or_default();
        let name = self.names.get(file).map_or(file, String::as_str).to_owned();
        let range = request.range.clone();
        let id = self.inner.start(request);
        self.asked.insert(id, Asked { name, range, bytes: 0, began: Instant::now() });
        id
    }

    fn cancel(&mut self, request: RequestId) {
        self.inner.cancel(request);
        self.held.retain(|(id, _)| *id != request);
        self.end(request);
    }

    fn poll(&mut self) -> Vec<(RequestId, Answer)> {
        let seconds = self.counted.elapsed().as_secs_f64();
        self.counted = Instant::now();
        // A connection that had nothing to send saves nothing for later.
        let saved = if self.held.is_empty() { 0.0 } else { self.credit };
        self.credit = saved + self.rate.map_or(0.0, |rate| seconds * rate / 8.0);
        self.held.extend(self.inner.poll());
        let mut parts = Vec::new();
        while let Some((id, answer)) = self.held.pop_front() {
            let answer = match answer {
                Answer::Bytes(bytes) => {
                    let Some(bytes) = self.allowed(id, bytes) else { break };
                    if let Some(asked) = self.asked.get_mut(&id) {
                        asked.bytes += bytes.len();
                    }
                    Answer::Bytes(bytes)
                }
                other => other,
            };
            match &answer {
                Answer::Head(head) if (200..300).contains(&head.status) => self.failure = None,
                Answer::Head(head) => self.failure = Some(format!("the server answers {}", head.status)),
                Answer::Failed(why) => self.failure = Some(why.clone()),
                Answer::Bytes(_) | Answer::End => {}
            }
            if let Answer::End | Answer::Failed(_) = answer {
                self.end(id);
            }
            parts.push((id, answer));
        }
        parts
    }
}

/// A package of the scene, as far as it is there.
#[derive(Debug, Clone)]
pub struct PackageState {
    /// The path in the scene file.
    pub path: PathBuf,
    /// The name of its object; without one, the path.
    pub name: String,
    /// Levels that are there, and levels of the package; 0 before its header is there.
    pub levels: [usize; 2],
    /// Images that are there, and images of the package.
    pub images: [usize; 2],
    /// What happens to it now.
    pub state: FetchState,
}

impl PackageState {
    /// Whether nothing is missing.
    pub fn is_whole(&self) -> bool {
        let [levels, images] = [self.levels, self.images].map(|[here, all]| here == all);
        self.levels[1] > 0 && levels && images
    }
}

/// What a scene has fetched, and goes on to fetch.
pub(crate) struct Fetching {
    fetcher: Fetcher<Wire>,
    /// The beginning of its time.
    began: Instant,
}

impl Fetching {
    /// Nothing yet, at a rate in bits a second.
    pub fn new(rate: Option<f64>) -> Self {
        let options = FetcherOptions::default();
        Self { fetcher: Fetcher::new(Wire::new(rate), options), began: Instant::now() }
    }

    /// Waits for the coarsest level of a package. `wait` is told what is wrong while the server does not answer.
    ///
    /// # Errors
    /// [`Error`] for what cannot be fetched, or is no package.
    pub async fn coarsest(&mut self, url: &str, wait: impl Fn(&str)) -> Result<relievo::asset::Model, Error> {
        let model = self.fetcher.add(url);
        loop {
            self.fetcher.want(&[Want { model, error: f32::MAX, weight: 1.0 }]);
            self.fetcher.update(self.began.elapsed());
            let in_file = |source: InputError| Error::InputFile { path: url.into(), source };
            if let Some(model) = self.fetcher.model(model).map_err(in_file)? {
                return Ok(model);
            }
            match self.fetcher.state(model) {
                FetchState::Failed(error) => return Err(error.into()),
                FetchState::Waiting { why, .. } => wait(&why.to_string()),
                FetchState::Idle | FetchState::Fetching => {}
            }
            sleep(LOOK).await;
        }
    }
}

/// A scene whose objects appear as they arrive.
pub(crate) struct Streaming {
    scene: StreamedScene<Wire>,
    began: Instant,
    /// Packages that cannot be fetched, and were told.
    told: BTreeSet<PathBuf>,
    /// Files whose images were decoded beforehand.
    decoded: Decoded,
}

impl Streaming {
    /// Whether all files of a scene can be fetched in this way: only packages come level by level, and the files that models of
    /// text name are not known before.
    pub fn suits(file: &SceneFile) -> bool {
        let is_text = |path: &PathBuf| {
            path.extension().is_some_and(|ending| {
                ending.eq_ignore_ascii_case("gltf") || ending.eq_ignore_ascii_case("obj")
            })
        };
        !file.packages().is_empty() && !file.files().iter().any(is_text)
    }

    /// Begins to fetch what a scene file names, relative to its address.
    pub fn new(file: SceneFile, url: &str, fetching: Fetching) -> Self {
        let Fetching { mut fetcher, began } = fetching;
        let named = |path: &PathBuf| {
            let end = path.file_name()?.to_string_lossy().into_owned();
            Some((end, file.package_name(path)?.to_owned()))
        };
        fetcher.transport_mut().names = file.packages().iter().filter_map(named).collect();
        Self {
            scene: StreamedScene::with_file(file, url, fetcher),
            began,
            told: BTreeSet::new(),
            decoded: Decoded::default(),
        }
    }

    /// Waits for everything but the packages. `wait` is told what is wrong while the server does not answer.
    ///
    /// # Errors
    /// As for [`StreamedScene::begin`].
    pub async fn begin(&mut self, gpu: &Gpu, wait: impl Fn(&str)) -> Result<LoadedScene, Error> {
        loop {
            let loaded = self.scene.begin(self.began.elapsed(), &Samples).map(|loaded| loaded.cloned());
            if loaded.is_err() {
                // All at once: the scene stops at the first image that it lacks.
                self.scene.files().for_each(images::note);
            }
            let files = images::decode(gpu).await;
            let has_decoded = !files.is_empty();
            self.decoded.0.extend(files);
            // With an image that it lacked, the scene may begin.
            if loaded.is_err() && has_decoded {
                continue;
            }
            if let Some(loaded) = loaded? {
                return Ok(loaded);
            }
            if let Some(why) = &self.scene.fetcher().transport().failure {
                wait(why);
            }
            sleep(LOOK).await;
        }
    }

    /// Waits until something is shown. `wait` is told what is wrong while the server does not answer.
    ///
    /// # Errors
    /// As for [`StreamedScene::update_async`]; [`Error`] if nothing of the scene can be fetched.
    pub async fn appear(&mut self, world: &mut World, wait: impl Fn(&str)) -> Result<(), Error> {
        while world.objects.is_empty() {
            self.update(world, &[]).await?;
            if let Some(why) = &self.scene.fetcher().transport().failure {
                wait(why);
            }
            let packages = self.packages();
            let failed = packages.iter().map(|package| match &package.state {
                FetchState::Failed(error) => Some(error),
                _ => None,
            });
            // All of them.
            if let Some(Some(error)) = failed.collect::<Option<Vec<_>>>().map(|all| all.first().copied()) {
                return Err(error.clone().into());
            }
            sleep(LOOK).await;
        }
        Ok(())
    }

    /// Shows what has arrived, and asks for what the views need. Whether the scene has changed.
    ///
    /// # Errors
    /// As for [`StreamedScene::update_async`].
    pub async fn update(&mut self, world: &mut World, views: &[&View]) -> Result<bool, Error> {
        let now = self.now();
        self.scene.receive(now);
        // The texels of a package's images are read when it is shown.
        self.decoded.0.extend(images::decode(world.scene.gpu()).await);
        let shown = self.scene.show_async(world, views).await;
        if self.is_settled() {
            self.decoded = Decoded::default();
        }
        shown
    }

    fn now(&self) -> Duration {
        self.began.elapsed()
    }

    /// Limits the rate of all transfers together, in bits a second.
    pub fn set_rate(&mut self, rate: Option<f64>) {
        self.scene.fetcher_mut().transport_mut().rate = rate;
    }

    /// Transfers that ended since the last call.
    pub fn arrivals(&mut self) -> Vec<Arrival> {
        std::mem::take(&mut self.scene.fetcher_mut().transport_mut().arrivals)
    }

    /// The requests that run.
    pub fn asked(&self) -> impl Iterator<Item = &Asked> {
        self.scene.fetcher().transport().asked.values()
    }

    /// What came over the wire so far.
    pub fn traffic(&self) -> Traffic {
        self.scene.fetcher().traffic()
    }

    /// The packages of the scene.
    pub fn packages(&self) -> Vec<PackageState> {
        let fetcher = self.scene.fetcher();
        let of = |(path, key): (&Path, ModelKey)| {
            let [levels, images] = fetcher.count(key).map_or([0, 0], |count| [count.levels, count.images]);
            let all = fetcher.header(key).map_or([0, 0], |header| [header.levels.len(), header.images.len()]);
            let file = path.file_name().map_or(Default::default(), |file| file.to_string_lossy());
            let name = fetcher.transport().names.get(&*file).cloned();
            PackageState {
                path: path.to_owned(),
                name: name.unwrap_or_else(|| path.display().to_string()),
                levels: [levels, all[0]],
                images: [images, all[1]],
                state: fetcher.state(key),
            }
        };
        self.scene.packages().map(of).collect()
    }

    /// Fetches what is lacking of all packages. Whether nothing is lacking any more, except what cannot be fetched.
    pub fn fetch_all(&mut self) -> bool {
        self.scene.fetch_all();
        let is_done =
            |package: PackageState| package.is_whole() || matches!(package.state, FetchState::Failed(_));
        self.packages().into_iter().all(is_done)
    }

    /// The packages that are whole, as files.
    pub fn whole(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let whole: BTreeSet<PathBuf> =
            self.packages().into_iter().filter(PackageState::is_whole).map(|package| package.path).collect();
        let packages = self.scene.packages().filter(|(path, _)| whole.contains(*path));
        packages.map(|(path, key)| (path.to_owned(), self.scene.fetcher().bytes(key))).collect()
    }

    /// Why nothing comes, and the seconds until the server is asked again; `None` while it answers.
    pub fn waits(&self) -> Option<(String, f64)> {
        let now = self.now();
        self.packages().into_iter().find_map(|package| match package.state {
            FetchState::Waiting { until, why } => {
                Some((why.to_string(), until.saturating_sub(now).as_secs_f64()))
            }
            _ => None,
        })
    }

    /// Packages that cannot be fetched, once each, with the reason.
    pub fn failures(&mut self) -> Vec<String> {
        let failed = self.packages().into_iter().filter_map(|package| match package.state {
            FetchState::Failed(error) => Some((package.path, error)),
            _ => None,
        });
        failed
            .filter(|(path, _)| self.told.insert(path.clone()))
            .map(|(_, error)| error.to_string())
            .collect()
    }

    /// Whether all that the views need is there, or cannot be fetched.
    pub fn is_settled(&self) -> bool {
        self.scene.is_settled()
    }

    /// Ends with what was fetched.
    pub fn into_fetching(self) -> Fetching {
        Fetching { began: self.began, fetcher: self.scene.into_fetcher() }
    }
}
