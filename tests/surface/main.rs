//! Surface mapping on the CPU.

#[cfg(feature = "gpu")]
mod bounds;
mod crossings;
mod errors;
mod tangents;
