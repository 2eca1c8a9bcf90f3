//! The command line as a user runs it.
#![cfg(all(feature = "gpu", feature = "cli"))]

#[path = "../harness/mod.rs"]
mod harness;

mod bad_input;
mod collapse;
mod commands;
mod crowd;
mod crowd_drawn;
mod pose;
mod priorities;
mod relief;
mod rest;
#[allow(dead_code, reason = "only the tests of the import write GLBs")]
#[path = "../animation/scene.rs"]
mod scene;
mod skin;
mod terrain;
