//! Pages of skinned vertices, so that memory depends on the number of visible instances. A page has a capacity of 64
//! vertices: one cluster. A visible instance holds one page for each cluster of its level of detail; an invisible
//! instance holds none.
//!
//! A cluster keeps its page as long as it needs one, so static vertices are not skinned again. The assignment of pages
//! is the same on every run.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{PageBuffers, PagesPass};

pub use crate::shared::skinning::page::NO_PAGE;
pub use crate::shared::skinning::pages::PageState;

/// Size of a page in bytes, without positions of the previous frame.
pub const PAGE_BYTES: usize = super::clusters::CLUSTER * size_of::<super::vertex::Vertex>();

/// Size of a page in bytes if vertex positions of the previous frame are kept: four more floats per vertex.
pub const KEEPING_PAGE_BYTES: usize = PAGE_BYTES + super::clusters::CLUSTER * size_of::<[f32; 4]>();
