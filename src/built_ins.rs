//! Built-in models and height maps, which scene files name with the prefix `builtin:`.

use image::RgbaImage;

use crate::InputError;
use crate::asset::Model;
use crate::surface::HeightMap;

/// A provider of the models and height maps that scene files name with the prefix `builtin:`. The crate `relievo-samples` has a
/// provider.
pub trait BuiltIns {
    /// The built-in model with this name.
    ///
    /// # Errors
    /// [`InputError`] for an unknown name; the message lists the existing names.
    fn model(&self, name: &str) -> Result<Model, InputError>;

    /// Whether there is a built-in model with this name. By default the model is made to find out.
    fn has_model(&self, name: &str) -> bool {
        self.model(name).is_ok()
    }

    /// The heights and colours of the built-in relief with this name.
    ///
    /// # Errors
    /// [`InputError`] for an unknown name; the message lists the existing names.
    fn map(&self, name: &str) -> Result<(HeightMap, RgbaImage), InputError>;
}

/// A provider without models and height maps, for scene files that name no built-ins.
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
