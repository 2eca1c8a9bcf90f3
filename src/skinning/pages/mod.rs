//! Pages of skinned vertices: memory follows what is seen. A page has room for the vertices of one cluster. An instance that
//! is seen holds one for each cluster of its level of detail; one that is not seen holds none.
//!
//! Pages stay with their cluster while it is needed, so that vertices that do not move are not skinned again. Which page an
//! instance gets is the same on every run.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{PageBuffers, PagesPass};

pub use crate::shared::skinning::page::NO_PAGE;
pub use crate::shared::skinning::pages::PageState;

/// The bytes of a page.
pub const PAGE_BYTES: usize = super::clusters::CLUSTER * size_of::<super::vertex::Vertex>();

/// The bytes of a page with last positions: four floats for each vertex more.
pub const KEEPING_PAGE_BYTES: usize = PAGE_BYTES + super::clusters::CLUSTER * size_of::<[f32; 4]>();
