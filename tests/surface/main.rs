//! Surface mapping on the CPU.

mod crossings;
mod errors;
mod tangents;
