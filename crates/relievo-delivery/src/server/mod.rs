//! A server of models, scenes and terrain, and the export of its files.
//!
//! [`Site::open`] prepares everything that a folder of models, scene files and terrain need. [`Server`] answers requests for it;
//! [`export()`] writes it as plain files for any web server. Models are made into packages once, and kept in a cache beside the
//! models, which any number of servers may share.

// The bodies of public `async` functions are in functions that return boxed futures: otherwise each program that awaits them
// compiles them, and what they call, again.

mod compress;
mod connections;
mod cooking;
mod export;
mod metrics;
mod options;
mod resource;
mod respond;
mod routes;
mod scenes;
mod site;
mod store;
mod terrain;

pub use connections::Server;
pub use export::{Exported, Manifest, export};
pub use options::{Limits, ServeOptions};
pub use site::Site;

use std::path::PathBuf;

use relievo::InputError;

/// Why a server could not start, or files could not be served.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// An option, or the content of a file, is out of bounds.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The content of a file cannot be used.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: InputError,
    },
    /// A file or a socket cannot be used.
    #[error("{what}: {source}")]
    Io {
        /// The file or the address.
        what: String,
        /// Why.
        source: std::io::Error,
    },
    /// The store of models or of packages failed.
    #[error("store: {0}")]
    Store(#[from] object_store::Error),
}

impl ServeError {
    fn io(what: impl std::fmt::Display, source: std::io::Error) -> Self {
        Self::Io { what: what.to_string(), source }
    }
}
