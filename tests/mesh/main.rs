//! Simplified meshes.

mod alike;
mod attributes;
mod closed;
mod creature;
mod damaged;
mod decided;
mod distance;
mod everywhere;
mod input;
mod measure;
mod parts;
mod progressive;
mod quality;
mod reduce;
mod shapes;
mod thin;
