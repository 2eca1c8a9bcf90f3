//! Packages of models, made once and kept in a cache that servers may share.
//!
//! | file of the cache | content |
//! |---|---|
//! | `objects/HASH.rlv` | a package, by the hash of its bytes |
//! | `cooked/KEY.json` | what was made of a model: [`Cooked`]; the key is the hash of the model's file and of the format's version |
//! | `locks/KEY` | who is making it. It is written again every few seconds. |

use std::collections::BTreeSet;
use std::io;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::time::Duration;

use axum::body::Bytes;
use relievo::InputError;
use relievo::asset::package::{PackageHeader, VERSION};
use relievo::asset::{Model, ModelFile};
use relievo::ops::skinning::cook;
use serde::{Deserialize, Serialize};
use tokio::time::{Instant, sleep};

use super::ServeError;
use super::store::{Store, Version};
use crate::sha256;

/// How often a lock is written again, and looked at.
const BEAT: Duration = Duration::from_secs(2);
/// A lock that was not written again for this long belongs to a server that is gone.
const STALE: Duration = Duration::from_secs(20);

/// What was made of a model.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Cooked {
    /// Hash of the package.
    pub hash: String,
    /// The files that the model's file names.
    files: Vec<NamedFile>,
}

/// A file beside a model.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct NamedFile {
    name: String,
    /// Hash of its content.
    hash: String,
}

/// A package in the cache.
#[derive(Debug, Clone)]
pub(super) struct CachedPackage {
    pub hash: String,
    pub header: PackageHeader,
}

/// Reads a file beside a model.
pub(super) type Read<'a> = &'a (dyn Fn(&Path) -> io::Result<Vec<u8>> + Sync);

/// A model to be made into a package.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    /// The name of its file, whose extension says its format.
    pub name: &'a str,
    /// The content of its file; of a built-in model, its name.
    pub bytes: &'a [u8],
    pub read: Read<'a>,
    /// Makes the model, if it is built in.
    pub built_in: Option<&'a (dyn Fn() -> Result<Model, InputError> + Sync)>,
    /// Gets the completed fraction of the work.
    pub watch: &'a (dyn Fn(f32) + Sync),
}

/// The cache of packages.
#[derive(Debug)]
pub(super) struct Cache {
    store: Store,
    quota: u64,
    /// Hashes of the packages in use.
    used: Mutex<BTreeSet<String>>,
    /// Identifies this server in locks.
    owner: String,
}

impl Cache {
    pub fn new(store: Store, quota: u64) -> Result<Self, ServeError> {
        let mut random = [0; 8];
        getrandom::fill(&mut random).map_err(|error| ServeError::io("entropy", io::Error::other(error)))?;
        let owner = format!("{} {:016x}", std::process::id(), u64::from_le_bytes(random));
        Ok(Self { store, quota, used: Mutex::default(), owner })
    }

    pub fn store(&self) -> &Store {
        &self.store
    }

    /// The store and the name of a package.
    pub fn object(&self, hash: &str) -> object_store::path::Path {
        self.store.path(&object_name(hash))
    }

    /// A package's bytes.
    pub async fn package(&self, hash: &str) -> Result<Bytes, ServeError> {
        let found = self.store.read(&object_name(hash)).await?;
        found.ok_or_else(|| InputError::new("cache.objects", hash, "must be there: it was removed").into())
    }

    /// Finds the package of a model, or makes it. Only one of the servers that share the cache makes it; the others wait.
    pub async fn cooked(&self, source: &Source<'_>) -> Result<CachedPackage, ServeError> {
        let key = key(source.name, source.bytes);
        let mut held: Option<(Option<Version>, Instant)> = None;
        loop {
            if let Some(found) = self.found(&key, source.read).await? {
                return Ok(found);
            }
            let lock = format!("locks/{key}");
            if self.store.create(&lock, self.owner.clone()).await? {
                let made = self.make_locked(source, &key, &lock).await;
                self.store.remove(&lock).await?;
                return made;
            }
            let now = self.store.version(&lock).await?;
            match &held {
                Some((version, since)) if *version == now => {
                    if now.is_some() && since.elapsed() >= STALE {
                        tracing::warn!(name = source.name, "the server that was making this package is gone");
                        self.store.remove(&lock).await?;
                        held = None;
                    }
                }
                _ => held = Some((now, Instant::now())),
            }
            sleep(BEAT / 8).await;
        }
    }

