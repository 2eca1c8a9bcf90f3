//! Cone maps: for each bilinear cell of a height map its highest corner, and the widest upright cone on it that a
//! ray crosses with at most one crossing of the surface, the first. What `cone` steps over.
//!
//! Relaxed cones (Policarpo and Oliveira 2007) made safe under bilinear filtering, in the spirit of Bán and
//! Valasek (2024): bounds hold for every point of both cells, not for texel centres alone.
//!
//! A radius is at most the shorter edge of the map in cells: on maps of a few rows `quadtree` is far cheaper.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{ConeMapPass, Cones};

/// Distance over size from which a node counts whole. Larger is tighter and slower: 4 saves
/// a march one load in twenty-five, and takes half as long again to make.
pub const OPENING: f32 = 2.0;

/// How far a radius may lie from the reference's, relative to it, on any device.
///
/// A radius is a quotient (2.5 ULP) of a distance (a square root of exact integers, 1.5 ULP, or a sum of two
/// products of them: 3 ULP) and a difference of heights (1 ULP), less a millionth (1 ULP): 8 ULP < 1e-6. Which
/// nodes are skipped depends on comparisons of the same quantities, and changes the least by as much again.
pub const RADIUS_BOUND: f32 = 2e-6;
