//! Cone maps. For each bilinear cell of a height map they have the highest corner, and the widest upright cone on that corner
//! in which a ray crosses the surface at most once. The method `cone` steps over these cones.
//!
//! They are the relaxed cones of Policarpo and Oliveira (2007), made safe under bilinear filtering in the spirit of Bán and
//! Valasek (2024): the bounds hold for every point of both cells, not only for texel centers.
//!
//! A radius is at most the shorter edge of the map, in cells. On maps with few rows `quadtree` is far cheaper.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::surface::cone_map::OPENING;
#[cfg(feature = "gpu")]
pub use pass::{ConeMapPass, Cones};

/// Largest allowed relative difference between a radius and the reference, on any device.
///
/// A radius is a quotient (2.5 ULP) of a distance and a difference of heights (1 ULP), reduced by a millionth (1 ULP). The
/// distance is a square root of exact integers (1.5 ULP), or a sum of two products of such roots (3 ULP). Together this is 8
/// ULP < 1e-6. Comparisons of the same quantities decide which nodes are skipped; this changes the minimum by as much again.
pub const RADIUS_BOUND: f32 = 2e-6;
