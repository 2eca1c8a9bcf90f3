//! Seeded terrain: integer heights that are the same bits on every device (B section 3.3 and 4.4).

#[cfg(feature = "verify")]
pub mod bench;
pub mod blend;
pub mod border;
pub mod config;
pub mod despike;
pub mod export;
pub mod features;
pub mod field;
#[cfg(feature = "gpu")]
pub mod fields;
pub mod fixed;
#[cfg(feature = "gpu")]
pub mod generator;
pub mod ground;
pub mod height;
mod json;
pub mod mesh;
pub mod morph;
pub mod normals;
pub mod pad;
pub mod recipe;
pub mod texture;
pub mod thermal;
#[cfg(feature = "verify")]
pub mod verify;
pub mod wrap;
