//! Delivery of models, scenes and terrain over HTTP.
//!
//! - [`mesh_json`]: thesis B's JSON of a level of detail, and of the difference between two levels.
//! - [`catalog`]: what a server has.
//! - `client` (feature `client`): a [`Fetcher`](client::Fetcher) asks for the levels of packages that a program wants, the most
//!   useful first. It does no I/O itself: a [`Transport`](client::Transport) does, which exists for programs and for browsers.
//!   With the feature `scene`, a [`StreamedScene`](client::StreamedScene) shows a scene whose objects appear as they arrive.
//! - `server` (feature `server`): serves and exports models, scenes and terrain.
//!
//! Models travel as packages ([`relievo::asset::package`]), whose levels lie in the file from the coarsest to the finest. Any web
//! server that answers requests for ranges of bytes can serve them.
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod catalog;
#[cfg(feature = "client")]
pub mod client;
pub mod file_names;
pub mod mesh_json;
#[cfg(feature = "server")]
pub mod server;

pub use relievo::asset::package::sha256;
