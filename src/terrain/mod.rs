//! Terrain generated from a seed. Heights are integers, and every device computes the same bits (thesis B sections 3.3 and 4.4).
//!
//! **Decided**: heights are integers. Thesis B requires exactly the same content on every client (3.3), but its floating-point
//! heights would be rounded differently on different devices.

pub mod blend;
pub mod border;
pub mod config;
pub mod cover;
pub mod despike;
pub mod elevation;
#[cfg(feature = "gpu")]
pub(crate) mod erosion;
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
pub mod hydraulic;
#[cfg(feature = "gpu")]
pub(crate) mod injection;
pub(crate) mod lattice;
#[cfg(feature = "gpu")]
pub(crate) mod levels;
pub mod limit;
#[cfg(feature = "gpu")]
pub mod materials;
pub mod mesh;
pub mod morph;
pub mod node;
pub mod node_normals;
pub mod noise;
pub mod normals;
pub mod pad;
pub mod quadtree;
pub mod recipe;
#[cfg(feature = "gpu")]
pub mod regions;
pub mod remainder;
pub mod replace;
pub mod smooth;
pub mod texture;
pub mod thermal;
pub mod window;
pub mod wrap;
