//! Slopes of height fields: exact integer central differences, and the unit normals derived from them.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::NormalsPass;

/// Bound on the absolute error of each component of a unit normal, on any device.
///
/// Derivation, with ε = 2⁻²³ (WGSL lets `+ − ×` and conversions round up or down): A component of (−dx, 2·scale, −dy) has a
/// relative error of ε. Its square has 3ε, and the sum of the three squares has 5ε, in any order and with any fusion. The square
/// root of the sum has 2.5ε. `inverseSqrt` adds 2 ULP ≤ 2ε, and the final product adds ε. With the component's own ε, the total
/// relative error is 6.5ε < 8e-7. A component is at most 1, so this bounds the absolute error too. The CPU reference computes in
/// f64 and rounds once (½ε).
pub const NORMAL_BOUND: f32 = 8.5e-7;
