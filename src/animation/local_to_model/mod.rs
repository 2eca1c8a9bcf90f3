//! Concatenation of local transforms into the model's space, parents first.
//!
//! Bones are walked in an order of their own ([`Order`](super::Order)): every bone before its children, subtrees without a gap, and
//! first of a bone's children the one that continues its chain. A chain is a run of slots from parent to child, as
//! heavy-path decompositions cut trees, with the parent's matrix in registers: every matrix is read once a chain
//! instead of once a bone, and a dispatch serves every chain whose parent is done. There are far fewer such dispatches
//! than levels of bones. Where processors are few, a thread walks all chains of its instance (`Walk`).
//!
//! What is below an active bone is a run of slots too: so a thread that knows the first bone to compute knows them all.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{LocalToModelActiveJob, LocalToModelJob, LocalToModelPass, Walk};

/// How far a component may lie from the reference's, on any device: times the bones of the longest chain, times the largest
/// component (at least 1). A local matrix carries 10ε of its scale (ε = 2⁻²⁴, each operation to either neighbour 2ε), a
/// row of the product 8ε of the sum of its terms, at most √3 of the largest component: 32ε a bone, rounded up.
pub const LOCAL_TO_MODEL_BOUND: f32 = 2e-6;
