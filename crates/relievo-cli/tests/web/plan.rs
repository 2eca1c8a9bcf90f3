//! The list of pipelines that the page must create, from the files and the manifest that `relievo shaders`
//! writes.

use serde_json::{Value, json};

use crate::harness::relievo;

/// Values of the override constants that are not `bool`: those that the library sets.
const VALUES: &[(&str, &str, &[f64])] = &[
    ("animation/budget", "STAGE", &[0.0, 1.0, 2.0, 3.0, 4.0]),
    ("animation/compact", "STAGE", &[0.0, 1.0, 2.0]),
    ("animation/gate", "MODE", &[0.0, 1.0, 2.0, 3.0, 4.0]),
    ("lod/budget", "STAGE", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]),
    ("lod/list", "STAGE", &[0.0, 1.0]),
    ("render/scene_mesh", "relievo_FADE", &[0.0, 1.0, 2.0, 3.0, 4.0]),
    ("render/scene_relief", "relievo_FADE", &[0.0, 1.0, 2.0, 3.0, 4.0]),
    ("render/scene_relief", "relievo_METHOD", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
    ("render/scene_relief", "relievo_SHADOW", &[0.0, 1.0, 2.0]),
    ("render/scene_terrain", "relievo_FADE", &[0.0, 1.0, 2.0, 3.0, 4.0]),
    ("surface/relief", "METHOD", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
    ("surface/shade", "METHOD", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
    ("terrain/despike", "FEATURES", &[0.0, 1.0]),
    ("terrain/height", "DISTRIBUTION", &[0.0, 1.0, 2.0]),
    ("terrain/height", "FEATURES", &[0.0, 1.0, 2.0]),
    ("terrain/node", "STAGE", &[0.0, 1.0]),
    ("terrain/noise", "GENERATOR", &[0.0, 1.0, 2.0]),
    ("terrain/smooth", "DISTRIBUTION", &[0.0, 1.0, 2.0]),
    ("terrain/smooth", "FEATURES", &[0.0, 1.0, 2.0]),
    ("terrain/smooth", "STAGE", &[0.0, 1.0]),
    ("terrain/wrap", "DISTRIBUTION", &[0.0, 1.0, 2.0]),
    ("terrain/wrap", "FEATURES", &[0.0, 1.0, 2.0]),
];

/// The contents of the folder that `relievo shaders` wrote.
pub struct Written {
    pub shaders: Vec<Value>,
    /// The name and the source of each shader.
    pub modules: Vec<(String, String)>,
    sources: Vec<String>,
}

impl Written {
    /// Runs the program.
    pub fn now() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let run = relievo(&["shaders", "--out", folder.path().to_str().expect("UTF-8")]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let text = |file: &str| std::fs::read_to_string(folder.path().join(file)).expect("written");
        let manifest: Value = serde_json::from_str(&text("manifest.json")).expect("JSON");
        let list = |name: &str| manifest[name].as_array().expect("a list").clone();
        let source = |entry: &Value| text(entry["file"].as_str().expect("a file"));
        let shaders = list("shaders");
        Self {
            sources: shaders.iter().map(source).collect(),
            modules: list("modules").iter().map(|entry| (name_of(entry), source(entry))).collect(),
            shaders,
        }
    }

    /// A job for every shader.
    pub fn jobs(&self) -> Vec<Value> {
        self.shaders_with_sources().map(|(shader, source)| job_of(shader, source)).collect()
    }

    pub fn shaders_with_sources(&self) -> impl Iterator<Item = (&Value, &str)> {
        self.shaders.iter().zip(self.sources.iter().map(String::as_str))
    }
}

pub fn name_of(entry: &Value) -> String {
    entry["name"].as_str().expect("a name").to_owned()
}

/// The list `field` of a manifest's entry.
fn all<'a>(entry: &'a Value, field: &str) -> &'a [Value] {
    entry[field].as_array().unwrap_or_else(|| panic!("{entry} has no list `{field}`"))
}

/// The job of a shader.
pub fn job_of(shader: &Value, source: &str) -> Value {
    let name = name_of(shader);
    let (entries, sets) = (all(shader, "entry_points"), constants(&name, all(shader, "overrides")));
    let varied: Vec<_> = entries.iter().filter(|entry| is_varied(entry)).cloned().collect();
    let of_set = |(at, constants)| pipelines(&name, if at == 0 { entries } else { &varied }, constants);
    let pipelines: Vec<_> = sets.iter().enumerate().flat_map(of_set).collect();
    json!({ "name": name, "code": source, "groups": groups(all(shader, "bindings")), "pipelines": pipelines })
}

/// The sets of override constants to compile with: all defaults, then each value of each constant with the others at
/// their defaults.
fn constants(shader: &str, overrides: &[Value]) -> Vec<Value> {
    let mut sets = vec![json!({})];
    for constant in overrides {
        let name = name_of(constant);
        let known = VALUES.iter().find(|(of, constant, _)| *of == shader && *constant == name);
        let values = match (constant["type"].as_str(), known) {
            (Some("bool"), None) => &[0.0, 1.0][..],
            (Some(_), Some((.., values))) => values,
            other => panic!("{shader}: which values does the library give `{name}`? {other:?}"),
        };
        let default = constant["default"].as_f64().expect("a number");
        sets.extend(values.iter().filter(|value| **value != default).map(|value| json!({ &name: value })));
    }
    sets
}

