//! Decides what to fetch next, and keeps what has arrived.

use std::collections::BTreeMap;
use std::time::Duration;

use relievo::InputError;
use relievo::asset::Model;
use relievo::asset::package::{Package, PackageHeader};

use super::FetchError;
use super::stream::PackageStream;
use super::transport::{Answer, Head, Request, RequestId, Transport};

/// Attempts for a chunk whose hash is wrong, after which a model has failed.
const ATTEMPTS: u32 = 3;

/// Times between attempts: the first, and the longest.
const PAUSES: [Duration; 2] = [Duration::from_millis(250), Duration::from_secs(8)];

/// Gain for a byte of a model of which nothing is there, for each weight: before all finer levels.
const FIRST_GAIN: f64 = 1e30;

/// Identifies a model of a fetcher.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ModelKey(usize);

/// Identifies a file of a fetcher.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileKey(usize);

/// Options of a fetcher.
#[derive(Debug, Clone, PartialEq)]
pub struct FetcherOptions {
    /// Transfers at once, at least 1. Four use a connection well whose answers take long to begin.
    pub parallel: usize,
    /// Bytes of packages that are kept. Models that are not wanted are forgotten beyond it; wanted ones never are.
    pub cache: u64,
    /// The server's token, if it wants one.
    pub token: Option<String>,
}

impl Default for FetcherOptions {
    fn default() -> Self {
        Self { parallel: 4, cache: 256 << 20, token: None }
    }
}

/// How much of a model is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Want {
    /// The model.
    pub model: ModelKey,
    /// The largest error that views allow, in the model's units. The coarsest level within it is fetched, and its images.
    pub error: f32,
    /// What the model contributes to pictures, for example the pixels that it covers. Of the levels that can be fetched next, the one
    /// that removes the most error times weight for a byte comes first.
    pub weight: f32,
}

/// A model of which a further level, or further images, have arrived.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fetched {
    /// The model.
    pub model: ModelKey,
    /// Number of levels that are there now.
    pub levels: usize,
    /// Number of images that are there now.
    pub images: usize,
}

/// State of a model of a fetcher.
#[derive(Debug, Clone, PartialEq)]
pub enum FetchState {
    /// Nothing is being fetched: all that is wanted is there, or something else comes first.
    Idle,
    /// A transfer runs.
    Fetching,
    /// The server cannot be reached, or is not ready; it is asked again at this time.
    Waiting {
        /// The time, as of [`Fetcher::update`].
        until: Duration,
        /// What happened.
        why: FetchError,
    },
    /// It cannot be fetched.
    Failed(FetchError),
}

/// What came over the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Traffic {
    /// Bytes of content that arrived, used or not.
    pub received: u64,
    /// Requests that were sent.
    pub requests: u64,
    /// Transfers that were broken off because something else was wanted.
    pub cancelled: u64,
    /// Bytes of packages that are kept.
    pub kept: u64,
}

/// Fetches packages level by level, as far as they are wanted.
///
/// A program tells what it wants ([`Fetcher::want`]) and calls [`Fetcher::update`], both once a frame or less often. Neither
/// blocks. Decoding runs within `update`, one level at a time.
pub struct Fetcher<T> {
    transport: T,
    options: FetcherOptions,
    models: Vec<Entry>,
    files: Vec<FileEntry>,
    running: BTreeMap<RequestId, Running>,
    traffic: Traffic,
    updates: u64,
}

/// A model of a fetcher.
struct Entry {
    url: String,
    /// Strong tag of the package on the server.
    tag: Option<String>,
    stream: PackageStream,
    package: Option<Package>,
    want: Option<Want>,
    state: FetchState,
    /// Failures in a row.
    failures: u32,
    /// Number of images that were decoded.
    images: usize,
    /// When it was last wanted.
    wanted_at: u64,
}

/// A file that is fetched as a whole.
struct FileEntry {
    url: String,
    bytes: Vec<u8>,
    running: Option<RequestId>,
    /// Failures in a row, and when to ask again.
    failures: u32,
    until: Duration,
    is_complete: bool,
    failed: Option<FetchError>,
}

