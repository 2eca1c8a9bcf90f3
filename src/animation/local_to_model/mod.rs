//! Computation of model matrices: concatenates the local transforms of bones from the root downwards.
//!
//! Bones are processed in the order of [`Order`](super::Order). Every bone comes before its children, subtrees are contiguous,
//! and the first child of a bone continues its chain. A chain is a contiguous range of slots from parent to child to grandchild,
//! as in heavy-path decompositions of trees. One thread processes a chain and keeps the parent's matrix in registers. It reads a
//! parent's matrix from memory once per chain, not once per bone. One dispatch processes all chains whose parents are done. Far
//! fewer dispatches are needed than the skeleton has levels of bones.
//!
//! The descendants of an active bone occupy a contiguous range of slots, and all of them must be computed. They include the rest
//! of the bone's chain. A thread therefore only searches its chain for the first bone to compute.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::LocalToModelPass;

/// Largest allowed difference between a matrix component and the CPU reference, on any device. Two factors scale this bound: the
/// number of bones on the longest path from a root to a leaf, and the largest absolute component (at least 1).
///
/// Let ε = 2⁻²⁴: an operation has an error of 2ε. A local matrix has an error of 10ε, relative to its scale. A row of the product
/// has an error of 8ε, relative to the sum of its terms. This sum is at most √3 times the largest component. Together, these
/// errors are at most 32ε per bone, or 1.91e-6. The bound is rounded up.
pub const LOCAL_TO_MODEL_BOUND: f32 = 2e-6;
