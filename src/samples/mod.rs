//! Things to try relievo with, that need no file: a creature with clips, and height maps with their colours.

pub mod creature;
pub mod maps;

pub use creature::creature;
pub use maps::BuiltInMap;
