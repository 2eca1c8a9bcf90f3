//! Heights of windows onto a smooth surface that covers the whole plane, for `seamless` terrain without creases.
//!
//! A cell's center is interpolated from the 4 × 4 surrounding points of the coarser lattice. An edge point is interpolated from
//! four points on its line and from four new centers, two on each side of the line (Dyn, Levin and Gregory, "A 4-point
//! interpolatory subdivision scheme for curve design", Computer Aided Geometric Design 1987). Random offsets are the same as in
//! [`height`](super::height), but on edges their range is multiplied by 2^(−roughness / 2), the factor by which the range
//! shrinks over half a level (Saupe 1988). All arithmetic is on integers, so that every device computes the same bits.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub(crate) use pass::pass;
