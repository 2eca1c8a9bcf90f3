//! Decompresses buffer views that meshoptimizer compressed (`EXT_meshopt_compression` and `KHR_meshopt_compression`), with the
//! crate meshopt-pure.

use meshoptimizer::{
    Error, decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat,
    decode_index_buffer, decode_index_sequence, decode_vertex_buffer,
};
use serde::Deserialize;

use super::budget::BYTES_AN_ELEMENT;
use super::document::Document;
use crate::InputError;

/// Compression of one buffer view: the location of its compressed bytes, and the format of the decompressed data.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Meshopt {
    /// Name of the extension that the view uses.
    #[serde(skip)]
    extension: &'static str,
    buffer: u32,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    /// Bytes per decompressed element.
    byte_stride: usize,
    /// Number of decompressed elements.
    count: usize,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Meshopt {
    /// Returns the same compression with the extension's name set.
    pub fn named(self, extension: &'static str) -> Self {
        Self { extension, ..self }
    }

    /// Decompresses the buffer view with index `index`.
    ///
    /// # Errors
    /// [`InputError`] for bytes that do not lie in the buffer, for damaged bytes, and for more data than the budget allows.
    pub fn decompressed(&self, document: &Document<'_>, index: usize) -> Result<Vec<u8>, InputError> {
        let path = format!("bufferViews[{index}].extensions.{}", self.extension);
        let buffer = gltf_json::Index::new(self.buffer);
        let bytes =
            document.slice(&format!("{path}.byteLength"), buffer, self.byte_offset, self.byte_length)?;
        let size = self.count.saturating_mul(self.byte_stride);
        document.budget.spend(&format!("{path}.count"), size.div_ceil(BYTES_AN_ELEMENT))?;
        self.decode(bytes).map_err(|error| {
            let value = format!("[{} bytes]", bytes.len());
            let bound =
                format!("must decompress to {} elements of {} bytes: {error}", self.count, self.byte_stride);
            InputError::new(path, value, bound)
        })
    }

    fn decode(&self, bytes: &[u8]) -> Result<Vec<u8>, Error> {
        let (count, stride) = (self.count, self.byte_stride);
        let mut data = match self.mode {
            Mode::Attributes => {
                let mut data = vec![0; count * stride];
                decode_vertex_buffer(&mut data, count, stride, bytes, bytes.len())?;
                data
            }
            Mode::Triangles => self.indices(bytes, decode_index_buffer)?,
            Mode::Indices => self.indices(bytes, decode_index_sequence)?,
        };
        match self.filter {
            Filter::None => {}
            Filter::Octahedral => decode_filter_oct(&mut data, count, stride)?,
            Filter::Quaternion => decode_filter_quat(&mut data, count, stride)?,
            Filter::Exponential => decode_filter_exp(&mut data, count, stride)?,
            Filter::Color => decode_filter_color(&mut data, count, stride)?,
        }
        Ok(data)
    }

    /// The bytes of decompressed indices.
    fn indices(&self, bytes: &[u8], decode: DecodeIndices) -> Result<Vec<u8>, Error> {
        if ![2, 4].contains(&self.byte_stride) {
            return Err(Error::InvalidArgument("indices have 2 or 4 bytes"));
        }
        let mut indices = vec![0; self.count];
        decode(&mut indices, self.count, bytes, bytes.len())?;
        // The lower bytes come first, so an index of two bytes is the first half of one of four.
        Ok(indices
            .into_iter()
            .flat_map(|index| index.to_le_bytes().into_iter().take(self.byte_stride))
            .collect())
    }
}

/// Decodes compressed indices: output, number of indices, compressed bytes, number of these bytes.
type DecodeIndices = fn(&mut [u32], usize, &[u8], usize) -> Result<(), Error>;
