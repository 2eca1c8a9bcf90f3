//! Simplified meshes.

mod closed;
mod input;
mod measure;
mod quality;
mod shapes;
