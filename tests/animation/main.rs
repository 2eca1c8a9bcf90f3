//! Skeletons and clips, their import and their sampling, compared with independent code in double precision.

mod arithmetic;
mod bounded;
mod bounds;
mod compressed;
mod concatenation;
mod crowds;
mod exclusive;
mod frames;
mod gating;
use relievo_testing as harness;
mod import;
mod layers;
mod lod;
mod malformed;
mod measures;
mod meshes;
mod player;
mod rigid;
mod root_motion;
mod sampling;
mod scene;
mod scenes;
use relievo_testing::shader;
mod tangents;
mod textures;