/// Whether an entry is compiled with every value of every constant; the others are compiled with the defaults only. The varied entries
/// reach every function that reads a constant, see `every_function_that_reads_a_constant_is_compiled_with_its_values`.
pub fn is_varied(entry: &Value) -> bool {
    let name = name_of(entry);
    let name = name.trim_start_matches("relievo_");
    let starts = ["color", "transparent", "depth_deep"];
    entry["stage"] != "fragment" || name == "velocity" || starts.iter().any(|start| name.starts_with(start))
}

/// A compute pipeline, or for each fragment entry a render pipeline with its vertex entry.
fn pipelines(shader: &str, entries: &[Value], constants: &Value) -> Vec<Value> {
    let of_stage = |stage: &str| entries.iter().filter(|entry| entry["stage"] == stage).collect::<Vec<_>>();
    let label = |entry: &Value| format!("{shader} {} {constants}", name_of(entry));
    let mut all: Vec<_> = (of_stage("compute").into_iter())
        .map(|entry| json!({ "label": label(entry), "constants": constants, "compute": entry["name"] }))
        .collect();
    let vertices = of_stage("vertex");
    all.extend(of_stage("fragment").into_iter().map(|fragment| {
        let vertex = match &vertices[..] {
            [vertex] => vertex,
            several => {
                let name = vertex_of(&name_of(fragment));
                several.iter().find(|vertex| name_of(vertex) == name).expect("the vertex entry of a kind")
            }
        };
        let render = json!({
            "targets": targets(&name_of(fragment)),
            "vertex": vertex["name"],
            "fragment": fragment["name"],
            "topology": "triangle-list",
            "buffers": buffers(vertex),
        });
        json!({ "label": label(fragment), "constants": constants, "render": render })
    }));
    all
}

/// The vertex entry of a kind that the renderer combines with a fragment entry.
fn vertex_of(fragment: &str) -> String {
    let (prefix, entry) = match fragment.strip_prefix("relievo_") {
        Some(entry) => ("relievo_", entry),
        None => ("", fragment),
    };
    let vertex = match entry {
        "depth" => "vertex_depth",
        _ if entry.starts_with("velocity") => "vertex_moving",
        _ => "vertex",
    };
    format!("{prefix}{vertex}")
}

/// The colours of a fragment entry, by its name.
fn targets(entry: &str) -> Value {
    let target = |format: &str| json!({ "format": format });
    let entry = entry.trim_start_matches("relievo_");
    match entry.split('_').next() {
        Some("depth") => json!([{ "format": "rgba8unorm-srgb", "writeMask": 0 }]),
        Some("surface") => json!(["rgba16float", "rgba8unorm", "rg16uint"].map(target)),
        Some("velocity") => json!([target("rg16float")]),
        Some("measure") => json!(["rgba32float", "rg32uint"].map(target)),
        _ => json!([target("rgba8unorm-srgb")]),
    }
}

/// One vertex buffer that holds all inputs, if there are any.
fn buffers(vertex: &Value) -> Value {
    let mut offset = 0;
    let attributes: Vec<_> = (all(vertex, "inputs").iter())
        .map(|input| {
            let (format, bytes) = match input["type"].as_str() {
                Some("u32") => ("uint32", 4),
                Some("vec2<f32>") => ("float32x2", 8),
                Some("vec3<f32>") => ("float32x3", 12),
                Some("vec4<f32>") => ("float32x4", 16),
                other => panic!("teach the test the vertex format of {other:?}"),
            };
            let attribute =
                json!({ "shaderLocation": input["location"], "offset": offset, "format": format });
            offset += bytes;
            attribute
        })
        .collect();
    if attributes.is_empty() {
        json!([])
    } else {
        json!([{ "arrayStride": offset, "attributes": attributes }])
    }
}

/// The entries of each bind group, from the manifest.
fn groups(bindings: &[Value]) -> Vec<Vec<Value>> {
    let group = |binding: &Value| binding["group"].as_u64().expect("a number") as usize;
    let mut groups = vec![Vec::new(); bindings.iter().map(|binding| group(binding) + 1).max().unwrap_or(0)];
    for binding in bindings {
        groups[group(binding)].push(layout_entry(binding));
    }
    groups
}

fn layout_entry(binding: &Value) -> Value {
    let visibility: u32 = (all(binding, "stages").iter())
        .map(|stage| match stage.as_str() {
            Some("vertex") => 1,
            Some("fragment") => 2,
            Some("compute") => 4,
            other => panic!("no stage of WebGPU: {other:?}"),
        })
        .sum();
    let mut entry = json!({ "binding": binding["binding"], "visibility": visibility });
    let (key, layout) = match binding["kind"].as_str() {
        Some("uniform") => ("buffer", json!({ "type": "uniform" })),
        Some("storage-read") => ("buffer", json!({ "type": "read-only-storage" })),
        Some("storage-read-write") => ("buffer", json!({ "type": "storage" })),
        Some("texture") => ("texture", json!({ "sampleType": "float" })),
        Some("texture-array") => ("texture", json!({ "sampleType": "float", "viewDimension": "2d-array" })),
        Some("loaded-texture") => ("texture", json!({ "sampleType": "unfilterable-float" })),
        Some("depth-texture") => ("texture", json!({ "sampleType": "depth" })),
        Some("comparison-sampler") => ("sampler", json!({ "type": "comparison" })),
        Some("sampler") => ("sampler", json!({ "type": "filtering" })),
        other => panic!("teach the test the binding {other:?}"),
    };
    entry[key] = layout;
    entry
}
