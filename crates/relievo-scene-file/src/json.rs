//! JSON as a tree, and a cursor into this tree that reports every mistake with path, value and bound.

use std::fmt;

use relievo::InputError;
use relievo::error::json::{shown, unreadable};
use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

/// The largest absolute value of a coordinate, in world units.
pub(super) const COORDINATE: f64 = 1e9;

/// A JSON value in which no object has a field twice.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Json(Value);

impl Json {
    /// Parses a JSON text.
    ///
    /// # Errors
    /// [`InputError`] in two cases: the text is not JSON, or a field is given twice. The error has the path as far as it is
    /// known.
    pub fn parse(text: &str) -> Result<Self, InputError> {
        let mut reader = serde_json::Deserializer::from_str(text);
        let json: Self = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
            let path = error.path().to_string();
            unreadable(if matches!(path.as_str(), "." | "?") { "scene" } else { &path }, error.inner())
        })?;
        reader.end().map_err(|error| unreadable("scene", &error))?;
        Ok(json)
    }

    /// A cursor at the root value.
    pub fn at(&self) -> At<'_> {
        At { path: String::new(), value: &self.0 }
    }
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(JsonVisitor)
    }
}

struct JsonVisitor;

impl<'de> Visitor<'de> for JsonVisitor {
    type Value = Json;

