//! The names of files in a scene file.

use serde_json::{Map, Value};

/// Fields of a scene file that hold names of files, or lists of such names.
const FIELDS: [&str; 8] = ["file", "levels", "relief", "albedo", "normal", "texture", "features", "image"];

/// The prefix of the names of models and images that a program brings along.
pub const BUILT_IN: &str = "builtin:";

/// Calls `visit` with each name of a file in a scene file, and with the field that holds it. Names that begin with [`BUILT_IN`] are
/// visited, too. A zone's texture without a dot in its name is a built-in one, and not visited.
pub fn each_file_name(scene: &mut Value, visit: &mut dyn FnMut(&str, &mut String)) {
    match scene {
        Value::Object(fields) => {
            for (field, value) in fields {
                match value {
                    Value::String(name) if FIELDS.contains(&field.as_str()) => {
                        if field != "texture" || name.contains('.') {
                            visit(field, name);
                        }
                    }
                    Value::Array(names) if FIELDS.contains(&field.as_str()) => {
                        for name in names {
                            if let Value::String(name) = name {
                                visit(field, name);
                            }
                        }
                    }
                    other => each_file_name(other, visit),
                }
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| each_file_name(value, visit)),
        _ => {}
    }
}

/// The objects of a scene file that have a model: meshes, and then characters.
pub fn models_mut(scene: &mut Map<String, Value>) -> impl Iterator<Item = &mut Map<String, Value>> {
    let mut lists = [None, None];
    for (field, value) in scene {
        match field.as_str() {
            "meshes" => lists[0] = value.as_array_mut(),
            "characters" => lists[1] = value.as_array_mut(),
            _ => {}
        }
    }
    lists.into_iter().flatten().flatten().filter_map(Value::as_object_mut)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn names_are_visited_and_changed() {
        let mut scene = json!({
            "terrain": { "config": { "zones": [{ "texture": "grass" }, { "texture": "moss.png" }] }, "features": ["road.json"],
                         "elevation": { "file": "map.png" }, "holes": [{ "image": "hole.png" }] },
            "characters": [{ "file": "builtin:creature", "name": "c" }],
            "meshes": [{ "file": "rock.glb", "levels": ["near.glb", "far.glb"], "material": { "relief": "bricks.png" } }],
        });
        let mut seen = Vec::new();
        each_file_name(&mut scene, &mut |field, name| {
            seen.push(format!("{field} {name}"));
            *name = format!("x/{name}");
        });
        seen.sort();
        let expected = [
            "features road.json",
            "file builtin:creature",
            "file map.png",
            "file rock.glb",
            "image hole.png",
            "levels far.glb",
            "levels near.glb",
            "relief bricks.png",
            "texture moss.png",
        ];
        assert_eq!(seen, expected);
        assert_eq!(scene["meshes"][0]["levels"], json!(["x/near.glb", "x/far.glb"]));
        assert_eq!(scene["terrain"]["config"]["zones"][0]["texture"], "grass");
        let files: Vec<_> = models_mut(scene.as_object_mut().expect("an object"))
            .map(|model| model["file"].clone())
            .collect();
        assert_eq!(files, ["x/rock.glb", "x/builtin:creature"]);
    }
}
