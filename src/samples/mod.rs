//! Things to try relievo with, that need no file: a creature with clips, a rock, a wall, and height maps with
//! their colours.

pub mod creature;
pub mod maps;
mod shapes;

pub use creature::creature;
pub use maps::BuiltInMap;
pub use shapes::{rock, wall};
