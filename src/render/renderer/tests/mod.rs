//! Pixel tests of a renderer without a scene. The host writes lists, instance rows and draws in place of the kernels.

mod formats;
mod layers;
mod limits;
mod mesh;
mod relief;
mod shading;
mod stage;
mod terrain;