/// A request that runs.
struct Running {
    model: usize,
    /// Index of the first byte that was asked for, and of the next one, in the file.
    start: u64,
    at: u64,
    end: u64,
    /// Bytes to leave out, of a server that knows no ranges.
    skip: u64,
}

/// A transfer that is worth something.
struct Candidate {
    model: usize,
    range: std::ops::Range<u64>,
    /// Larger is better.
    gain: f64,
}

impl<T: Transport> Fetcher<T> {
    /// A fetcher without models.
    pub fn new(transport: T, options: FetcherOptions) -> Self {
        let (models, files, running, traffic) = Default::default();
        Self { transport, options, models, files, running, traffic, updates: 0 }
    }

    /// Adds the package at an address. The same address gives the same key.
    pub fn add(&mut self, url: &str) -> ModelKey {
        if let Some(at) = self.models.iter().position(|entry| entry.url == url) {
            return ModelKey(at);
        }
        self.models.push(Entry::new(url.to_owned()));
        ModelKey(self.models.len() - 1)
    }

    /// Adds a file that is fetched as a whole, before all models. The same address gives the same key.
    pub fn add_file(&mut self, url: &str) -> FileKey {
        if let Some(at) = self.files.iter().position(|file| file.url == url) {
            return FileKey(at);
        }
        let (bytes, running, failed) = Default::default();
        let (url, until) = (url.to_owned(), Duration::ZERO);
        self.files.push(FileEntry { url, bytes, running, failures: 0, until, is_complete: false, failed });
        FileKey(self.files.len() - 1)
    }

    /// The content of a file; `None` until it is there.
    ///
    /// # Errors
    /// [`FetchError`] if it cannot be fetched.
    pub fn file(&self, file: FileKey) -> Result<Option<&[u8]>, FetchError> {
        let file = &self.files[file.0];
        match &file.failed {
            Some(error) => Err(error.clone()),
            None => Ok(file.is_complete.then_some(&file.bytes)),
        }
    }

    /// Replaces what is wanted. Transfers of models that are not in the list any more are broken off; their bytes are kept.
    pub fn want(&mut self, wants: &[Want]) {
        self.models.iter_mut().for_each(|entry| entry.want = None);
        for want in wants {
            if let Some(entry) = self.models.get_mut(want.model.0) {
                let more = |own: Want| Want {
                    error: own.error.min(want.error),
                    weight: own.weight.max(want.weight),
                    ..own
                };
                entry.want = Some(entry.want.map_or(*want, more));
                entry.wanted_at = self.updates;
            }
        }
    }

    /// Takes in what has arrived, decodes it, and asks for what comes next. `now` is the time since any fixed moment. Returns the
    /// models that have more than before.
    pub fn update(&mut self, now: Duration) -> Vec<Fetched> {
        self.updates += 1;
        for (id, answer) in self.transport.poll() {
            match self.files.iter_mut().find(|file| file.running == Some(id)) {
                Some(file) => {
                    if let Answer::Bytes(bytes) = &answer {
                        self.traffic.received += bytes.len() as u64;
                    }
                    file.take(answer, now);
                    if file.running.is_none() {
                        // Nothing that this request still brings is taken.
                        self.transport.cancel(id);
                    }
                }
                None => self.take(id, answer, now),
            }
        }
        let mut free = self.options.parallel.max(1);
        free = free.saturating_sub(self.files.iter().filter(|file| file.running.is_some()).count());
        for file in &mut self.files {
            let is_open = !file.is_complete && file.failed.is_none();
            if free > 0 && is_open && file.running.is_none() && file.until <= now {
                free -= 1;
                let token = self.options.token.clone();
                file.running = Some(self.transport.start(Request { token, ..Request::whole(&file.url) }));
                self.traffic.requests += 1;
            }
        }
        let mut fetched = Vec::new();
        for at in 0..self.models.len() {
            let before = self.models[at].count();
            if let Err(error) = self.models[at].decode() {
                let url = self.models[at].url.clone();
                self.models[at].state = FetchState::Failed(FetchError::Content { url, source: error });
            }
            let [levels, images] = self.models[at].count();
            if before != [levels, images] {
                fetched.push(Fetched { model: ModelKey(at), levels, images });
            }
        }
        self.schedule(now);
        self.forget();
        fetched
    }

