//! Skeletons, clips, their import and their sampling, against code of its own in double precision.

#[cfg(feature = "gpu")]
mod arithmetic;
#[cfg(feature = "gpu")]
mod bounded;
mod bounds;
mod concatenation;
#[cfg(feature = "gpu")]
mod crowds;
#[cfg(feature = "gpu")]
mod frames;
#[cfg(feature = "gpu")]
mod gating;
#[cfg(feature = "gpu")]
#[path = "../harness/mod.rs"]
mod harness;
mod import;
mod layers;
mod malformed;
mod meshes;
mod player;
mod rigid;
mod root_motion;
mod sampling;
mod scene;
mod scenes;
#[cfg(feature = "gpu")]
#[path = "../harness/shader.rs"]
mod shader;
mod tangents;
mod textures;
