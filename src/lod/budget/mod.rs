//! Budgets of triangles: the least factor of the metric at which the instances that views see fit.
//!
//! Every coarser level that an instance may take saves triangles from some factor on. The device sums these savings over the
//! logarithm of the factor in a histogram, rank by rank, and finds the least factor at which the triangles are within the
//! limit. A second histogram divides the bin of this factor into parts of 2^(1/65536).
//!
//! Ranks are coarsened one after the other, from 0 on: an object of rank 1 gets a factor above 1 only once all of rank 0 is at
//! its coarsest. Objects of rank [`NO_RANK`] are spared. The factor grows at once where the limit would be exceeded, and
//! falls in time. Where both levels of all fades do not fit, all fades end in that frame.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{BudgetBuffers, BudgetPass, BudgetStage, BudgetStages};

pub use crate::shared::lod::budget::{BudgetParams, BudgetWork};
pub use crate::shared::lod::object::{NO_RANK, RANKS};
