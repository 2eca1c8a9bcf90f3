//! Twins of `kernels/terrain/`.

pub mod blend;
pub mod border;
pub mod despike;
pub mod field;
pub mod fixed;
pub mod height;
pub mod morph;
pub mod normals;
pub mod pad;
pub mod thermal;
pub mod wrap;
