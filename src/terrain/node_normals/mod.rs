//! Normals of nodes of endless terrain, at twice the nodes' resolution.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{NodeNormalsBuffers, NodeNormalsPass};
