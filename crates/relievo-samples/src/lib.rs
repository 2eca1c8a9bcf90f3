//! Sample content for relievo that needs no files: a creature with clips, a rock, a wall, and height maps with matching colours.

pub use creature::creature;
pub use maps::BuiltInMap;
use relievo::InputError;
use relievo::asset::Model;
pub use shapes::{rock, wall};

pub mod creature;
pub mod maps;
mod shapes;

/// Names of the sample models, as [`model`] accepts them.
pub const MODELS: [&str; 3] = ["creature", "rock", "wall"];

/// Generates the sample model with the given name.
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

/// The samples as built-ins of scene files: the models of [`MODELS`], and the height maps of [`BuiltInMap`] with 512 texels along
/// an edge. The creature gets a clay-coloured material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Samples;

impl relievo::BuiltIns for Samples {
    fn model(&self, name: &str) -> Result<Model, InputError> {
        let mut found = model(name)?;
        if name == "creature" {
            // The creature has no material of its own, so it gets one here. The colour is in linear light.
            for mesh in &mut found.meshes {
                mesh.material = Some(found.materials.len());
            }
            found.materials.push(relievo::asset::Material::opaque("clay", [0.6, 0.3, 0.16, 1.0]));
        }
        Ok(found)
    }

    fn has_model(&self, name: &str) -> bool {
        MODELS.contains(&name)
    }

    fn map(&self, name: &str) -> Result<(relievo::ops::surface::HeightMap, image::RgbaImage), InputError> {
        const TEXELS: u32 = 512;
        let map: BuiltInMap = name.parse()?;
        Ok((map.height_map(TEXELS)?, map.albedo(TEXELS)?))
    }
}
