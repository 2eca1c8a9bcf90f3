//! Where files come from: a folder, memory (dropped files, and scenes that the viewer brings along), or a site.

use std::collections::HashMap;
use std::future::Future;
use std::io;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::sync::Arc;

use relievo::InputError;
#[cfg(not(target_arch = "wasm32"))]
use relievo_delivery::client::FetchError;
use relievo_delivery::client::beside;

/// The bytes of a file, once they are there.
pub type Reading<'a> = Pin<Box<dyn Future<Output = io::Result<Arc<[u8]>>> + 'a>>;

/// A source of files. Names are relative to the first file that is opened.
pub trait Source: wgpu::WasmNotSendSync {
    /// Reads a whole file.
    fn read<'a>(&'a self, name: &'a Path) -> Reading<'a>;

    /// The absolute address of a file, for sources that are sites: packages come from there level by level.
    fn url(&self, _name: &Path) -> Option<String> {
        None
    }
}

/// Files below a folder.
#[cfg(not(target_arch = "wasm32"))]
#[derive(Debug, Clone)]
pub struct Folder(pub PathBuf);

#[cfg(not(target_arch = "wasm32"))]
impl Source for Folder {
    fn read<'a>(&'a self, name: &'a Path) -> Reading<'a> {
        Box::pin(async move { Ok(std::fs::read(self.0.join(name))?.into()) })
    }
}

/// Files in memory: those dropped onto the viewer together, and the scenes that it brings along.
#[derive(Debug, Clone, Default)]
pub struct Memory(HashMap<PathBuf, Arc<[u8]>>);

impl Memory {
    /// Adds a file.
    #[must_use]
    pub fn with(mut self, name: impl Into<PathBuf>, bytes: impl Into<Arc<[u8]>>) -> Self {
        self.0.insert(name.into(), bytes.into());
        self
    }
}

impl Source for Memory {
    fn read<'a>(&'a self, name: &'a Path) -> Reading<'a> {
        // What is dropped has no folders, but may name its textures by a path.
        let own = |name: &Path| self.0.get(name).cloned();
        let found = own(name).or_else(|| own(Path::new(name.file_name()?)));
        let missing =
            || io::Error::new(io::ErrorKind::NotFound, "it was not dropped together with the others");
        Box::pin(async move { found.ok_or_else(missing) })
    }
}

/// Files of a site, by HTTP.
#[derive(Debug, Clone)]
pub struct Site {
    /// The absolute address of the first file.
    pub url: String,
}

/// The status of a file that a server is still preparing.
const NOT_READY: u16 = 503;

/// The error for an answer without the file: [`io::ErrorKind::ResourceBusy`] if the server is still preparing it. The name of the file
/// comes before it.
pub(crate) fn answered(status: u16) -> io::Error {
    let kind = if status == NOT_READY { io::ErrorKind::ResourceBusy } else { io::ErrorKind::Other };
    io::Error::new(kind, format!("the server answers {status}"))
}

impl Source for Site {
    fn read<'a>(&'a self, name: &'a Path) -> Reading<'a> {
        let url = beside(&self.url, name);
        Box::pin(async move {
            let fetched = fetched(&url).await.map(Into::into);
            fetched.map_err(|error| io::Error::new(error.kind(), format!("{error} ({url})")))
        })
    }

    fn url(&self, name: &Path) -> Option<String> {
        Some(beside(&self.url, name))
    }
}

#[cfg(target_arch = "wasm32")]
use crate::web::fetched;

/// Reads a whole file by its address.
#[cfg(not(target_arch = "wasm32"))]
async fn fetched(url: &str) -> io::Result<Vec<u8>> {
    relievo_delivery::client::get(url, None).map_err(|error| match error {
        FetchError::Status { status, .. } => answered(status),
        FetchError::Network { reason, .. } => io::Error::other(reason),
        error => io::Error::other(error),
    })
}

/// Scenes that the viewer brings along, whose packages lie beside the page.
#[cfg(target_arch = "wasm32")]
#[derive(Debug, Clone)]
pub(crate) struct Bundled {
    /// The scenes.
    pub own: Memory,
    /// The page.
    pub page: Site,
}

#[cfg(target_arch = "wasm32")]
impl Source for Bundled {
    fn read<'a>(&'a self, name: &'a Path) -> Reading<'a> {
        if self.own.0.contains_key(name) { self.own.read(name) } else { self.page.read(name) }
    }

    fn url(&self, name: &Path) -> Option<String> {
        self.page.url(name)
    }
}

/// Whether a name is the address of a file of a site.
pub(crate) fn is_address(name: &str) -> bool {
    name.starts_with("http://") || name.starts_with("https://")
}

/// The source of an absolute address.
fn site(url: String) -> (String, Arc<dyn Source>) {
    let path = url.split(['?', '#']).next().unwrap_or_default();
    let name = path.rsplit('/').next().unwrap_or_default().to_owned();
    (name, Arc::new(Site { url }))
}

/// Finds the source of an address that somebody wrote: the name of the file, and where it is.
pub type Locate = fn(&str) -> Result<(String, Arc<dyn Source>), InputError>;

/// Finds a file by its path, or by the address of a site (`http://`, `https://`).
///
/// # Errors
/// [`InputError`] for other addresses, and for a path without a file's name.
#[cfg(not(target_arch = "wasm32"))]
pub fn locate(address: &str) -> Result<(String, Arc<dyn Source>), InputError> {
    let refused = |bound: &str| InputError::new("address", address, bound);
    if is_address(address) {
        return Ok(site(address.to_owned()));
    }
    if address.contains("://") {
        return Err(refused("must be the path of a file, or begin with http:// or https://"));
    }
    let path = Path::new(address);
    let name = path.file_name().ok_or_else(|| refused("must end in the name of a file"))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    Ok((name.to_string_lossy().into_owned(), Arc::new(Folder(folder))))
}

/// Finds a file by its address, absolute or relative to the page.
///
/// # Errors
/// [`InputError`] for what is no address.
#[cfg(target_arch = "wasm32")]
pub fn locate(address: &str) -> Result<(String, Arc<dyn Source>), InputError> {
    let refused =
        || InputError::new("address", address, "must be an address, absolute or relative to the page");
    crate::web::absolute(address).map(site).ok_or_else(refused)
}

/// Limits how fast the bytes of another source arrive.
pub(crate) struct Throttled<'a> {
    pub source: &'a dyn Source,
    /// Bits a second; `None` for no limit.
    pub rate: Option<f64>,
}

impl Throttled<'_> {
    /// Reads a file of the source, and waits as long as its bytes take at the rate.
    pub async fn read(&self, name: &Path) -> io::Result<Arc<[u8]>> {
        let start = web_time::Instant::now();
        let bytes = match name.to_str().filter(|name| is_address(name)) {
            Some(url) => {
                let (name, site) = site(url.to_owned());
                site.read(Path::new(&name)).await?
            }
            None => self.source.read(name).await?,
        };
        if let Some(rate) = self.rate {
            let rest = 8.0 * bytes.len() as f64 / rate - start.elapsed().as_secs_f64();
            if rest > 0.0 {
                sleep(rest).await;
            }
        }
        Ok(bytes)
    }
}

#[cfg(not(target_arch = "wasm32"))]
pub(crate) async fn sleep(seconds: f64) {
    // A task that loads has a thread of its own.
    std::thread::sleep(std::time::Duration::from_secs_f64(seconds));
}

#[cfg(target_arch = "wasm32")]
pub(crate) use crate::web::sleep;