    /// The model as far as it has arrived; `None` before its first level.
    ///
    /// # Errors
    /// [`InputError`] for a package whose parts do not fit together.
    pub fn model(&self, model: ModelKey) -> Result<Option<Model>, InputError> {
        let package = self.models.get(model.0).and_then(|entry| entry.package.as_ref());
        package.filter(|package| package.levels() > 0).map(Package::model).transpose()
    }

    /// The header of a model's package, once it is there.
    pub fn header(&self, model: ModelKey) -> Option<&PackageHeader> {
        self.models.get(model.0)?.stream.header()
    }

    /// What is there of a model; `None` for one that is not the fetcher's.
    pub fn count(&self, model: ModelKey) -> Option<Fetched> {
        let [levels, images] = self.models.get(model.0)?.count();
        Some(Fetched { model, levels, images })
    }

    /// The bytes of a model's package up to the last chunk that is complete.
    pub fn bytes(&self, model: ModelKey) -> Vec<u8> {
        self.models.get(model.0).map_or_else(Vec::new, |entry| entry.stream.complete())
    }

    /// The state of a model.
    pub fn state(&self, model: ModelKey) -> FetchState {
        let url = || FetchError::Network { url: String::new(), reason: "no such model".to_owned() };
        self.models.get(model.0).map_or_else(|| FetchState::Failed(url()), |entry| entry.state.clone())
    }

    /// Whether everything that is wanted is there, or has failed.
    pub fn is_settled(&self) -> bool {
        let is_done = |file: &FileEntry| file.is_complete || file.failed.is_some();
        let is_settled =
            |entry: &Entry| matches!(entry.state, FetchState::Failed(_)) || entry.candidate().is_none();
        self.files.iter().all(is_done) && self.models.iter().all(is_settled)
    }

    /// What came over the wire so far.
    pub fn traffic(&self) -> Traffic {
        let kept = self.models.iter().map(|entry| entry.stream.len()).sum();
        Traffic { kept, ..self.traffic }
    }

    /// What carries out the requests.
    pub fn transport(&self) -> &T {
        &self.transport
    }

    /// Mutable form of [`Fetcher::transport`].
    pub fn transport_mut(&mut self) -> &mut T {
        &mut self.transport
    }

    fn take(&mut self, id: RequestId, answer: Answer, now: Duration) {
        let Some(running) = self.running.get_mut(&id) else { return };
        let entry = &mut self.models[running.model];
        let url = entry.url.clone();
        let network = |reason: String| FetchError::Network { url: url.clone(), reason };
        let failed = match answer {
            Answer::Head(head) => match entry.accept(&head, running) {
                Ok(()) => return,
                Err(Refused::Retry(error)) => Some((error, head.retry_after)),
                Err(Refused::Failed(error)) => {
                    entry.state = FetchState::Failed(error);
                    None
                }
            },
            Answer::Bytes(bytes) => {
                self.traffic.received += bytes.len() as u64;
                let skip = (bytes.len() as u64).min(running.skip);
                running.skip -= skip;
                let most = (running.end - running.at) as usize;
                let new = &bytes[skip as usize..];
                let new = &new[..new.len().min(most)];
                match entry.stream.push(running.at, new) {
                    Ok(()) => {
                        running.at += new.len() as u64;
                        if running.at < running.end {
                            return;
                        }
                        (entry.failures, entry.state) = (0, FetchState::Idle);
                        None
                    }
                    Err(damaged) => {
                        let error = FetchError::Content { url: url.clone(), source: damaged.0 };
                        if entry.failures + 1 >= ATTEMPTS {
                            entry.state = FetchState::Failed(error);
                            None
                        } else {
                            Some((error, None))
                        }
                    }
                }
            }
            Answer::End if running.at == running.start => {
                Some((network("the answer is empty".to_owned()), None))
            }
            // The server ended early: what came is kept, and the rest is asked for.
            Answer::End => {
                entry.state = FetchState::Idle;
                None
            }
            Answer::Failed(reason) => Some((network(reason), None)),
        };
        if let Some((why, after)) = failed {
            let until = now + after.unwrap_or(pause(entry.failures));
            entry.failures += 1;
            entry.state = FetchState::Waiting { until, why };
        }
        self.transport.cancel(id);
        self.running.remove(&id);
    }

