//! Surface mapping on the CPU.

#[cfg(feature = "verify")]
mod bounds;
#[cfg(feature = "verify")]
mod compared;
mod crossings;
mod errors;
mod tangents;
