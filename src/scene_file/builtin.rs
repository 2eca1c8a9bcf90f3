//! Models and maps that need no file, by the names that scene files give them after `builtin:`.

use image::RgbaImage;

use crate::InputError;
use crate::asset::Model;
use crate::surface::HeightMap;

#[cfg(feature = "samples")]
pub(super) use there::{CHARACTERS, MAPS, MODELS, map, model};

#[cfg(not(feature = "samples"))]
pub(super) use nothing::{CHARACTERS, MAPS, MODELS, map, model};

#[cfg(feature = "samples")]
mod there {
    use super::*;
    use crate::asset::Material;
    pub use crate::samples::MODELS;
    use crate::samples::{self, BuiltInMap};

    /// Models that a character may be.
    pub const CHARACTERS: [&str; 1] = ["creature"];

    /// Height maps, with colours.
    pub const MAPS: [&str; 4] = ["bricks", "cobbles", "text", "posts"];

    /// The colour of the creature, in linear light.
    const CLAY: [f32; 4] = [0.6, 0.3, 0.16, 1.0];

    /// Texels along an edge of a map.
    const TEXELS: u32 = 512;

    /// The model of this name.
    pub fn model(name: &str) -> Result<Model, InputError> {
        match name {
            "creature" => samples::model(name).map(of_clay),
            _ => samples::model(name),
        }
    }

    /// The model with a colour: it has no material of its own.
    fn of_clay(mut model: Model) -> Model {
        let material = Material::opaque("clay", CLAY);
        for mesh in &mut model.meshes {
            mesh.material = Some(model.materials.len());
        }
        model.materials.push(material);
        model
    }

    /// Heights and colours of the map of this name.
    pub fn map(name: &str) -> Result<(HeightMap, RgbaImage), InputError> {
        let map: BuiltInMap = name.parse()?;
        Ok((map.height_map(TEXELS)?, map.albedo(TEXELS)?))
    }
}

#[cfg(not(feature = "samples"))]
mod nothing {
    use super::*;

    pub const MODELS: [&str; 0] = [];
    pub const CHARACTERS: [&str; 0] = [];
    pub const MAPS: [&str; 0] = [];

    pub fn model(name: &str) -> Result<Model, InputError> {
        Err(InputError::new("file", name, "must be a file"))
    }

    pub fn map(name: &str) -> Result<(HeightMap, RgbaImage), InputError> {
        Err(InputError::new("relief", name, "must be a file"))
    }
}
