//! Diamond-square heights of a patch that is generated without its neighbours (thesis B section 3.3.1), for the border mode
//! `wrap`. At an edge of the patch, samples near the opposite edge take the place of the missing neighbours. A patch with equal
//! corners tiles with itself bit for bit.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub(crate) use pass::pass;
