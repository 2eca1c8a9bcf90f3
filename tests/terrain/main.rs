//! Terrain on the CPU: known answers, and the properties that make it seamless.

#[cfg(feature = "gpu")]
#[path = "../harness/mod.rs"]
mod harness;

#[cfg(feature = "verify")]
mod arithmetic;
mod borders;
mod decided;
mod erosion_fields;
mod ground;
mod hydraulic;
#[cfg(feature = "gpu")]
mod jobs;
mod known_heights;
mod properties;
mod refusals;
#[cfg(feature = "verify")]
#[path = "../harness/shader.rs"]
mod shader;
#[cfg(feature = "gpu")]
mod splitting;
mod textures;
