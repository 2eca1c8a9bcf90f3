//! Cases of `kernels/baseline/`.

pub mod copy;
pub mod gather;
pub mod loads;
pub mod texels;
pub mod words;
