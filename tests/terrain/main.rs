//! Terrain on the CPU: known answers, and the properties that make it seamless.

use relievo_testing as harness;

mod arithmetic;
mod borders;
mod decided;
mod erosion_fields;
mod ground;
mod hydraulic;
mod jobs;
mod known_heights;
mod noise;
mod properties;
mod refusals;
use relievo_testing::shader;
mod splitting;
mod textures;
