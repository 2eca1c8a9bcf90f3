//! Things to try relievo with, that need no file: a creature with clips, a rock, a wall, and height maps with
//! their colours.

pub mod creature;
pub mod maps;
mod shapes;

pub use creature::creature;
pub use maps::BuiltInMap;
pub use shapes::{rock, wall};

use crate::InputError;
use crate::asset::Model;

/// The names of the models.
pub const MODELS: [&str; 3] = ["creature", "rock", "wall"];

/// The model of a name.
///
/// # Errors
/// [`InputError`] for a name that is not one of [`MODELS`].
pub fn model(name: &str) -> Result<Model, InputError> {
    match name {
        "creature" => creature(),
        "rock" => rock(),
        "wall" => wall(),
        _ => Err(InputError::new("model", name, format!("must be one of {}", MODELS.join(", ")))),
    }
}
