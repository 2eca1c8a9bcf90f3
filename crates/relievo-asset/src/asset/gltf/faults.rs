//! Errors for documents that gltf-json refuses. Each has the path, the value there, and what glTF allows in its place.

use std::fmt::Debug;

use gltf_json::validation::Error as Fault;
use gltf_json::{accessor, animation, buffer, camera, material, mesh, texture};
use serde_json::Value;

use crate::InputError;
use crate::error::json::{message, refused_value, shown};

/// Major version of glTF that is supported; any minor version is accepted.
const MAJOR: &str = "2";

/// Refuses documents that are not glTF, and glTF versions other than 2.
pub fn check_version(document: &Value) -> Result<(), InputError> {
    let version = || document.pointer("/asset/version");
    for (path, value) in [("glTF", Some(document)), ("asset", document.get("asset"))] {
        if !value.is_some_and(Value::is_object) {
            let bound = "must be an object: glTF 2.0 begins with {\"asset\": {\"version\": \"2.0\"}";
            return Err(InputError::new(path, value.map_or("missing".to_owned(), shown), bound));
        }
    }
    for (path, value) in
        [("asset.version", version()), ("asset.minVersion", document.pointer("/asset/minVersion"))]
    {
        let major = value.and_then(Value::as_str).map(|text| text.split('.').next());
        if (value.is_some() || path == "asset.version") && major != Some(Some(MAJOR)) {
            let bound = "must be \"2.0\", the version of glTF that is read: convert the file to it";
            return Err(InputError::new(path, value.map_or("missing".to_owned(), shown), bound));
        }
    }
    Ok(())
}

/// Converts JSON to a `T`. The text is that of a [`Value`], which `document` gives again to quote a value in an error.
///
/// `parse` reads text, so that the reader of `Root` is the one that gltf-json was compiled with.
pub fn read<T>(
    text: &str,
    parse: impl FnOnce(&[u8]) -> serde_json::Result<T>,
    document: impl FnOnce() -> Value,
) -> Result<T, InputError> {
    parse(text.as_bytes()).map_err(|error| of_type(&document(), &error))
}

/// Error for a value of the wrong type, or with a missing field. The text that was read is `document` on one line, without spaces.
fn of_type(document: &Value, error: &serde_json::Error) -> InputError {
    let message = message(error);
    // Only the column of this error counts the byte that comes next.
    let is_in_front = message == "trailing characters";
    let stop = Stop { column: error.column() - usize::from(is_in_front), is_in_front };
    let Some((path, value)) = stop.find(document, String::new(), &mut 0) else {
        return InputError::new("", "unreadable", message);
    };
    if let Some((field, _)) = message.strip_prefix("missing field `").and_then(|rest| rest.split_once('`')) {
        let path = if path.is_empty() { field.to_owned() } else { format!("{path}.{field}") };
        return InputError::new(path, "missing", "must be given");
    }
    let bound = match message.as_str() {
        "trailing characters" => "must not be there: the list has enough elements without it",
        "number out of range" => "must be finite as a float of 32 bits",
        _ => {
            let refused = refused_value(&path, value, error);
            return refused.unwrap_or_else(|| InputError::new(path, shown(value), message));
        }
    };
    InputError::new(path, shown(value), bound)
}

/// Where serde_json stopped.
struct Stop {
    /// Number of bytes that it had read.
    column: usize,
    /// Whether it stopped in front of an element that a list should not have. Otherwise it has read a whole value, or nothing of a
    /// list or object, or its first byte.
    is_in_front: bool,
}

impl Stop {
    /// Looks for the value in `value`, which begins after `at` bytes. Moves `at` to its end.
    fn find<'a>(&self, value: &'a Value, path: String, at: &mut usize) -> Option<(String, &'a Value)> {
        let begin = *at;
        let is_scalar = !value.is_array() && !value.is_object();
        if begin == self.column && (self.is_in_front || !is_scalar) {
            return Some((path, value));
        }
        // An element has `[` or `,` before it, and a member its name and `:` too.
        let within = match value {
            Value::Array(elements) => elements.iter().enumerate().find_map(|(index, element)| {
                *at += 1;
                self.find(element, format!("{path}[{index}]"), at)
            }),
            Value::Object(members) => members.iter().find_map(|(name, member)| {
                *at += 1 + Value::from(name.as_str()).to_string().len() + 1;
                let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                self.find(member, path, at)
            }),
            scalar => {
                *at += scalar.to_string().len();
                None
            }
        };
        if within.is_some() {
            return within;
        }
        if !is_scalar {
            *at = (*at + 1).max(begin + 2);
        }
        let is_read = *at == self.column || !is_scalar && begin + 1 == self.column;
        (is_read && !self.is_in_front).then_some((path, value))
    }
}

