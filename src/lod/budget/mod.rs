//! Triangle budgets: the smallest factor of the LOD metric at which the triangles of all visible instances fit a limit.
//!
//! As the factor grows, an instance changes to coarser levels, and each change saves triangles. The device sums these savings in
//! a histogram over the logarithm of the factor, with separate bins for each rank of objects. It then finds the smallest factor
//! at which the triangles are within the limit. A second histogram divides the bin of this factor into parts. The factors of
//! successive parts have a ratio of 2^(1/65536).
//!
//! Ranks are coarsened one after the other, beginning with rank 0. An object of rank 1 gets a factor above 1 only once all
//! objects of rank 0 are at their coarsest level. Objects of rank [`NO_RANK`] are never coarsened. The factor grows at once if
//! the limit would be exceeded, and falls gradually over time. A fade draws two levels. If the triangles of all fades do not fit
//! the limit, all fades end in that frame.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{BudgetBuffers, BudgetPass, BudgetStage, BudgetStages};

pub use crate::shared::lod::budget::{BudgetParams, BudgetWork};
pub use crate::shared::lod::object::{NO_RANK, RANKS};
