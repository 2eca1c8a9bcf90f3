//! The command line as a user runs it.
#![cfg(all(feature = "gpu", feature = "cli"))]

#[path = "../harness/mod.rs"]
mod harness;

mod bad_input;
mod commands;
mod relief;
mod terrain;
