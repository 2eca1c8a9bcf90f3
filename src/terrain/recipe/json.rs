//! JSON form of configurations and recipes: thesis B's keys and relievo's optional keys.

use serde::Deserialize;

use super::Recipe;
use crate::InputError;
use crate::terrain::config::{
    Border, HeightGenerator, HeightInterpolation, Object, Offset, TerrainConfig, Zone, from_json_object,
    named, whole,
};
use crate::terrain::hydraulic::Hydraulic;
use crate::terrain::thermal::Thermal;

/// JSON form of a recipe. One object holds the fields of the configuration and of erosion.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct Raw {
    #[serde(deserialize_with = "whole::<_, 3, 4097>")]
    patch_size: u32,
    scale_factor: f64,
    seed: String,
    roughness: Option<f64>,
    #[serde(default, deserialize_with = "whole::<_, 0, 8>")]
    coarse_levels: u32,
    #[serde(default, deserialize_with = "named")]
    offset: Offset,
    #[serde(default, deserialize_with = "named")]
    generator: HeightGenerator,
    #[serde(default, deserialize_with = "named")]
    interpolation: HeightInterpolation,
    border: Option<RawBorder>,
    corners: Option<RawCorners>,
    terrain_scale: Option<f64>,
    texture_tile: Option<f64>,
    #[serde(default)]
    triplanar: bool,
    #[serde(default)]
    variation: f64,
    zones: Option<Vec<Object<Zone>>>,
    thermal: Option<Object<Thermal>>,
    hydraulic: Option<Object<Hydraulic>>,
    thermal_after: Option<Object<Thermal>>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected \"seamless\", \"wrap\" or {\"blend\": samples}")]
enum RawBorder {
    Named(#[serde(deserialize_with = "named")] Border),
    Blend(Object<RawBlend>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawBlend {
    blend: serde_json::Number,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a height or an array of four heights")]
enum RawCorners {
    All(f64),
    Each([f64; 4]),
}

impl RawBorder {
    /// Converts the border and checks the transition's width. Serde does not make this check, because a serde error inside an
    /// untagged enum would quote the whole value.
    fn border(self) -> Result<Border, InputError> {
        match self {
            Self::Named(border) => Ok(border),
            Self::Blend(Object(RawBlend { blend })) => {
                let refused =
                    |_| InputError::new("border.blend", &blend, "must be a whole number in 1..=4096");
                whole::<_, 1, 4096>(&blend).map(Border::Blend).map_err(refused)
            }
        }
    }
}

impl Raw {
    fn recipe(self) -> Result<Recipe, InputError> {
        let config = TerrainConfig {
            patch_size: self.patch_size,
            scale_factor: self.scale_factor,
            seed: self.seed,
            roughness: self.roughness.unwrap_or(1.0),
            coarse_levels: self.coarse_levels,
            offset: self.offset,
            generator: self.generator,
            interpolation: self.interpolation,
            border: self.border.map_or(Ok(Border::Seamless), RawBorder::border)?,
            corners: self.corners.map_or([0.0; 4], |corners| match corners {
                RawCorners::All(height) => [height; 4],
                RawCorners::Each(heights) => heights,
            }),
            terrain_scale: self.terrain_scale.unwrap_or(1.0),
            texture_tile: self.texture_tile,
            triplanar: self.triplanar,
            variation: self.variation,
            zones: self.zones.map_or_else(
                || Zone::defaults(self.scale_factor, self.offset),
                |zones| zones.into_iter().map(|zone| zone.0).collect(),
            ),
        };
        let recipe = Recipe {
            thermal: self.thermal.map(|object| object.0),
            hydraulic: self.hydraulic.map(|object| object.0),
            thermal_after: self.thermal_after.map(|object| object.0),
            ..Recipe::new(config)
        };
        recipe.validate(&[], 0).map_err(InputError::in_json)?;
        Ok(recipe)
    }
}

impl TerrainConfig {
    /// Reads a configuration from thesis B's JSON. Use [`Recipe::from_json`] for text that includes erosion.
    ///
    /// # Errors
    /// [`InputError`] for text that is not valid JSON, for unknown or missing keys, for values out of bounds, and for the
    /// keys of erosion (`thermal`, `hydraulic`, `thermalAfter`).
    pub fn from_json(text: &str) -> Result<Self, InputError> {
        let Recipe { config, thermal, hydraulic, thermal_after, .. } = Recipe::from_json(text)?;
        let given = [
            ("thermal", thermal.is_some()),
            ("hydraulic", hydraulic.is_some()),
            ("thermalAfter", thermal_after.is_some()),
        ];
        match given.into_iter().find(|(_, given)| *given) {
            Some((field, _)) => {
                Err(InputError::new(field, "given", "must be left out where only a configuration is read"))
            }
            None => Ok(config),
        }
    }
}

impl Recipe {
    /// Reads a recipe from a JSON object with the keys of a configuration and optional keys for erosion. `thermal` and
    /// `thermalAfter` are objects with `iterations` and `talus`. `hydraulic` is an object with the fields of [`Hydraulic`].
    /// Missing optional keys get their defaults.
    ///
    /// # Errors
    /// [`InputError`] for text that is not valid JSON, for unknown or missing keys, and for values out of bounds.
    pub fn from_json(text: &str) -> Result<Self, InputError> {
        from_json_object::<Raw>("config", text)?.recipe()
    }

    /// Converts parsed JSON to a recipe; see [`Recipe::from_json`].
    ///
    /// # Errors
    /// [`InputError`], as [`Recipe::from_json`].
    pub fn from_value(value: &serde_json::Value) -> Result<Self, InputError> {
        crate::terrain::config::from_json_value::<Raw>("config", value)?.recipe()
    }
}