    fn expecting(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        text.write_str("JSON")
    }

    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json(Value::Null))
    }

    fn visit_bool<E>(self, value: bool) -> Result<Json, E> {
        Ok(Json(Value::Bool(value)))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Json, E> {
        Ok(Json(value.into()))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Json, E> {
        Ok(Json(value.into()))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Json, E> {
        let number = Number::from_f64(value).ok_or_else(|| E::custom("must be finite"))?;
        Ok(Json(Value::Number(number)))
    }

    fn visit_str<E>(self, value: &str) -> Result<Json, E> {
        Ok(Json(value.into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Json, A::Error> {
        let mut all = Vec::new();
        while let Some(Json(value)) = list.next_element()? {
            all.push(value);
        }
        Ok(Json(Value::Array(all)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<Json, A::Error> {
        let mut all = Map::new();
        while let Some(name) = fields.next_key::<String>()? {
            if all.contains_key(&name) {
                fields.next_value::<Twice>()?;
            }
            let Json(value) = fields.next_value()?;
            all.insert(name, value);
        }
        Ok(Json(Value::Object(all)))
    }
}

/// The value of a repeated field. Its deserialization fails, so that the error has the field's path.
struct Twice;

impl<'de> Deserialize<'de> for Twice {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(de::Error::custom("is given twice"))
    }
}

/// A cursor: a value and its path from the root, such as `characters[1].scatter.count`.
#[derive(Debug, Clone)]
pub(super) struct At<'a> {
    pub path: String,
    value: &'a Value,
}

impl<'a> At<'a> {
    /// An error for the value at the cursor.
    pub fn error(&self, bound: impl Into<String>) -> InputError {
        InputError::new(self.path(), shown(self.value), bound)
    }

    fn path(&self) -> &str {
        if self.path.is_empty() { "scene" } else { &self.path }
    }

    /// The JSON value at the cursor.
    pub fn value(&self) -> &'a Value {
        self.value
    }

    /// The fields of the object at the cursor. Fields that are not in `known` are refused.
    pub fn fields(&self, known: &[&str]) -> Result<Fields<'a>, InputError> {
        let Value::Object(fields) = self.value else { return Err(self.error("must be an object")) };
        let all = Fields { path: self.path.clone(), fields };
        let unknown = fields.keys().find(|name| !known.contains(&name.as_str()));
        match unknown.and_then(|name| all.get(name)) {
            None => Ok(all),
            Some(field) => Err(field.error(format!("is no field here: must be one of {}", known.join(", ")))),
        }
    }

    /// The value at the cursor as a list of `least` to `most` entries. Returns one cursor per entry.
    pub fn list(&self, least: usize, most: usize) -> Result<Vec<Self>, InputError> {
        let Value::Array(all) = self.value else { return Err(self.error("must be a list")) };
        if !(least..=most).contains(&all.len()) {
            let (path, bound) = (format!("{}.len", self.path()), format!("must be in {least}..={most}"));
            return Err(InputError::new(path, all.len(), bound));
        }
        let entry = |(index, value)| Self { path: format!("{}[{index}]", self.path), value };
        Ok(all.iter().enumerate().map(entry).collect())
    }

    /// The value at the cursor as a number in `low..=high`.
    pub fn number(&self, low: f64, high: f64) -> Result<f64, InputError> {
        let number = self.value.as_f64().filter(|value| (low..=high).contains(value));
        number.ok_or_else(|| self.error(format!("must be a number in {low}..={high}")))
    }

    /// The value at the cursor as a whole number in `low..=high`.
    pub fn whole(&self, low: i64, high: i64) -> Result<i64, InputError> {
        // JSON does not distinguish 3 from 3.0.
        let whole = |value: f64| (value.fract() == 0.0 && value.abs() < 9e15).then_some(value as i64);
        let number = self.value.as_i64().or_else(|| self.value.as_f64().and_then(whole));
        let number = number.filter(|value| (low..=high).contains(value));
        number.ok_or_else(|| self.error(format!("must be a whole number in {low}..={high}")))
    }

    /// The value at the cursor as `N` numbers in `low..=high`.
    pub fn numbers<const N: usize>(&self, low: f64, high: f64) -> Result<[f64; N], InputError> {
        let refused = || self.error(format!("must be a list of {N} numbers"));
        let list = self.list(N, N).map_err(|_| refused())?;
        let numbers = list.iter().map(|entry| entry.number(low, high)).collect::<Result<Vec<_>, _>>()?;
        numbers.try_into().map_err(|_| refused())
    }

    /// The value at the cursor as a string of 1 to 1024 bytes.
    pub fn text(&self) -> Result<&'a str, InputError> {
        match self.value {
            Value::String(text) if (1..=1024).contains(&text.len()) => Ok(text),
            _ => Err(self.error("must be a string of 1 to 1024 bytes")),
        }
    }

    /// The value at the cursor as a boolean.
    pub fn flag(&self) -> Result<bool, InputError> {
        self.value.as_bool().ok_or_else(|| self.error("must be true or false"))
    }

    /// Finds the string at the cursor in `names`, and returns the value that belongs to it.
    pub fn one_of<T: Copy, const N: usize>(&self, names: [(&str, T); N]) -> Result<T, InputError> {
        let found = names.iter().find(|(name, _)| self.value.as_str() == Some(name));
        let bound = || format!("must be one of {}", names.map(|(name, _)| format!("{name:?}")).join(", "));
        found.map(|(_, value)| *value).ok_or_else(|| self.error(bound()))
    }
}

/// The fields of an object, and the object's path.
#[derive(Debug)]
pub(super) struct Fields<'a> {
    path: String,
    fields: &'a Map<String, Value>,
}

impl<'a> Fields<'a> {
    /// Cursor at a field; `None` if the field is missing.
    pub fn get(&self, name: &str) -> Option<At<'a>> {
        Some(At { path: self.path_of(name), value: self.fields.get(name)? })
    }

    /// Cursor at a required field. `what` describes the field in the error.
    pub fn need(&self, name: &str, what: &str) -> Result<At<'a>, InputError> {
        self.get(name).ok_or_else(|| self.missing(name, what))
    }

    /// The error for a missing field. `what` describes the field.
    pub fn missing(&self, name: &str, what: &str) -> InputError {
        InputError::new(self.path_of(name), "missing", format!("must be given: {what}"))
    }

    fn path_of(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    /// The field's value as a number in `low..=high`; `otherwise` if the field is missing.
    pub fn number(&self, name: &str, low: f64, high: f64, otherwise: f64) -> Result<f64, InputError> {
        Ok(self.maybe(name, |at| at.number(low, high))?.unwrap_or(otherwise))
    }

    /// The value that belongs to the field's string in `names`; `otherwise` if the field is missing.
    pub fn one_of<T: Copy, const N: usize>(
        &self,
        name: &str,
        names: [(&str, T); N],
        otherwise: T,
    ) -> Result<T, InputError> {
        Ok(self.maybe(name, |at| at.one_of(names))?.unwrap_or(otherwise))
    }

    /// Calls `read` with a cursor at a field, and returns the result; `None` if the field is missing.
    pub fn maybe<T>(
        &self,
        name: &str,
        read: impl FnOnce(At<'a>) -> Result<T, InputError>,
    ) -> Result<Option<T>, InputError> {
        self.get(name).map(read).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_have_paths() {
        let json = Json::parse(r#"{"a": [{"b": 1.5}, {"b": "x", "c": 2}], "d": [1, 2]}"#).expect("JSON");
        let fields = json.at().fields(&["a", "d"]).expect("known");
        let list = fields.need("a", "a list").expect("there").list(1, 2).expect("two");
        let b = list[0].fields(&["b"]).expect("known").need("b", "a number").expect("there");
        assert_eq!((b.number(0.0, 2.0), b.path.as_str()), (Ok(1.5), "a[0].b"));
        let refused = |error: InputError| (error.path, error.value);
        let of = |path: &str, value: &str| (path.to_owned(), value.to_owned());
        assert_eq!(refused(b.whole(0, 2).expect_err("no whole number")), of("a[0].b", "1.5"));
        assert_eq!(refused(list[1].fields(&["b"]).expect_err("unknown")), of("a[1].c", "2"));
        assert_eq!(refused(fields.need("e", "a thing").expect_err("missing")), of("e", "missing"));
        let d = fields.need("d", "numbers").expect("there");
        assert_eq!(refused(d.numbers::<3>(0.0, 9.0).expect_err("two")), of("d", "[1,2]"));
        assert_eq!(refused(d.numbers::<2>(0.0, 1.0).expect_err("2")), of("d[1]", "2"));
        assert_eq!(refused(d.list(3, 9).expect_err("two")), of("d.len", "2"));
        assert_eq!(refused(json.at().error("wrong")).0, "scene");
    }

    #[test]
    fn text_that_is_no_tree_is_refused() {
        let refused = |text: &str| Json::parse(text).expect_err(text).path;
        assert_eq!(refused(""), "scene");
        assert_eq!(refused(r#"{"a": 1} 2"#), "scene");
        assert_eq!(refused(r#"{"a": {"b": 1, "b": 2}}"#), "a.b");
        assert_eq!(refused(r#"{"a": [1, 1e999]}"#), "a[1]");
        // A text with very deeply nested lists is refused.
        assert!(Json::parse(&format!("{}{}", "[".repeat(9999), "]".repeat(9999))).is_err());
    }
}