    /// Starts the transfers that gain the most, and breaks off those that are not wanted any more.
    fn schedule(&mut self, now: Duration) {
        let models = self.models.iter_mut().enumerate();
        let mut candidates: Vec<Candidate> = models
            .filter_map(|(model, entry)| {
                if matches!(entry.state, FetchState::Waiting { until, .. } if until <= now) {
                    entry.state = FetchState::Idle;
                }
                let is_ready = matches!(entry.state, FetchState::Idle | FetchState::Fetching);
                let (range, gain) = entry.candidate().filter(|_| is_ready)?;
                Some(Candidate { model, range, gain })
            })
            .collect();
        candidates.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        candidates.truncate(self.options.parallel.max(1));
        let is_wanted = |running: &Running| {
            let own = |candidate: &&Candidate| candidate.model == running.model;
            candidates.iter().find(own).is_some_and(|candidate| running.at < candidate.range.end)
        };
        let gone: Vec<RequestId> =
            self.running.iter().filter(|(_, running)| !is_wanted(running)).map(|(id, _)| *id).collect();
        for id in gone {
            self.transport.cancel(id);
            self.traffic.cancelled += 1;
            if let Some(running) = self.running.remove(&id) {
                self.models[running.model].state = FetchState::Idle;
            }
        }
        for Candidate { model, range, .. } in candidates {
            if self.running.values().any(|running| running.model == model) {
                continue;
            }
            let entry = &mut self.models[model];
            let request = Request {
                url: entry.url.clone(),
                range: Some(range.clone()),
                if_match: entry.tag.clone(),
                token: self.options.token.clone(),
            };
            let id = self.transport.start(request);
            entry.state = FetchState::Fetching;
            let (at, end) = (range.start, range.end);
            self.running.insert(id, Running { model, start: at, at, end, skip: 0 });
            self.traffic.requests += 1;
        }
    }

    /// Forgets models that are not wanted, those that were wanted longest ago first, until the cache fits.
    fn forget(&mut self) {
        let mut kept: u64 = self.models.iter().map(|entry| entry.stream.len()).sum();
        while kept > self.options.cache {
            let is_free = |entry: &&mut Entry| entry.want.is_none() && !entry.stream.is_empty();
            let Some(oldest) = self.models.iter_mut().filter(is_free).min_by_key(|entry| entry.wanted_at)
            else {
                break;
            };
            kept -= oldest.stream.len();
            *oldest = Entry { wanted_at: oldest.wanted_at, ..Entry::new(oldest.url.clone()) };
        }
    }
}

/// The time to wait after a number of failures in a row.
fn pause(failures: u32) -> Duration {
    (PAUSES[0] * 2_u32.pow(failures.min(5))).min(PAUSES[1])
}

impl FileEntry {
    fn take(&mut self, answer: Answer, now: Duration) {
        let after = match answer {
            Answer::Head(Head { status: 200, .. }) => {
                self.bytes.clear();
                return;
            }
            Answer::Bytes(bytes) => {
                self.bytes.extend(bytes);
                return;
            }
            Answer::End => {
                let Some(damaged) = self.damaged() else {
                    (self.running, self.is_complete) = (None, true);
                    return;
                };
                if self.failures + 1 >= ATTEMPTS {
                    self.failed = Some(FetchError::Content { url: self.url.clone(), source: damaged });
                }
                None
            }
            Answer::Head(Head { status, retry_after, .. }) if super::is_passing(status) => retry_after,
            Answer::Head(Head { status, .. }) => {
                let (url, message) = (self.url.clone(), String::new());
                self.failed = Some(FetchError::Status { url, status, message });
                None
            }
            Answer::Failed(_) => None,
        };
        self.running = None;
        self.until = now + after.unwrap_or(pause(self.failures));
        self.failures += 1;
    }

