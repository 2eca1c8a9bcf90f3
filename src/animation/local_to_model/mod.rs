//! Concatenation of local transforms into model space, parents first.
//!
//! Bones are walked in the order of [`Order`](super::Order): every bone comes before its children, subtrees are contiguous, and
//! the first child of a bone continues its chain. A chain is a run of slots from parent to child, as in heavy-path
//! decompositions of trees. A thread walks a chain with the parent's matrix in registers, so a parent's matrix is read once per
//! chain, not once per bone. One dispatch handles every chain whose parent is done. There are far fewer such dispatches than
//! levels of bones.
//!
//! Everything below an active bone is a run of slots too. A thread that knows the first bone to compute therefore knows them
//! all.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::LocalToModelPass;

/// Largest allowed difference between a component and the reference, on any device, relative to the number of bones of the
/// longest chain times the largest component (at least 1). A local matrix carries 10ε of its scale (ε = 2⁻²⁴, each operation
/// 2ε). A row of the product carries 8ε of the sum of its terms, which is at most √3 times the largest component. This is 32ε
/// per bone, rounded up.
pub const LOCAL_TO_MODEL_BOUND: f32 = 2e-6;
