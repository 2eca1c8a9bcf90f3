//! Primitives compressed with Draco (`KHR_draco_mesh_compression`), decompressed by the crate draco-core.

use std::collections::HashMap;

use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};
use gltf_json::{Index, buffer};
use serde::Deserialize;

use super::budget::BYTES_AN_ELEMENT;
use super::document::Document;
use super::extensions::DRACO;
use crate::InputError;
use crate::asset::mesh::MAX_VERTICES;

/// Location of a primitive's Draco-compressed bytes, and the attributes that they contain.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Draco {
    buffer_view: u32,
    /// Id of each attribute within the compressed bytes, by the name of the attribute.
    attributes: HashMap<String, u32>,
}

/// A primitive that was decompressed with Draco.
pub struct Decompressed<'a> {
    mesh: Mesh,
    attributes: &'a HashMap<String, u32>,
    /// Path of the Draco extension in the file, for errors.
    path: String,
}

impl Draco {
    /// Decompresses the primitive at `path`.
    ///
    /// # Errors
    /// [`InputError`] for damaged bytes, and for more vertices or triangles than a mesh or the budget permits.
    pub fn decompressed(&self, document: &Document<'_>, path: &str) -> Result<Decompressed<'_>, InputError> {
        let path = format!("{path}.extensions.{DRACO}");
        let (bytes, _) = document.view(Index::<buffer::View>::new(self.buffer_view))?;
        // A triangle counts as three elements, one for each index.
        let elements = document.budget.left();
        let limits = DecodeLimits::default()
            .with_max_points(MAX_VERTICES as u64)
            .with_max_faces(elements / 3)
            .with_max_decoded_bytes(elements.saturating_mul(BYTES_AN_ELEMENT as u64));
        let mut mesh = Mesh::new();
        let read = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh);
        read.map_err(|error| {
            let value = format!("[{} bytes]", bytes.len());
            InputError::new(&path, value, format!("must be a mesh compressed with Draco: {error}"))
        })?;
        let elements = mesh.num_points().saturating_mul(self.attributes.len());
        document.budget.spend(&path, elements.saturating_add(3 * mesh.num_faces()))?;
        Ok(Decompressed { mesh, attributes: &self.attributes, path })
    }
}

impl Decompressed<'_> {
    /// Vertex indices of the triangles, three per triangle.
    pub fn indices(&self) -> Vec<u32> {
        self.mesh.faces().iter().flat_map(|face| face.map(|point| point.0)).collect()
    }

    /// Returns the values of an attribute, in the order of the vertices. `None` if the extension does not list the attribute.
    ///
    /// # Errors
    /// [`InputError`] if the compressed mesh lacks the attribute, or if the attribute has another number of components.
    pub fn attribute(&self, name: &str, components: usize) -> Result<Option<Vec<f32>>, InputError> {
        let Some(number) = self.attributes.get(name) else { return Ok(None) };
        let refused = |value: String, bound: &str| {
            Err(InputError::new(format!("{}.attributes.{name}", self.path), value, bound))
        };
        let Some(attribute) = self.mesh.attribute_by_unique_id(*number) else {
            return refused(number.to_string(), "must be an attribute of the compressed mesh");
        };
        if usize::from(attribute.num_components()) != components {
            let value = format!("{} components", attribute.num_components());
            return refused(value, &format!("must have {components}, as the accessor"));
        }
        Ok(Some(attribute.read_f32s(self.mesh.num_points(), components)))
    }
}
