//! Skeletons, clips, their import and their sampling, against code of its own in double precision.

mod concatenation;
#[cfg(feature = "gpu")]
mod gating;
mod import;
mod malformed;
mod player;
mod sampling;
mod scene;
