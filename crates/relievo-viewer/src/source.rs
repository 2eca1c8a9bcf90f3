//! Where files come from: a folder, memory (dropped files, and scenes that the viewer brings along), or a site.

use std::collections::HashMap;
use std::future::Future;
use std::io;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::sync::Arc;

use relievo::InputError;

/// The bytes of a file, once they are there.
pub type Reading<'a> = Pin<Box<dyn Future<Output = io::Result<Arc<[u8]>>> + 'a>>;

/// A source of files. Names are relative to the first file that is opened.
pub trait Source: wgpu::WasmNotSendSync {
    /// Reads a whole file.
    fn read<'a>(&'a self, name: &'a Path) -> Reading<'a>;
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

/// Files of a site, read by the browser.
#[cfg(target_arch = "wasm32")]
#[derive(Debug, Clone)]
pub struct Site {
    /// Address of the first file's folder, absolute or relative to the page, with a slash at its end; or nothing.
    pub base: String,
}

#[cfg(target_arch = "wasm32")]
impl Source for Site {
    fn read<'a>(&'a self, name: &'a Path) -> Reading<'a> {
        Box::pin(
            async move { Ok(crate::web::fetched(&format!("{}{}", self.base, name.display())).await?.into()) },
        )
    }
}

/// Finds the source of an address that somebody wrote: the name of the file, and where it is.
pub type Locate = fn(&str) -> Result<(String, Arc<dyn Source>), InputError>;

/// Finds a file by its path.
///
/// # Errors
/// [`InputError`] for the address of a site, and for a path without a file's name.
#[cfg(not(target_arch = "wasm32"))]
pub fn locate(address: &str) -> Result<(String, Arc<dyn Source>), InputError> {
    if address.contains("://") {
        return Err(InputError::new("address", address, "must be the path of a file"));
    }
    let path = Path::new(address);
    let refused = || InputError::new("address", address, "must end in the name of a file");
    let name = path.file_name().ok_or_else(refused)?.to_string_lossy().into_owned();
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    Ok((name, Arc::new(Folder(folder))))
}

/// Finds a file by its address, absolute or relative to the page.
///
/// # Errors
/// None: the browser refuses what it cannot read.
#[cfg(target_arch = "wasm32")]
pub fn locate(address: &str) -> Result<(String, Arc<dyn Source>), InputError> {
    let end = address.rfind('/').map_or(0, |slash| slash + 1);
    Ok((address[end..].to_owned(), Arc::new(Site { base: address[..end].to_owned() })))
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
        let bytes = self.source.read(name).await?;
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
async fn sleep(seconds: f64) {
    // A task that loads has a thread of its own.
    std::thread::sleep(std::time::Duration::from_secs_f64(seconds));
}

#[cfg(target_arch = "wasm32")]
use crate::web::sleep;
