//! Selects the bones that are sampled when their number is limited: those whose stale transforms are expected
//! to be most visible, by how far they moved points since they were last sampled
//! ([`GateTable::of_expectations`]) and how large their instance is on screen
//! ([`Lod::weight`](super::lod::Lod::weight)). In a frame it replaces `gate`.
//!
//! Bones are ranked by the logarithm of that motion, in sixteenths of an octave, and counted per rank. All
//! bones above some rank are selected, and those of that rank in the order of instances and slots until the
//! budget is used up. Instances that must be sampled in full are, whatever the budget; they are charged to it
//! first.
//!
//! [`GateTable::of_expectations`]: super::gate_table::GateTable::of_expectations

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{BudgetJob, BudgetPass};
