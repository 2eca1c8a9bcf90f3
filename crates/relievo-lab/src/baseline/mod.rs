//! Kernels against which others are measured: the cost of moving the same bytes, and of arithmetic that cannot
//! be avoided. Every speed figure of relievo is a ratio to one of them in the same run.

pub mod copy;
pub mod gather;
pub mod loads;
pub mod texels;
pub mod words;
