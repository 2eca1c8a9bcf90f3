//! Kernels against which others are measured: the cost of moving the same bytes, and of arithmetic that cannot
//! be avoided. Every speed figure of relievo is a ratio to one of them in the same run.

#[cfg(feature = "verify")]
pub(crate) mod bench;
pub(crate) mod copy;
pub(crate) mod gather;
pub(crate) mod loads;
pub(crate) mod texels;
#[cfg(feature = "verify")]
pub(crate) mod verify;
pub(crate) mod words;
