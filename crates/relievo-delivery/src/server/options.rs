//! Options of a server.

use std::path::PathBuf;

use relievo::InputError;
use serde::{Deserialize, Serialize};

/// Options of a server. In a file they have the same names in camelCase.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "camelCase", deny_unknown_fields)]
pub struct ServeOptions {
    /// A folder with models (`.glb`, `.gltf`, `.obj`, `.rlv`), or the address of an object store such as `s3://bucket/models`
    /// (feature `s3`).
    pub models: Option<String>,
    /// Scene files. The files that they name are served too.
    pub scenes: Vec<PathBuf>,
    /// A folder with terrain: `config.json`, and optionally `features/*.json` and `elevation/`.
    pub terrain: Option<PathBuf>,
    /// A folder with a page, which is served at the base.
    pub page: Option<PathBuf>,
    /// Folder of the cache. By default `.relievo` beside the models.
    pub cache: Option<PathBuf>,
    /// Largest number of bytes of the packages in the cache.
    pub cache_quota: u64,
    /// Address and port to listen on; port 0 lets the system choose.
    pub listen: String,
    /// Path below which everything is served, such as `/world` behind a proxy.
    pub base: String,
    /// If it is set, requests must have `Authorization: Bearer TOKEN`.
    pub token: Option<String>,
    /// Origins of pages that may read the answers, or `*` for all.
    pub origins: Vec<String>,
    /// Limits of requests.
    pub limits: Limits,
}

/// Limits of everything that a request can ask for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "camelCase", deny_unknown_fields)]
pub struct Limits {
    /// Connections at once; further ones wait.
    pub connections: usize,
    /// Seconds until a request's head must be complete.
    pub header_seconds: f64,
    /// Seconds without any byte sent or received after which a connection is closed.
    pub idle_seconds: f64,
    /// Seconds until an answer must begin.
    pub answer_seconds: f64,
    /// Bytes of a request's head.
    pub header_bytes: usize,
    /// Bytes of packages, and of meshes as JSON, that are kept in memory.
    pub memory: u64,
}

impl Default for ServeOptions {
    fn default() -> Self {
        Self {
            models: None,
            scenes: Vec::new(),
            terrain: None,
            page: None,
            cache: None,
            cache_quota: 8 << 30,
            listen: "127.0.0.1:8080".to_owned(),
            base: "/".to_owned(),
            token: None,
            origins: vec!["*".to_owned()],
            limits: Limits::default(),
        }
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            connections: 4096,
            header_seconds: 10.0,
            idle_seconds: 30.0,
            answer_seconds: 60.0,
            header_bytes: 16 << 10,
            memory: 256 << 20,
        }
    }
}

impl ServeOptions {
    /// Checks all values.
    ///
    /// # Errors
    /// [`InputError`] with the name of the option as in a file.
    pub fn validate(&self) -> Result<(), InputError> {
        if self.models.is_none() && self.scenes.is_empty() && self.terrain.is_none() && self.page.is_none() {
            return Err(InputError::new("models", "none", "must be given, or scenes, terrain or a page"));
        }
        if !self.base.starts_with('/') || self.base.contains(['?', '#', '%']) || self.base.contains("..") {
            let bound = "must begin with / and have no ?, #, % or ..";
            return Err(InputError::new("base", &self.base, bound));
        }
        if let Some(token) = &self.token
            && (token.is_empty() || !token.bytes().all(|byte| byte.is_ascii_graphic()))
        {
            return Err(InputError::new(
                "token",
                "a text",
                "must have only visible ASCII characters, at least one",
            ));
        }
        for (at, origin) in self.origins.iter().enumerate() {
            if origin != "*" && !origin.contains("://") {
                let bound = "must be * or have a scheme, such as https://example.org";
                return Err(InputError::new(format!("origins[{at}]"), origin, bound));
            }
        }
        self.limits.validate()
    }

    /// The base without a slash at its end: empty for the root.
    pub(super) fn base(&self) -> &str {
        self.base.trim_end_matches('/')
    }
}

impl Limits {
    fn validate(&self) -> Result<(), InputError> {
        let numbers = [
            ("connections", self.connections as f64, 1.0, 1e6),
            ("headerSeconds", self.header_seconds, 0.1, 3600.0),
            ("idleSeconds", self.idle_seconds, 0.1, 3600.0),
            ("answerSeconds", self.answer_seconds, 0.1, 3600.0),
            ("headerBytes", self.header_bytes as f64, 8192.0, f64::from(1 << 20)),
            ("memory", self.memory as f64, f64::from(1 << 20), 1e15),
        ];
        numbers.into_iter().try_for_each(|(path, value, least, most)| match (least..=most).contains(&value) {
            true => Ok(()),
            false => {
                Err(InputError::new(format!("limits.{path}"), value, format!("must be in {least}..={most}")))
            }
        })
    }
}
