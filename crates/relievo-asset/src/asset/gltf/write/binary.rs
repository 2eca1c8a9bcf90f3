//! The binary buffer of a document, with its views and accessors.

use serde_json::{Value, json};

/// Component types of accessors, with the numbers that glTF defines.
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// Appends a value to a list of the document. Returns its index.
pub(super) fn push(list: &mut Vec<Value>, value: Value) -> usize {
    list.push(value);
    list.len() - 1
}

/// The bytes of the buffer, with the views and accessors that describe them.
#[derive(Default)]
pub(super) struct Binary {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Binary {
    /// Appends bytes as a new buffer view, aligned to four bytes. Returns the view's index.
    pub fn view(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        push(&mut self.views, json!({ "buffer": 0, "byteOffset": start, "byteLength": length }))
    }

    fn accessor(
        &mut self,
        bytes: impl IntoIterator<Item = u8>,
        kind: &str,
        component: u32,
        count: usize,
    ) -> usize {
        let view = self.view(bytes);
        let accessor =
            json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
        push(&mut self.accessors, accessor)
    }

    /// Appends vectors of floats. Returns the index of their accessor. `has_bounds` also writes the smallest and largest
    /// components, which glTF requires for positions and times.
    pub fn floats<const N: usize>(&mut self, vectors: &[[f32; N]], has_bounds: bool) -> usize {
        let bytes = vectors.as_flattened().iter().flat_map(|number| number.to_le_bytes());
        let kind = match N {
            1 => "SCALAR",
            2 => "VEC2",
            3 => "VEC3",
            4 => "VEC4",
            _ => "MAT4",
        };
        let index = self.accessor(bytes, kind, FLOAT, vectors.len());
        if has_bounds {
            let of = |start: f32, choose: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N).map(|axis| vectors.iter().map(|vector| vector[axis]).fold(start, choose)).collect()
            };
            self.accessors[index]["min"] = json!(of(f32::INFINITY, f32::min));
            self.accessors[index]["max"] = json!(of(f32::NEG_INFINITY, f32::max));
        }
        index
    }

    /// Appends vertex indices of triangles. Returns the index of their accessor.
    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes = indices.iter().flat_map(|index| index.to_le_bytes());
        self.accessor(bytes, "SCALAR", UNSIGNED_INT, indices.len())
    }

    /// Appends one vector of four joint indices per vertex. Returns the index of their accessor.
    pub fn joints(&mut self, joints: &[[u16; 4]]) -> usize {
        let bytes = joints.as_flattened().iter().flat_map(|joint| joint.to_le_bytes());
        self.accessor(bytes, "VEC4", UNSIGNED_SHORT, joints.len())
    }
}
