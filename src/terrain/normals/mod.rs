//! Slopes of height fields: exact integer central differences, and unit normals derived from them.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::NormalsPass;

/// Largest error of a component of a unit normal on any device, relative to the exact one.
///
/// Let ε = 2⁻²³ (WGSL lets `+ − ×` and conversions round to either neighbour). A component of (−dx, 2·scale, −dy) carries a
/// relative error of ε, its square 3ε, and a sum of three squares 5ε, whatever the order or fusion. The square root of that sum
/// carries 2.5ε. `inverseSqrt` adds 2 ULP ≤ 2ε, and the product ε. With the component's own ε the total is 6.5ε < 8e-7 of a
/// value of at most 1. The reference computes in f64 and rounds once (½ε).
pub const NORMAL_BOUND: f32 = 8.5e-7;
