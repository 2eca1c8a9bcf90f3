//! Simplified meshes.

mod attributes;
mod closed;
mod creature;
mod input;
mod measure;
mod progressive;
mod quality;
mod reduce;
mod shapes;
