//! Cone maps: acceleration maps for the method `cone`, which steps over cones. For each bilinear cell of a height map, a cone map
//! stores two values. The first is the height of the cell's highest corner. The second is the radius of the widest upright cone
//! on that corner in which a ray crosses the surface at most once.
//!
//! These are the relaxed cones of Policarpo and Oliveira (2007), made safe under bilinear filtering in the spirit of Bán and
//! Valasek (2024). A radius follows from comparing a cell with other cells. It is safe for every point of both compared cells,
//! not only for texel centers.
//!
//! The radius is at most the shorter edge of the map, in cells. On maps with few rows, the method `quadtree` is far cheaper.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::surface::cone_map::OPENING;
#[cfg(feature = "gpu")]
pub use pass::{ConeMapPass, Cones};

/// Largest allowed relative difference between a cone radius and the CPU reference, on any device.
///
/// A radius is a quotient (2.5 ULP) of a distance and a height difference (1 ULP), reduced by a millionth (1 ULP). The distance
/// is a square root of exact integers (1.5 ULP), or a sum of two products of such roots (3 ULP). Together this is 8 ULP < 1e-6.
/// The same quantities, with the same error, decide which nodes are skipped. A node that is not skipped gives at least the radius
/// at which it would be, so if rounding decides otherwise, the minimum is off by at most another 1e-6. Hence the bound of 2e-6.
pub const RADIUS_BOUND: f32 = 2e-6;