    /// Makes a package while the lock is written again and again.
    async fn make_locked(
        &self,
        source: &Source<'_>,
        key: &str,
        lock: &str,
    ) -> Result<CachedPackage, ServeError> {
        // Another server may have made it between the look and the lock.
        if let Some(found) = self.found(key, source.read).await? {
            return Ok(found);
        }
        let beat = tokio::spawn(beat(self.store.clone(), lock.to_owned(), self.owner.clone()));
        let made = tokio::task::block_in_place(|| made(source));
        beat.abort();
        let (package, files) = made?;
        let header = PackageHeader::read(&package)?.0;
        let hash = sha256(&package);
        self.make_room(package.len() as u64).await?;
        self.store.write(&object_name(&hash), package).await?;
        let cooked = Cooked { hash: hash.clone(), files };
        let text = serde_json::to_vec(&cooked).map_err(|error| ServeError::io(key, error.into()))?;
        self.store.write(&format!("cooked/{key}.json"), text).await?;
        self.use_package(&hash);
        Ok(CachedPackage { hash, header })
    }

    /// The package that was made of a model, if it is there and the model has not changed since.
    async fn found(&self, key: &str, read: Read<'_>) -> Result<Option<CachedPackage>, ServeError> {
        let Some(text) = self.store.read(&format!("cooked/{key}.json")).await? else { return Ok(None) };
        let Ok(Cooked { hash, files }) = serde_json::from_slice(&text) else { return Ok(None) };
        let is_same = |NamedFile { name, hash }: &NamedFile| {
            tokio::task::block_in_place(|| read(name.as_ref())).is_ok_and(|bytes| sha256(&bytes) == *hash)
        };
        if !files.iter().all(is_same) {
            return Ok(None);
        }
        let Some(package) = self.store.read(&object_name(&hash)).await? else { return Ok(None) };
        if sha256(&package) != hash {
            tracing::warn!(hash, "a package in the cache is damaged, and is made again");
            return Ok(None);
        }
        self.use_package(&hash);
        Ok(Some(CachedPackage { header: PackageHeader::read(&package)?.0, hash }))
    }

    fn use_package(&self, hash: &str) {
        let mut used = self.used.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        used.insert(hash.to_owned());
    }

    /// Removes packages that this server does not use until another one fits the quota.
    async fn make_room(&self, bytes: u64) -> Result<(), ServeError> {
        let objects = self.store.below("objects");
        let sizes = objects.sizes().await?;
        let mut total: u64 = sizes.iter().map(|(_, size)| size).sum();
        let used = self.used.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone();
        for (name, size) in sizes {
            if total + bytes <= self.quota {
                break;
            }
            if !used.contains(name.trim_end_matches(".rlv")) {
                objects.remove(&name).await?;
                total -= size;
            }
        }
        if total + bytes <= self.quota {
            return Ok(());
        }
        let bound =
            format!("must be at least {}, which the packages in use and this one need", total + bytes);
        Err(InputError::new("cacheQuota", self.quota, bound).into())
    }
}

/// The path of a package, in the cache and on the server.
pub(super) fn object_name(hash: &str) -> String {
    format!("objects/{hash}.rlv")
}

/// The key of a model: its content, its format, and the version of packages.
fn key(name: &str, bytes: &[u8]) -> String {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
    sha256(format!("{VERSION} {} {ending} {}", env!("CARGO_PKG_VERSION"), sha256(bytes)).as_bytes())
}

/// Writes a lock again and again.
async fn beat(store: Store, lock: String, owner: String) {
    loop {
        sleep(BEAT).await;
        if let Err(error) = store.write(&lock, owner.clone()).await {
            tracing::warn!(lock, %error, "the lock cannot be written");
        }
    }
}

/// Makes a package. Returns its bytes, and the files that the model's file names.
fn made(source: &Source<'_>) -> Result<(Vec<u8>, Vec<NamedFile>), ServeError> {
    let Source { name, bytes, read, built_in, watch } = *source;
    let in_file = |source| ServeError::File { path: name.into(), source };
    if built_in.is_none() && bytes.starts_with(b"RLV\n") {
        // A package is served as it is.
        Model::from_rlv(bytes).map_err(in_file)?;
        return Ok((bytes.to_vec(), Vec::new()));
    }
    let files = Mutex::new(Vec::new());
    let beside = |path: &Path| {
        let found = read(path)?;
        let mut files = files.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        files.push(NamedFile { name: path.to_string_lossy().into_owned(), hash: sha256(&found) });
        Ok(found)
    };
    let file = match built_in {
        Some(make) => make().map_err(in_file)?.into(),
        None => ModelFile::from_bytes_beside(name.as_ref(), bytes, &beside).map_err(in_file)?,
    };
    let package = cook(&file, &mut |fraction| {
        watch(fraction);
        ControlFlow::Continue(())
    });
    // The work is never broken off.
    let package = package.map_err(in_file)?.unwrap_or_default();
    Ok((package, files.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner)))
}
