//! Heights of a patch that is generated alone, with neighbours that wrap around (B section 3.3.1), for the border mode `wrap`.
//! A patch with equal corners tiles with itself bit for bit.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::WrapPass;
