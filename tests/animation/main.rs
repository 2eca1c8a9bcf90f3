//! Skeletons and clips, their import and their sampling, compared with independent code in double precision.

#[cfg(feature = "verify")]
mod arithmetic;
#[cfg(feature = "verify")]
mod bounded;
mod bounds;
mod compressed;
mod concatenation;
#[cfg(feature = "verify")]
mod crowds;
#[cfg(feature = "verify")]
mod exclusive;
#[cfg(feature = "verify")]
mod frames;
#[cfg(feature = "verify")]
mod gating;
#[cfg(feature = "verify")]
#[path = "../harness/mod.rs"]
mod harness;
mod import;
mod layers;
mod malformed;
#[cfg(feature = "verify")]
mod measures;
mod meshes;
mod player;
mod rigid;
mod root_motion;
mod sampling;
mod scene;
mod scenes;
#[cfg(feature = "verify")]
#[path = "../harness/shader.rs"]
mod shader;
mod tangents;
mod textures;
