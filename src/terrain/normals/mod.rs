//! Slopes of a field: integer central differences, exact, and unit normals from them.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::NormalsPass;

/// How far a component of a unit normal may lie from the exact one, on any device.
///
/// With ε = 2⁻²³ (WGSL lets `+ − ×` and conversions round to either neighbour): a component of (−dx, 2·scale,
/// −dy) carries ε, its square 3ε, a sum of three squares 5ε whatever the order or fusion, the square root of
/// that 2.5ε; `inverseSqrt` adds 2 ULP ≤ 2ε, the product ε. With the component's own ε: 6.5ε < 8e-7 of a value
/// of at most 1; the reference computes in f64 and rounds once (½ε).
pub const NORMAL_BOUND: f32 = 8.5e-7;
