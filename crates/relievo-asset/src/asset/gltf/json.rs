//! Parses a document's JSON, and rewrites constructs that glTF permits but gltf-json rejects.

use serde_json::{Number, Value};

use crate::InputError;
use crate::error::json::{message, place};

/// 2⁵³: up to this number, a double represents every integer exactly.
const MOST_EXACT: f64 = 9_007_199_254_740_992.0;

/// Parses the JSON of a document.
///
/// # Errors
/// [`InputError`] with line and column. For a text that is not a JSON object, the error has the first characters instead.
pub fn parse(json: &[u8]) -> Result<Value, InputError> {
    // glTF lets readers ignore a byte order mark.
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    if json.trim_ascii_start().first() != Some(&b'{') {
        let begin: String = String::from_utf8_lossy(&json[..json.len().min(80)]).chars().take(16).collect();
        let bound = "must be glTF 2.0: JSON, which begins with {, or a GLB, which begins with glTF";
        return Err(InputError::new("JSON", format!("{begin:?}"), bound));
    }
    let mut value: Value = serde_json::from_slice(json).map_err(|error| {
        let bound = format!("must be glTF 2.0, and valid JSON: {}", message(&error));
        InputError::new("JSON", place(&error), bound)
    })?;
    rewrite(&mut value);
    for animation in list(&mut value, "animations") {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            channels.iter_mut().for_each(resolve_pointer);
            channels.retain(has_node);
        }
    }
    for primitive in list(&mut value, "meshes").flat_map(|mesh| list(mesh, "primitives")) {
        if let Some(attributes) = primitive.get_mut("attributes").and_then(Value::as_object_mut) {
            attributes.retain(|name, _| !is_foreign(name));
        }
    }
    // In glTF, a scene may lack its list of nodes; gltf-json requires the list.
    for scene in list(&mut value, "scenes").filter_map(Value::as_object_mut) {
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    Ok(value)
}

/// Iterates over the list `name` of an object; empty if the object has no such list.
fn list<'a>(value: &'a mut Value, name: &str) -> impl Iterator<Item = &'a mut Value> {
    value.get_mut(name).and_then(Value::as_array_mut).into_iter().flatten()
}

/// Removes all `extras`, which may be any value and are not read. Writes integral numbers such as `1.0` as integers.
fn rewrite(value: &mut Value) {
    match value {
        Value::Object(members) => {
            members.remove("extras");
            members.values_mut().for_each(rewrite);
        }
        Value::Array(elements) => elements.iter_mut().for_each(rewrite),
        Value::Number(number) => {
            if let Some(whole) = whole(number) {
                *number = whole;
            }
        }
        _ => {}
    }
}

/// Converts a number that is written with a fraction or an exponent to an integer, if its value is an integer. `None` for
/// `-0.0`, because integers have no negative zero.
fn whole(number: &Number) -> Option<Number> {
    let value = number.as_f64().filter(|_| number.is_f64())?;
    let is_whole =
        value.fract() == 0.0 && value.abs() <= MOST_EXACT && !(value == 0.0 && value.is_sign_negative());
    is_whole.then(|| Number::from(value as i64))
}

/// Whether an attribute belongs to an application (`_NAME`) or to an extension (`EXTENSION:NAME`).
fn is_foreign(attribute: &str) -> bool {
    attribute.starts_with('_') || attribute.contains(':')
}

/// Sets the node and the path of a channel from its `KHR_animation_pointer`, if the pointer names a node (`/nodes/3/rotation`).
fn resolve_pointer(channel: &mut Value) {
    let target = channel.get_mut("target").and_then(Value::as_object_mut);
    let Some(target) = target.filter(|target| !target.contains_key("node")) else { return };
    let pointer = target.get("extensions").and_then(|all| all.pointer("/KHR_animation_pointer/pointer"));
    let parts =
        pointer.and_then(Value::as_str).and_then(|pointer| pointer.strip_prefix("/nodes/")?.split_once('/'));
    let of_node = parts.and_then(|(node, path)| Some((node.parse::<u32>().ok()?, path.to_owned())));
    if let Some((node, path)) =
        of_node.filter(|(_, path)| ["translation", "rotation", "scale", "weights"].contains(&path.as_str()))
    {
        target.insert("node".to_owned(), node.into());
        target.insert("path".to_owned(), path.into());
    }
}

/// Whether a channel has a target node. A channel without a node belongs to an extension. A reader that does not know the
/// extension skips the channel.
fn has_node(channel: &Value) -> bool {
    let target = channel.get("target").and_then(Value::as_object);
    target.is_none_or(|target| target.contains_key("node"))
}
