//! Configurations and features in JSON: B's keys and relievo's optional ones. An error names the field, its
//! value and the allowed range.

use std::marker::PhantomData;
use std::path::Path;

use serde::de::value::MapAccessDeserializer;
use serde::de::{DeserializeOwned, IntoDeserializer, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

#[cfg(feature = "gpu")]
use crate::error::json::{message, shown};
use crate::error::json::{refused_value, unreadable};
use crate::terrain::config::Zone;
use crate::terrain::config::{Border, Config, Interpolation, Offset};
use crate::{Error, InputError};

/// `Config` as JSON stores it.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct Raw {
    patch_size: serde_json::Number,
    scale_factor: f64,
    seed: String,
    #[serde(default)]
    roughness: Option<f64>,
    #[serde(default)]
    coarse_levels: Option<serde_json::Number>,
    #[serde(default, deserialize_with = "named")]
    offset: Offset,
    #[serde(default, deserialize_with = "named")]
    interpolation: Interpolation,
    #[serde(default)]
    border: RawBorder,
    #[serde(default)]
    corners: Option<RawCorners>,
    #[serde(default)]
    terrain_scale: Option<f64>,
    #[serde(default)]
    texture_tile: Option<f64>,
    #[serde(default)]
    triplanar: bool,
    #[serde(default)]
    variation: Option<f64>,
    #[serde(default)]
    zones: Option<Vec<Object<Zone>>>,
    #[serde(default)]
    thermal: Option<Object<RawThermal>>,
    #[serde(default)]
    hydraulic: Option<Object<RawHydraulic>>,
    #[serde(default)]
    thermal_after: Option<Object<RawThermal>>,
}

/// Thermal erosion as JSON stores it.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(crate) struct RawThermal {
    pub iterations: serde_json::Number,
    pub talus: Option<f64>,
}

/// Hydraulic erosion as JSON stores it.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(crate) struct RawHydraulic {
    pub iterations: Option<serde_json::Number>,
    pub rain: Option<f64>,
    pub evaporation: Option<f64>,
    pub capacity: Option<f64>,
    pub threshold: Option<f64>,
    pub erosion: Option<f64>,
    pub deposition: Option<f64>,
    pub talus: Option<f64>,
    pub creep: Option<f64>,
}

/// What follows generation, as JSON stores it beside the configuration.
#[derive(Default)]
pub(crate) struct RawErosion {
    pub thermal: Option<RawThermal>,
    pub hydraulic: Option<RawHydraulic>,
    pub thermal_after: Option<RawThermal>,
}

#[derive(Default)]
enum RawBorder {
    #[default]
    Seamless,
    Wrap,
    Blend(serde_json::Number),
}

impl<'de> Deserialize<'de> for RawBorder {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(BorderVisitor)
    }
}

struct BorderVisitor;

impl<'de> Visitor<'de> for BorderVisitor {
    type Value = RawBorder;

    fn expecting(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        text.write_str("\"seamless\", \"wrap\" or {\"blend\": samples}")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<RawBorder, E> {
        match name {
            "seamless" => Ok(RawBorder::Seamless),
            "wrap" => Ok(RawBorder::Wrap),
            _ => Err(E::invalid_value(Unexpected::Str(name), &self)),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<RawBorder, A::Error> {
        let other = |key: &str| serde::de::Error::invalid_value(Unexpected::Other(key), &self);
        let Some(key) = map.next_key::<String>()? else { return Err(other("{}")) };
        if key != "blend" {
            return Err(other(&key));
        }
        let width = map.next_value()?;
        map.next_key::<String>()?.map_or(Ok(RawBorder::Blend(width)), |key| Err(other(&key)))
    }
}

/// A struct that JSON stores as an object. Serde alone would also accept an array of its fields.
pub(super) struct Object<T>(pub(super) T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Object<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ObjectVisitor<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for ObjectVisitor<T> {
            type Value = T;

            fn expecting(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                text.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map))
            }
        }

        deserializer.deserialize_map(ObjectVisitor(PhantomData)).map(Self)
    }
}

/// Reads one JSON object. An error names the field in which it lies, or `what` when it lies outside all fields.
pub(crate) fn from_json_object<T: DeserializeOwned>(what: &str, text: &str) -> Result<T, InputError> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let object: Object<T> = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
        let path = error.path().to_string();
        if matches!(path.as_str(), "." | "?") {
            return unreadable(what, error.inner());
        }
        // In a text that is JSON, a value is what is wrong.
        let document: Option<Value> = serde_json::from_str(text).ok();
        document
            .and_then(|document| refused_value(&document, &error))
            .unwrap_or_else(|| unreadable(&path, error.inner()))
    })?;
    reader.end().map_err(|error| unreadable(what, &error))?;
    Ok(object.0)
}

