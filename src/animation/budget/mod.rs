//! Selects which bones to sample when their number per frame is limited. It replaces `gate` in a frame.
//!
//! The selected bones are those whose stale transforms are expected to be most visible. Visibility is the motion of points
//! since the bone was last sampled ([`ExpectationTable`]), weighted by the size of the instance on screen
//! ([`Lod::weight`](super::lod::Lod::weight)).
//!
//! Bones are ranked by the logarithm of this product, in sixteenths of an octave, and counted per rank. All bones above some
//! rank are selected. Bones of that rank are selected in the order of instances and slots until the budget is used up.
//! Instances that must be sampled in full are sampled whatever the budget; they are charged to it first.
//!
//! [`ExpectationTable`]: super::gate_table::ExpectationTable

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{BudgetJob, BudgetPass};
