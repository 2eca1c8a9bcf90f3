//! Terrain on the CPU: known answers, and the properties that make it seamless.

mod borders;
#[cfg(feature = "gpu")]
mod jobs;
mod known_heights;
mod properties;
mod refusals;
