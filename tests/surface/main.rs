//! Surface mapping on the CPU.

#[cfg(feature = "verify")]
mod bounds;
mod crossings;
mod errors;
mod tangents;
