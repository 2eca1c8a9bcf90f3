//! Heights from octaves of noise on the whole plane, for `seamless` terrain: spectral synthesis (`fbm`), the ridged multifractal
//! (`ridged`) and simplex noise (`simplex`).
//!
//! Octave l has a lattice of spacing s_l = base spacing / 2^l and the range r_l = [`TerrainConfig::level_range`]. Lattice points
//! have random gradients of lengths 1.32 to 1.41 per spacing, so that the noise n_l fills ±1. `ridged`, and octave 0 of `fbm`,
//! also have random values in ±1/2 on the lattice points (v_l below).
//!
//! - `fbm` is r_0·v_0 + Σ r_l·n_l. Gradient noise is 0 on its lattice. Octaves whose lattices hold all samples of a region are
//!   therefore left out, and a coarser region still has exactly every second sample of a finer one.
//! - `ridged` is r_0·R_0 + Σ r_l·w·R_l with R_l = 1 − |v_l + n_l| and w = 1 − |v_0 + n_0| / 2, l ≥ 1. Without the values v_l, all
//!   crests would run through all lattice points. With them, no octave vanishes on its lattice. The number of octaves is
//!   therefore the same at every resolution.
//! - `simplex` is Σ r_l·n_l with n_l on a triangular lattice. It does not vanish at samples, so its number of octaves is fixed
//!   too.
//!
//! All arithmetic is on integers, so that every device computes the same bits. Positions are relative to the cell. World
//! coordinates are only compared and hashed, so that nothing degrades far from the origin.
//!
//! # Bounds
//!
//! No step overflows `i32`. Noise values are in Q4.27:
//! - Gradient components are at most 170 in Q.7, and gradients at most 180. On squares, an offset is at most √2·2^20: a ramp is
//!   at most 1.99·2^27. With a value of at most 2^26, a corner is at most 2.49·2^27. Interpolation stays between the corners, and
//!   differences of corners are below 5·2^27 < 2^30.
//! - At most, noise on squares is 0.993 (all gradients point to the cell's center) and simplex noise 0.938 (by search over a fine
//!   grid; the test `noise_and_its_derivatives_are_bounded` repeats it). So |v + n| < 1.5, and w is in 1/4 to 1.
//! - In simplex noise, a ramp is at most 1.41·1.008·2^27, and 8 times this is below 1.43·2^30. The sum of three contributions is
//!   at most 0.086·2^30, and 11 times this is below 0.95·2^30.
//! - [`TerrainConfig::validate`] refuses ranges with r_0 + Σ (r_l + 1) above the largest height, 2^30 − 1. So r_0 < 2^29, which
//!   the products need.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(doc)]
use crate::terrain::config::TerrainConfig;
#[cfg(feature = "gpu")]
pub(crate) use pass::NoisePass;

/// 2^32 divided by the golden ratio: its multiples differ in all bits.
const GOLDEN: u32 = 0x9e37_79b9;

/// Key of an octave's random words. Lattices of different octaves have common points, so their words must differ.
fn octave_key(key: [u32; 2], octave: u32) -> [u32; 2] {
    [key[0], key[1].wrapping_add(GOLDEN.wrapping_mul(octave + 1))]
}

/// Position of an octave's triangular lattice, in world coordinates below its spacing of 2^`log2`.
fn shift(octave: u32, log2: u32) -> [u32; 2] {
    [GOLDEN, 0x85eb_ca6b].map(|factor| factor.wrapping_mul(octave + 1) >> (32 - log2))
}
