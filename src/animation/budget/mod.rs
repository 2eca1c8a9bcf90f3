//! Which bones of which instances are sampled when only so many may be: those whose stale transforms are expected to
//! show most, by how far they moved points since they were sampled ([`ExpectationTable`]) and how large
//! their instance is on screen ([`Lod::weight`](super::lod::Lod::weight)). Takes the place of `gate` in a frame.
//!
//! Bones are ranked by the logarithm of that motion, in sixteenths of an octave, and counted per rank. All
//! bones above some rank are selected, and those of that rank in the order of instances and slots until the
//! budget is used up. Instances that must be sampled in full are, whatever the budget; they are charged to it
//! first.
//!
//! [`ExpectationTable`]: super::gate_table::ExpectationTable

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{BudgetJob, BudgetPass};
