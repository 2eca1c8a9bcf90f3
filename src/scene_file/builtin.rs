//! Models and height maps that need no file, by the names that scene files give them after `builtin:`.

use image::RgbaImage;

use crate::InputError;
use crate::asset::Model;
use crate::surface::HeightMap;

/// Models and height maps that scene files name after `builtin:`. The crate `relievo-samples` has some.
pub trait BuiltIns {
    /// The model of this name.
    ///
    /// # Errors
    /// [`InputError`] for another name, which lists those there are.
    fn model(&self, name: &str) -> Result<Model, InputError>;

    /// The heights and the colours of the relief of this name.
    ///
    /// # Errors
    /// [`InputError`] for another name, which lists those there are.
    fn map(&self, name: &str) -> Result<(HeightMap, RgbaImage), InputError>;
}

/// Neither models nor height maps: a scene file may name files alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoBuiltIns;

impl BuiltIns for NoBuiltIns {
    fn model(&self, name: &str) -> Result<Model, InputError> {
        Err(nothing(name))
    }

    fn map(&self, name: &str) -> Result<(HeightMap, RgbaImage), InputError> {
        Err(nothing(name))
    }
}

fn nothing(name: &str) -> InputError {
    InputError::new("builtin", name, "must be a file: nothing is built in")
}
