//! Selects the bones to sample when the number of bones per frame is limited. In a frame, this operation takes the place of
//! `gate`.
//!
//! The operation selects the bones whose stale transforms are expected to be most visible. Visibility is the motion of points
//! since the bone was last sampled ([`ExpectationTable`]), times a weight for the instance's size on screen
//! ([`Lod::weight`](super::lod::Lod::weight)).
//!
//! A bone's rank is the logarithm of this product, in sixteenths of an octave. The bones of each rank are counted. All bones
//! above a threshold rank are selected. Bones of the threshold rank itself are selected in the order of instances and slots,
//! until the budget is used up. Instances that must be sampled in full are always sampled; their bones count against the
//! budget first.
//!
//! [`ExpectationTable`]: super::gate_table::ExpectationTable

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{BudgetJob, BudgetPass};
