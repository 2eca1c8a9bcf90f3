//! Pages of skinned vertices: memory follows visibility. A page has room for the vertices of one cluster. A visible
//! instance holds one page for each cluster of its level of detail; an invisible one holds none.
//!
//! A page stays with its cluster while the cluster is needed, so that static vertices are not skinned again. The
//! assignment of pages is the same on every run.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{PageBuffers, PagesPass};

pub use crate::shared::skinning::page::NO_PAGE;
pub use crate::shared::skinning::pages::PageState;

/// Size of a page in bytes.
pub const PAGE_BYTES: usize = super::clusters::CLUSTER * size_of::<super::vertex::Vertex>();

/// Size of a page with last positions in bytes: four more floats per vertex.
pub const KEEPING_PAGE_BYTES: usize = PAGE_BYTES + super::clusters::CLUSTER * size_of::<[f32; 4]>();
