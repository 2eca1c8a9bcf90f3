//! Terrain on the CPU: known answers, and the properties that make it seamless.

mod borders;
mod known_heights;
mod properties;
mod refusals;
