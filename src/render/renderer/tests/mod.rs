//! Pixels of a renderer without a scene: lists, rows and draws are made here as kernels would make them.

mod formats;
mod layers;
mod limits;
mod mesh;
mod relief;
mod shading;
mod stage;
mod terrain;
