//! Skeletons, clips, their import and their sampling, against code of its own in double precision.

mod concatenation;
mod import;
mod malformed;
mod meshes;
mod player;
mod sampling;
mod scene;
