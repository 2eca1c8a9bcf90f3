//! Simplified meshes.

mod attributes;
mod closed;
mod creature;
mod input;
mod measure;
mod quality;
mod reduce;
mod shapes;