    /// The error of a file whose name is a hash, and whose content has another one.
    fn damaged(&self) -> Option<InputError> {
        let name = self.url.rsplit('/').next().unwrap_or_default();
        let name = name.split('.').next().unwrap_or_default();
        let is_hash = name.len() == 64 && name.bytes().all(|byte| byte.is_ascii_hexdigit());
        let found = crate::sha256(&self.bytes);
        let bound = || format!("must be {name}, the name of the file");
        (is_hash && found != name).then(|| InputError::new("sha256", found, bound()))
    }
}

/// Why the head of an answer is refused.
enum Refused {
    /// The next attempt may succeed.
    Retry(FetchError),
    Failed(FetchError),
}

impl Entry {
    fn new(url: String) -> Self {
        Self {
            url,
            tag: None,
            stream: PackageStream::new(),
            package: None,
            want: None,
            state: FetchState::Idle,
            failures: 0,
            images: 0,
            wanted_at: 0,
        }
    }

    /// Number of levels and images that were decoded.
    fn count(&self) -> [usize; 2] {
        [self.package.as_ref().map_or(0, Package::levels), self.images]
    }

    /// Decodes the chunks that have arrived.
    fn decode(&mut self) -> Result<(), InputError> {
        let Some(header) = self.stream.header() else { return Ok(()) };
        if self.package.is_none() {
            if self.stream.chunk(&header.model).is_none() {
                return Ok(());
            }
            self.package = Some(Package::new(&self.stream.beginning())?);
        }
        let Some(package) = &mut self.package else { return Ok(()) };
        while let Some(level) = header.levels.get(package.levels())
            && let Some(chunk) = self.stream.chunk(&level.chunk)
        {
            package.add_level(chunk)?;
        }
        while let Some(image) = header.images.get(self.images)
            && let Some(chunk) = self.stream.chunk(image)
        {
            package.add_image(chunk)?;
            self.images += 1;
        }
        Ok(())
    }

    /// What to fetch next, and what it gains.
    fn candidate(&self) -> Option<(std::ops::Range<u64>, f64)> {
        let want = self.want?;
        let weight = f64::from(want.weight.max(f32::MIN_POSITIVE));
        let Some(header) = self.stream.header() else {
            // Nothing is known: what covers most comes first, before anything that is there already.
            return Some((self.stream.missing(0)?, weight * FIRST_GAIN));
        };
        let count = header.levels.len();
        let wanted = header.levels.iter().position(|level| level.error <= want.error).unwrap_or(count - 1);
        let there = self.stream.levels();
        if there <= wanted {
            let range = self.stream.missing(count - 1 - there)?;
            let bytes = (range.end - range.start) as f64;
            let gain = match there.checked_sub(1) {
                None => FIRST_GAIN,
                Some(last) => {
                    f64::from(header.levels[last].error - want.error.min(header.levels[last].error)) / bytes
                }
            };
            return Some((range, weight * gain));
        }
        // Images of what is there: they matter most where levels are fine enough already.
        let range = self.stream.missing_images()?;
        let bytes = (range.end - range.start) as f64;
        Some((range, weight * f64::from(want.error.min(f32::MAX)) / bytes))
    }

    /// Checks the head of an answer.
    fn accept(&mut self, head: &Head, running: &mut Running) -> Result<(), Refused> {
        let url = self.url.clone();
        let status = head.status;
        let refused = FetchError::Status { url: url.clone(), status, message: String::new() };
        match status {
            200 | 206 if head.start <= running.at => {
                running.skip = running.at - head.start;
                let is_new = self.tag.is_none();
                if is_new {
                    self.tag.clone_from(&head.tag);
                }
                if let Some(total) = head.total {
                    running.end = running.end.min(total.max(running.at));
                }
                Ok(())
            }
            200 | 206 => {
                let bound = format!("must be {}, what was asked for", running.at);
                let source = InputError::new("content-range", head.start, bound);
                Err(Refused::Failed(FetchError::Content { url, source }))
            }
            // The package has changed: what is there belongs to the old one.
            412 => {
                let want = self.want;
                *self = Self { want, wanted_at: self.wanted_at, ..Self::new(url) };
                Err(Refused::Retry(refused))
            }
            status if super::is_passing(status) => Err(Refused::Retry(refused)),
            _ => Err(Refused::Failed(refused)),
        }
    }
}
