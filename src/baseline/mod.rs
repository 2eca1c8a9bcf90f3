//! Kernels that others are measured against: what moving the same bytes costs, and the arithmetic that
//! cannot be avoided. Every speed figure of relievo is a ratio to one of them in the same run.

pub mod copy;
pub mod gather;
pub mod loads;
pub mod words;
