//! Heights of a window onto a smoothly interpolated surface of the whole plane, for `seamless` terrain without creases.
//!
//! Centers of cells are interpolated from four by four points of the coarser lattice. Edge points are interpolated from four
//! points of their line and the four new centers beside them (Dyn, Levin and Gregory, "A 4-point interpolatory subdivision
//! scheme for curve design", Computer Aided Geometric Design 1987). Random offsets are those of [`height`](super::height), with
//! a range half a step smaller on edges (Saupe 1988). All arithmetic is on integers, so that every device computes the same
//! bits.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::SmoothPass;
