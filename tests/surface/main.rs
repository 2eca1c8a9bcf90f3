//! Surface mapping on the CPU.

mod tangents;