/// Error for an invalid value of the right type.
pub fn of_value(document: &Value, path: &str, fault: Fault) -> InputError {
    let steps = steps(path);
    let field = steps.iter().rev().find(|step| step.parse::<usize>().is_err()).copied().unwrap_or_default();
    let bound = match (fault, steps.as_slice()) {
        (Fault::IndexOutOfBounds, _) => out_of_list(document, &steps, field),
        (Fault::Missing, _) => "must be given".to_owned(),
        (Fault::Oversize, _) => "must fit the machine's memory".to_owned(),
        (_, [of_mesh @ .., "attributes", _]) => return of_attribute(document, of_mesh, path),
        _ => known(&steps, field),
    };
    let absent = if fault == Fault::Missing { "missing" } else { "invalid" };
    let value = value_at(document, &steps).map_or(absent.to_owned(), shown);
    InputError::new(path, value, bound)
}

/// Splits a path of gltf-json into fields and indices.
fn steps(path: &str) -> Vec<&str> {
    let steps = path.split(['.', '[']).map(|step| step.trim_matches([']', '"']));
    steps.filter(|step| !step.is_empty()).collect()
}

fn value_at<'a>(document: &'a Value, steps: &[&str]) -> Option<&'a Value> {
    steps.iter().try_fold(document, |value, step| match value {
        Value::Array(list) => list.get(step.parse::<usize>().ok()?),
        value => value.get(step),
    })
}

/// Text for an index beyond the end of its list; it names the list and its length.
fn out_of_list(document: &Value, steps: &[&str], field: &str) -> String {
    let is_attribute = steps.iter().rev().nth(1) == Some(&"attributes");
    let list = match field {
        _ if is_attribute => "accessors",
        "indices" | "input" | "inverseBindMatrices" | "output" => "accessors",
        "POSITION" | "NORMAL" | "TANGENT" => "accessors",
        "children" | "joints" | "node" | "nodes" | "skeleton" => "nodes",
        "buffer" => "buffers",
        "bufferView" => "bufferViews",
        "camera" => "cameras",
        "index" => "textures",
        "material" => "materials",
        "mesh" => "meshes",
        "scene" => "scenes",
        "skin" => "skins",
        "source" => "images",
        _ => return "must lie in the list it points into".to_owned(),
    };
    let count = document.get(list).and_then(Value::as_array).map_or(0, Vec::len);
    format!("must lie in the list {list}, below {count}")
}

/// Error for an attribute whose name glTF does not define. The error has the attribute's name, which gltf-json does not report.
fn of_attribute(document: &Value, of_mesh: &[&str], path: &str) -> InputError {
    let is_known = |name: &str| {
        let set =
            ["TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"].iter().find_map(|set| name.strip_prefix(set));
        ["POSITION", "NORMAL", "TANGENT"].contains(&name) || set.is_some_and(|set| set.parse::<u32>().is_ok())
    };
    let all = value_at(document, of_mesh).and_then(|mesh| mesh.get("attributes")?.as_object());
    let unknown = all.and_then(|all| all.keys().find(|name| !is_known(name)));
    let bound =
        "must be POSITION, NORMAL, TANGENT, TEXCOORD_n, COLOR_n, JOINTS_n or WEIGHTS_n, or begin with _";
    let parent = path.rsplit_once('[').map_or(path, |(parent, _)| parent);
    InputError::new(parent, unknown.map_or("invalid", String::as_str), bound)
}

/// Text that lists the values that glTF allows in a field.
fn known(steps: &[&str], field: &str) -> String {
    let of =
        |values: &dyn Debug| format!("must be one of {}", format!("{values:?}").trim_matches(['[', ']']));
    match (field, steps.first().copied()) {
        ("componentType", _) if steps.contains(&"sparse") => of(&accessor::VALID_INDEX_TYPES),
        ("componentType", _) => of(&accessor::VALID_COMPONENT_TYPES),
        ("type", Some("accessors")) => of(&accessor::VALID_ACCESSOR_TYPES),
        ("type", Some("cameras")) => of(&camera::VALID_CAMERA_TYPES),
        ("interpolation", _) => of(&animation::VALID_INTERPOLATIONS),
        ("path", _) => of(&animation::VALID_PROPERTIES),
        ("alphaMode", _) => of(&material::VALID_ALPHA_MODES),
        ("mode", _) => of(&mesh::VALID_MODES),
        ("magFilter", _) => of(&texture::VALID_MAG_FILTERS),
        ("minFilter", _) => of(&texture::VALID_MIN_FILTERS),
        ("wrapS" | "wrapT", _) => of(&texture::VALID_WRAPPING_MODES),
        ("target", _) => of(&buffer::VALID_TARGETS),
        ("byteStride", _) => format!("must be in {}..={}", buffer::MIN_BYTE_STRIDE, buffer::MAX_BYTE_STRIDE),
        _ => "must be one of the values that glTF allows".to_owned(),
    }
}
