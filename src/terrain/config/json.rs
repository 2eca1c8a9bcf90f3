//! Reading of JSON objects with serde. Errors name the field, its value and the allowed range.

use std::marker::PhantomData;
use std::path::Path;

use serde::de::value::MapAccessDeserializer;
use serde::de::{DeserializeOwned, Error as _, IntoDeserializer, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use serde_path_to_error::Segment;

use crate::error::json::{message, refused_value, shown, unreadable};
use crate::{Error, InputError};

/// Wrapper that reads a struct from a JSON object only. Without it, serde would also accept an array of the struct's fields.
pub(crate) struct Object<T>(pub(crate) T);

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

/// Reads one JSON object. An error names the field that contains the fault, or `what` if the fault lies outside all fields.
pub(crate) fn from_json_object<T: DeserializeOwned>(what: &str, text: &str) -> Result<T, InputError> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let object: Object<T> = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
        let path = error.path().to_string();
        if matches!(path.as_str(), "." | "?") {
            return unreadable(what, error.inner());
        }
        // If the text is valid JSON, the fault must be a value, so the error quotes that value.
        let document: Option<Value> = serde_json::from_str(text).ok();
        document
            .and_then(|document| refused(&document, &error))
            .unwrap_or_else(|| unreadable(&path, error.inner()))
    })?;
    reader.end().map_err(|error| unreadable(what, &error))?;
    Ok(object.0)
}

/// Converts a parsed JSON object to a `T`, with the same errors as [`from_json_object`].
pub(crate) fn from_json_value<T: DeserializeOwned>(what: &str, value: &Value) -> Result<T, InputError> {
    let object: Object<T> = serde_path_to_error::deserialize(value).map_err(|error| {
        let whole = || InputError::new(what, shown(value), message(error.inner()));
        if error.path().to_string() == "." { whole() } else { refused(value, &error).unwrap_or_else(whole) }
    })?;
    Ok(object.0)
}

/// [`refused_value`] for the value in `document` that an error is about.
fn refused(document: &Value, error: &serde_path_to_error::Error<serde_json::Error>) -> Option<InputError> {
    let value = error.path().iter().try_fold(document, |value, segment| match segment {
        Segment::Map { key } => value.get(key),
        Segment::Seq { index } => value.get(*index),
        Segment::Enum { .. } | Segment::Unknown => None,
    })?;
    refused_value(&error.path().to_string(), value, error.inner())
}

/// Reads a variant of the enum `T` from the variant's name, a JSON string.
pub(crate) fn named<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<T, D::Error> {
    // A value that is not a string is treated as an empty name: the error then lists the valid names.
    let name = match Value::deserialize(deserializer)? {
        Value::String(name) => name,
        _ => String::new(),
    };
    T::deserialize(name.into_deserializer())
}

/// Reads an integer in `LOW..=HIGH`. JSON may write the integer with or without a fraction: `16` or `16.0`.
pub(crate) fn whole<'de, D: Deserializer<'de>, const LOW: u32, const HIGH: u32>(
    deserializer: D,
) -> Result<u32, D::Error> {
    let number = serde_json::Number::deserialize(deserializer)?;
    let is_allowed = |value: &f64| value.fract() == 0.0 && (LOW.into()..=HIGH.into()).contains(value);
    let refused = || D::Error::custom(format!("expected a whole number in {LOW}..={HIGH}"));
    number.as_f64().filter(is_allowed).map(|value| value as u32).ok_or_else(refused)
}

/// Reads a whole text file.
pub(crate) fn read_text(path: &Path) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(|error| Error::file(path, error))
}
