//! The stores that a server reads models from and keeps packages in.

use std::path::Path as FilePath;
use std::sync::Arc;

use axum::body::Bytes;
use object_store::local::LocalFileSystem;
use object_store::path::Path;
use object_store::{ObjectStore, ObjectStoreExt as _, PutMode, PutOptions};
use relievo::InputError;

use super::ServeError;

/// A folder of a store: of a disk, or of an object store.
#[derive(Debug, Clone)]
pub(super) struct Store {
    store: Arc<dyn ObjectStore>,
    folder: Path,
}

/// The version of an object, which changes with each write.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Version {
    e_tag: Option<String>,
    modified: String,
}

impl Store {
    /// The folder at a path or an address. A folder of a disk is made if it is not there.
    pub fn open(place: &str) -> Result<Self, ServeError> {
        if !place.contains("://") {
            return Self::folder(place.as_ref());
        }
        let refused = |bound: String| InputError::new("models", place, bound);
        let scheme = place.split("://").next().unwrap_or_default();
        if scheme != "file" && cfg!(not(feature = "s3")) {
            let bound = "must be a folder: this program is built without the feature `s3`".to_owned();
            return Err(refused(bound).into());
        }
        let address = place.parse().map_err(|error| refused(format!("must be an address: {error}")))?;
        #[cfg(feature = "s3")]
        {
            // One that the program has installed already stays.
            let _ = rustls::crypto::ring::default_provider().install_default();
        }
        // Credentials, region and endpoint come from the usual variables of the environment (`AWS_…`).
        let settings = std::env::vars().map(|(name, value)| (name.to_ascii_lowercase(), value));
        let settings = settings.filter(|(name, _)| name.starts_with("aws_"));
        let (store, folder) = object_store::parse_url_opts(&address, settings)?;
        Ok(Self { store: store.into(), folder })
    }

    /// A folder of a disk, which is made if it is not there.
    pub fn folder(folder: &FilePath) -> Result<Self, ServeError> {
        std::fs::create_dir_all(folder).map_err(|error| ServeError::io(folder.display(), error))?;
        Ok(Self { store: Arc::new(LocalFileSystem::new_with_prefix(folder)?), folder: Path::default() })
    }

    /// A folder below this one.
    pub fn below(&self, name: &str) -> Self {
        Self { store: self.store.clone(), folder: self.path(name) }
    }

    /// The path of a file, whose name may contain folders.
    pub fn path(&self, name: &str) -> Path {
        name.split('/')
            .filter(|part| !part.is_empty())
            .fold(self.folder.clone(), |path, part| path.join(part))
    }

    /// Names of the files in the folder itself, ascending.
    pub async fn names(&self) -> Result<Vec<String>, ServeError> {
        let list = self.store.list_with_delimiter(Some(&self.folder)).await?;
        let name = |meta: object_store::ObjectMeta| meta.location.filename().map(str::to_owned);
        let mut names: Vec<_> = list.objects.into_iter().filter_map(name).collect();
        names.sort();
        Ok(names)
    }

    /// Names and sizes of the files in the folder itself.
    pub async fn sizes(&self) -> Result<Vec<(String, u64)>, ServeError> {
        let list = self.store.list_with_delimiter(Some(&self.folder)).await?;
        let size = |meta: object_store::ObjectMeta| Some((meta.location.filename()?.to_owned(), meta.size));
        Ok(list.objects.into_iter().filter_map(size).collect())
    }

    /// A whole file; `None` if there is none.
    pub async fn read(&self, name: &str) -> Result<Option<Bytes>, ServeError> {
        match self.store.get(&self.path(name)).await {
            Ok(found) => Ok(Some(found.bytes().await?)),
            Err(object_store::Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    /// Writes a file, which appears as a whole.
    pub async fn write(&self, name: &str, bytes: impl Into<Bytes>) -> Result<(), ServeError> {
        self.store.put(&self.path(name), bytes.into().into()).await?;
        Ok(())
    }

    /// Writes a file unless there is one. Whether it was written.
    pub async fn create(&self, name: &str, bytes: impl Into<Bytes>) -> Result<bool, ServeError> {
        let options = PutOptions { mode: PutMode::Create, ..PutOptions::default() };
        match self.store.put_opts(&self.path(name), bytes.into().into(), options).await {
            Ok(_) => Ok(true),
            Err(object_store::Error::AlreadyExists { .. } | object_store::Error::Precondition { .. }) => {
                Ok(false)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// The version of a file; `None` if there is none.
    pub async fn version(&self, name: &str) -> Result<Option<Version>, ServeError> {
        match self.store.head(&self.path(name)).await {
            Ok(meta) => Ok(Some(Version { e_tag: meta.e_tag, modified: meta.last_modified.to_string() })),
            Err(object_store::Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    /// Removes a file. A missing one is no error.
    pub async fn remove(&self, name: &str) -> Result<(), ServeError> {
        match self.store.delete(&self.path(name)).await {
            Ok(()) | Err(object_store::Error::NotFound { .. }) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    /// The store, for streams.
    pub fn raw(&self) -> &dyn ObjectStore {
        &*self.store
    }
}