/// As [`from_json_object`], from an object that has been read.
#[cfg(feature = "gpu")]
fn from_json_value<T: DeserializeOwned>(what: &str, value: &Value) -> Result<T, InputError> {
    let object: Object<T> = serde_path_to_error::deserialize(value).map_err(|error| {
        let whole = || InputError::new(what, shown(value), message(error.inner()));
        if error.path().to_string() == "." {
            whole()
        } else {
            refused_value(value, &error).unwrap_or_else(whole)
        }
    })?;
    Ok(object.0)
}

/// A name of one of the values of `T`.
fn named<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<T, D::Error> {
    // What is no text has no name, and the error lists the names.
    let name = match Value::deserialize(deserializer)? {
        Value::String(name) => name,
        _ => String::new(),
    };
    T::deserialize(name.into_deserializer())
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a height or an array of four heights")]
enum RawCorners {
    All(f64),
    Each([f64; 4]),
}

impl Config {
    /// Reads a configuration from B's JSON. [`Recipe::from_json`](crate::terrain::recipe::Recipe::from_json) reads erosion too.
    ///
    /// # Errors
    /// [`InputError`] for text that is not such JSON, for unknown keys, for values out of bounds, and for erosion, which a
    /// configuration does not have.
    pub fn from_json(text: &str) -> Result<Self, InputError> {
        let (config, RawErosion { thermal, hydraulic, thermal_after }) = Self::with_erosion(text)?;
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

    /// A configuration, and the erosion that stands beside it.
    ///
    /// # Errors
    /// [`InputError`] for text that is not such JSON, for unknown keys, and for values of the configuration out of bounds.
    pub(crate) fn with_erosion(text: &str) -> Result<(Self, RawErosion), InputError> {
        Self::of_raw(from_json_object("config", text)?)
    }

    /// As [`Config::with_erosion`], from an object that has been read.
    ///
    /// # Errors
    /// The same.
    #[cfg(feature = "gpu")]
    pub(crate) fn with_erosion_of(value: &Value) -> Result<(Self, RawErosion), InputError> {
        Self::of_raw(from_json_value("config", value)?)
    }

    fn of_raw(raw: Raw) -> Result<(Self, RawErosion), InputError> {
        let border = match raw.border {
            RawBorder::Seamless => Border::Seamless,
            RawBorder::Wrap => Border::Wrap,
            RawBorder::Blend(width) => Border::Blend(whole("border.blend", &width, 1, 4096)?),
        };
        let config = Self {
            patch_size: whole("patchSize", &raw.patch_size, 3, 4097)?,
            scale_factor: raw.scale_factor,
            seed: raw.seed,
            roughness: raw.roughness.unwrap_or(1.0),
            coarse_levels: raw.coarse_levels.map_or(Ok(0), |levels| whole("coarseLevels", &levels, 0, 8))?,
            offset: raw.offset,
            interpolation: raw.interpolation,
            border,
            corners: raw.corners.map_or([0.0; 4], |corners| match corners {
                RawCorners::All(height) => [height; 4],
                RawCorners::Each(heights) => heights,
            }),
            terrain_scale: raw.terrain_scale.unwrap_or(1.0),
            texture_tile: raw.texture_tile,
            triplanar: raw.triplanar,
            variation: raw.variation.unwrap_or(0.0),
            zones: raw.zones.map_or_else(
                || Zone::defaults(raw.scale_factor, raw.offset),
                |zones| zones.into_iter().map(|zone| zone.0).collect(),
            ),
        };
        config.validate().map_err(InputError::in_json)?;
        let [thermal, thermal_after] = [raw.thermal, raw.thermal_after].map(|raw| raw.map(|raw| raw.0));
        let hydraulic = raw.hydraulic.map(|raw| raw.0);
        Ok((config, RawErosion { thermal, hydraulic, thermal_after }))
    }
}

/// Reads a JSON number that must be an integer in `low..=high`.
pub(crate) fn whole(
    field: &str,
    number: &serde_json::Number,
    low: u32,
    high: u32,
) -> Result<u32, InputError> {
    (number.as_u64().or_else(|| {
        number.as_f64().filter(|value| value.fract() == 0.0 && *value >= 0.0).map(|value| value as u64)
    }))
    .and_then(|value| u32::try_from(value).ok())
    .filter(|value| (low..=high).contains(value))
    .ok_or_else(|| InputError::new(field, number, format!("must be a whole number in {low}..={high}")))
}

/// Reads a text file.
pub(crate) fn read_text(path: &Path) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(|error| Error::file(path, error))
}
