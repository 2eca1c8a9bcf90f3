//! What a server has: `catalog.json`.

use relievo::asset::package::PackageHeader;
use serde::{Deserialize, Serialize};

/// The path of the catalog below the base of a server.
pub const CATALOG: &str = "catalog.json";

/// The models, scenes and terrain of a server. Paths are relative to the base of the server.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Catalog {
    /// Models, by name.
    pub models: Vec<CatalogModel>,
    /// Paths of scene files.
    pub scenes: Vec<String>,
    /// Path of the terrain's configuration.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub terrain: Option<String>,
}

/// A model of a server.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct CatalogModel {
    /// The name, without an extension.
    pub name: String,
    /// The state of the model; a model that is not ready has no levels yet.
    pub state: ModelState,
    /// Path of the package, which contains the hash of its bytes. It never changes.
    #[serde(skip_serializing_if = "String::is_empty", default)]
    pub package: String,
    /// Number of bytes of the package.
    pub bytes: u64,
    /// Number of bytes before the first level: header and model.
    pub head: u64,
    /// Levels of detail, the finest first.
    pub levels: Vec<CatalogLevel>,
}

/// State of a model on a server.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", tag = "is", content = "why")]
pub enum ModelState {
    /// The package is being made.
    Cooking,
    /// The package can be fetched.
    Ready,
    /// The package could not be made, and why.
    Failed(String),
}

/// A level of detail of a model in a catalog.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct CatalogLevel {
    /// Number of triangles.
    pub triangles: usize,
    /// Largest distance to the source, in the model's units.
    pub error: f32,
    /// Number of bytes of the package up to the end of this level.
    pub end: u64,
}

impl CatalogModel {
    /// A model that is not ready.
    pub fn waiting(name: &str, state: ModelState) -> Self {
        Self { name: name.to_owned(), state, package: String::new(), bytes: 0, head: 0, levels: Vec::new() }
    }

    /// A model with a package at `path`.
    pub fn ready(name: &str, path: String, header: &PackageHeader) -> Self {
        let level = |level: &relievo::asset::package::PackageLevel| CatalogLevel {
            triangles: level.triangles,
            error: level.error,
            end: level.chunk.end as u64,
        };
        Self {
            name: name.to_owned(),
            state: ModelState::Ready,
            package: path,
            bytes: header.bytes() as u64,
            head: header.model.end as u64,
            levels: header.levels.iter().rev().map(level).collect(),
        }
    }
}
