//! glTF documents made by the tests.

use base64::Engine as _;
use serde_json::{Value, json};

/// A document that grows: JSON beside one buffer.
pub struct Scene {
    pub json: Value,
    pub buffer: Vec<u8>,
}

pub const FLOAT: u32 = 5126;

impl Scene {
    pub fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "nodes": [], "skins": [], "animations": []
        });
        Self { json, buffer: Vec::new() }
    }

    /// Two bones, one below the other, and a skin.
    pub fn of_two_bones() -> Self {
        let mut scene = Self::new();
        scene.push("nodes", json!({"name": "root", "children": [1]}));
        scene.push("nodes", json!({"name": "tip", "translation": [0.0, 1.0, 0.0]}));
        scene.push("skins", json!({"joints": [0, 1]}));
        scene
    }

    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.buffer.len().is_multiple_of(4) {
            self.buffer.push(0xaa);
        }
        let offset = self.buffer.len();
        self.buffer.extend(bytes);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    /// An accessor of floats.
    pub fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let count = values.len() / width;
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": FLOAT, "type": kind, "count": count}),
        )
    }

    /// An accessor of unsigned integers of so many bytes.
    pub fn integers(&mut self, kind: &str, bytes: usize, values: &[u32]) -> usize {
        let width = if kind == "VEC4" { 4 } else { 1 };
        let packed: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()[..bytes].to_vec()).collect();
        let view = self.view(&packed);
        let component = [5121, 5123, 5123, 5125][bytes - 1];
        let count = values.len() / width;
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": component, "type": kind, "count": count}),
        )
    }

    /// An animation of one channel.
    pub fn animate(
        &mut self,
        node: usize,
        path: &str,
        interpolation: &str,
        times: usize,
        values: usize,
    ) -> usize {
        self.push(
            "animations",
            json!({
                "samplers": [{"input": times, "output": values, "interpolation": interpolation}],
                "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
            }),
        )
    }

    /// JSON with its buffer in a `data:` URI.
    pub fn gltf(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json.get("buffers").is_none() {
            let data = base64::engine::general_purpose::STANDARD.encode(&self.buffer);
            let uri = format!("data:application/octet-stream;base64,{data}");
            json["buffers"] = json!([{"byteLength": self.buffer.len(), "uri": uri}]);
        }
        serde_json::to_vec(&json).expect("JSON")
    }

    /// Header, JSON and buffer in one.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.buffer.len()}]);
        let mut text = serde_json::to_vec(&json).expect("JSON");
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = self.buffer.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        bytes.extend((28 + text.len() + binary.len()).to_le_bytes().iter().take(4));
        for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &binary)] {
            bytes.extend((chunk.len() as u32).to_le_bytes());
            bytes.extend(kind);
            bytes.extend(chunk);
        }
        bytes
    }
}
