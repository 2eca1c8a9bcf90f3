//! A server on localhost, with the models of the tests.

use std::io::{Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use relievo::asset::package::PackageHeader;
use relievo::asset::{Model, ModelFile};
use relievo_delivery::catalog::Catalog;
use relievo_delivery::server::{ServeOptions, Server, Site};
use tempfile::TempDir;

/// A folder with a rock as .glb and a creature as a package. It is shared by all tests.
pub fn models() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let rock = relievo_samples::model("rock").expect("built in").to_glb().expect("a file");
        std::fs::write(folder.path().join("rock.glb"), rock).expect("written");
        std::fs::write(folder.path().join("creature.rlv"), creature()).expect("written");
        std::fs::write(folder.path().join("notes.txt"), "no model").expect("written");
        // Other tests find the packages in the cache.
        let site = runtime().block_on(Site::open(options(folder.path()), built_ins())).expect("a site");
        assert!(runtime().block_on(site.cook(&|_, _| {})).is_empty());
        folder
    });
    folder.path()
}

/// The package of the creature.
pub fn creature() -> &'static [u8] {
    static PACKAGE: OnceLock<Vec<u8>> = OnceLock::new();
    PACKAGE.get_or_init(|| package("creature"))
}

/// The package of the rock.
pub fn rock() -> &'static [u8] {
    static PACKAGE: OnceLock<Vec<u8>> = OnceLock::new();
    PACKAGE.get_or_init(|| package("rock"))
}

/// A package of a few thousand bytes: the rock's five coarsest levels.
pub fn pebble() -> &'static [u8] {
    static PACKAGE: OnceLock<Vec<u8>> = OnceLock::new();
    PACKAGE.get_or_init(|| {
        let (header, _) = PackageHeader::read(rock()).expect("a header");
        let coarse = Model::from_rlv(&rock()[..header.levels[4].chunk.end]).expect("ends with a level");
        cooked(&coarse.into())
    })
}

/// The package of a built-in model, made from its .glb file.
fn package(name: &str) -> Vec<u8> {
    let glb = relievo_samples::model(name).expect("built in").to_glb().expect("a file");
    let file =
        ModelFile::from_bytes_beside("model.glb".as_ref(), &glb, &|_| unreachable!()).expect("a model");
    cooked(&file)
}

fn cooked(file: &ModelFile) -> Vec<u8> {
    let go_on = &mut |_| std::ops::ControlFlow::Continue(());
    relievo::ops::skinning::cook(file, go_on).expect("cooked").expect("not broken off")
}

pub fn built_ins() -> Box<dyn relievo_scene_file::BuiltIns + Send + Sync> {
    Box::new(relievo_samples::Samples)
}

pub fn runtime() -> &'static tokio::runtime::Runtime {
    static RUNTIME: OnceLock<tokio::runtime::Runtime> = OnceLock::new();
    RUNTIME.get_or_init(|| tokio::runtime::Runtime::new().expect("a runtime"))
}

/// Options of a server of a folder of models, at a port of the system's choice.
pub fn options(models: &Path) -> ServeOptions {
    ServeOptions {
        models: Some(models.to_string_lossy().into_owned()),
        listen: "127.0.0.1:0".to_owned(),
        ..ServeOptions::default()
    }
}

/// Makes the models of a site at once on three servers. Returns their catalogs, which are equal, and how many of them worked on
/// the rock.
pub fn cook_on_three(open: &(dyn Fn() -> Site + Sync)) -> (Catalog, usize) {
    let cook = || {
        let (site, steps) = (open(), AtomicUsize::new(0));
        let failed = runtime().block_on(site.cook(&|name, _| {
            steps.fetch_add(usize::from(name == "rock"), Ordering::Relaxed);
        }));
        assert!(failed.is_empty(), "{failed:?}");
        (site.catalog(), steps.into_inner() > 0)
    };
    let all = std::thread::scope(|scope| {
        [(); 3].map(|()| scope.spawn(cook)).map(|one| one.join().expect("no panic"))
    });
    assert!(all.iter().all(|(catalog, _)| *catalog == all[0].0));
    (all[0].0.clone(), all.iter().filter(|(_, has_worked)| *has_worked).count())
}

/// A running server. It ends with the value.
pub struct Host {
    pub address: SocketAddr,
    pub site: Site,
    stop: Option<tokio::sync::oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Host {
    /// Serves what the options say, once all models are ready.
    pub fn start(options: ServeOptions) -> Self {
        let site = runtime().block_on(Site::open(options, built_ins())).expect("a site");
        let failed = runtime().block_on(site.cook(&|_, _| {}));
        assert!(failed.is_empty(), "{failed:?}");
        Self::of(site)
    }

    /// Serves a site as it is.
    pub fn of(site: Site) -> Self {
        let server = runtime().block_on(Server::bind(&site)).expect("a free port");
        let address = server.address().expect("an address");
        let (stop, stopped) = tokio::sync::oneshot::channel();
        let thread = std::thread::spawn(move || {
            let ended = runtime().block_on(server.run(async { drop(stopped.await) }));
            ended.expect("an orderly end");
        });
        Self { address, site, stop: Some(stop), thread: Some(thread) }
    }

    pub fn base(&self) -> String {
        format!("http://{}", self.address)
    }

    /// The answer to a `GET` request with further headers.
    pub fn get(&self, path: &str, headers: &[(&str, &str)]) -> Answer {
        self.ask("GET", path, headers)
    }

    pub fn ask(&self, method: &str, path: &str, headers: &[(&str, &str)]) -> Answer {
        let mut text = format!("{method} {path} HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n");
        headers.iter().for_each(|(name, value)| text += &format!("{name}: {value}\r\n"));
        self.send(format!("{text}\r\n").as_bytes())
    }

    /// The answer to raw bytes.
    pub fn send(&self, bytes: &[u8]) -> Answer {
        let mut stream = TcpStream::connect(self.address).expect("a connection");
        stream.set_read_timeout(Some(Duration::from_secs(30))).expect("a timeout");
        // A server that refuses may close before all is sent.
        let _ = stream.write_all(bytes);
        let mut all = Vec::new();
        let _ = stream.read_to_end(&mut all);
        Answer::read(&all)
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            let ended = thread.join();
            assert!(std::thread::panicking() || ended.is_ok(), "the server panicked");
        }
    }
}

/// An answer of HTTP.
#[derive(Debug, Clone)]
pub struct Answer {
    /// 0 if there is none.
    pub status: u16,
    headers: Vec<(String, String)>,
    pub body: Vec<u8>,
}

impl Answer {
    fn read(bytes: &[u8]) -> Self {
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n");
        let Some(end) = end else { return Self { status: 0, headers: Vec::new(), body: Vec::new() } };
        let head = String::from_utf8_lossy(&bytes[..end]);
        let mut lines = head.lines();
        let status = lines.next().and_then(|line| line.split(' ').nth(1)?.parse().ok()).unwrap_or(0);
        let header = |line: &str| {
            line.split_once(": ").map(|(name, value)| (name.to_ascii_lowercase(), value.to_owned()))
        };
        Self { status, headers: lines.filter_map(header).collect(), body: bytes[end + 4..].to_vec() }
    }

    pub fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(own, _)| own == name).map(|(_, value)| &**value)
    }

    pub fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.body).expect("JSON")
    }

    /// What is wrong, as the server says.
    pub fn error(&self) -> String {
        self.json()["error"].as_str().unwrap_or_default().to_owned()
    }
}
