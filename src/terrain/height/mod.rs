//! Heights of windows onto the diamond-square surface of the whole plane, for `seamless` terrain (thesis B section 3.3.1). All
//! arithmetic is on integers, so that every device computes the same bits.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub(crate) use pass::pass;
