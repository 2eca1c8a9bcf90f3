//! The scene inside a program with its own device, targets and frames, on WebGPU's default limits without features.

use relievo_testing as harness;

mod bones;
mod bundles;
mod chunks;
#[cfg(unix)]
mod cost;
mod counts;
mod edited;
mod elevation;
mod endless;
mod endless_erosion;
mod endless_target;
mod frame;
mod geomorph;
mod ground_relief;
mod health;
mod host;
#[path = "../skinning/hull.rs"]
mod hull;
mod kinds;
mod layers;
mod levels;
mod life;
mod materials;
mod misuse;
mod morphing;
mod packages;
mod picked;
mod pieces;
mod placements;
mod promise;
mod query;
mod raw;
mod rays;
mod reach;
mod rebuild;
mod reliefs;
mod shading;
mod shadow;
mod sides;
mod solids;
mod stage;
mod successor;
mod surfaces;
mod targets;
mod terrain;
mod transparent;
mod uploads;
mod velocity;
mod views;
mod world;
