//! A parsed and validated document: the JSON and the buffers of a glTF file.

use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

use base64::Engine as _;
use gltf_json::mesh::Semantic;
use gltf_json::validation::{Checked, Error as Fault, Validate};
use gltf_json::{Index, Root, buffer};
use serde_json::Value;

use super::Beside;
use super::budget::Budget;
use super::container::Container;
use super::extensions::Extensions;
use super::{faults, json};
use crate::InputError;
use crate::asset::beside::path_below;

/// A glTF document in which all indices are in range.
pub struct Document<'a> {
    pub root: Root,
    /// Data of the extensions that gltf-json does not read.
    pub extensions: Extensions,
    /// Allocation budget of the document.
    pub budget: Budget,
    binary: Option<&'a [u8]>,
    beside: Option<Beside<'a>>,
    buffers: Vec<OnceCell<Bytes<'a>>>,
    /// Decompressed bytes of each compressed buffer view, filled when the view is first read.
    decompressed: Vec<OnceCell<Vec<u8>>>,
    /// Contents of external files, each read once, by path.
    files: RefCell<HashMap<PathBuf, Rc<Vec<u8>>>>,
}

/// Bytes of a buffer: a part of the document, or read from another file.
enum Bytes<'a> {
    Here(&'a [u8]),
    Elsewhere(Rc<Vec<u8>>),
}

impl Bytes<'_> {
    fn get(&self) -> &[u8] {
        match self {
            Self::Here(bytes) => bytes,
            Self::Elsewhere(bytes) => bytes,
        }
    }
}

impl<'a> Document<'a> {
    /// Parses and validates a document. `is_bare` means that materials and images are not needed.
    pub fn new(bytes: &'a [u8], beside: Option<Beside<'a>>, is_bare: bool) -> Result<Self, InputError> {
        let Container { json, binary } = Container::new(bytes)?;
        let value = json::parse(json)?;
        faults::check_version(&value)?;
        let extensions = Extensions::new(&value, is_bare)?;
        // The JSON is parsed again only to quote a value in an error.
        let again = || json::parse(json).unwrap_or_default();
        let root = {
            let text = value.to_string();
            // The tree is much larger than its text.
            drop(value);
            faults::read(&text, Root::from_slice, again)?
        };
        positions_exist(&root)?;
        validate(&root, again)?;
        let buffers = root.buffers.iter().map(|_| OnceCell::new()).collect();
        let decompressed = root.buffer_views.iter().map(|_| OnceCell::new()).collect();
        let budget = if extensions.is_compressed() { Budget::of_compressed() } else { Budget::default() };
        budget.add_bytes(bytes.len());
        Ok(Self {
            root,
            extensions,
            budget,
            binary,
            beside,
            buffers,
            decompressed,
            files: RefCell::default(),
        })
    }

    /// Returns the bytes of a buffer view, decompressed if needed, and the view's stride in bytes, if it has one.
    pub fn view(&self, index: Index<buffer::View>) -> Result<(&[u8], Option<usize>), InputError> {
        let at = index.value();
        let path = format!("bufferViews[{at}]");
        let view = self.root.buffer_views.get(at);
        let view = view.ok_or_else(|| InputError::new(&path, at, "must exist"))?;
        let stride = view.byte_stride.map(|stride| stride.0);
        if let (Some(Some(meshopt)), Some(cell)) =
            (self.extensions.meshopt.get(at), self.decompressed.get(at))
        {
            if let Some(known) = cell.get() {
                return Ok((known, stride));
            }
            let bytes = meshopt.decompressed(self, at)?;
            return Ok((cell.get_or_init(|| bytes), stride));
        }
        let offset = view.byte_offset.map_or(0, |offset| offset.0);
        let bytes = self.slice(&format!("{path}.byteLength"), view.buffer, offset, view.byte_length.0)?;
        Ok((bytes, stride))
    }

    /// Returns a range of a buffer's bytes. `path` names the length in errors.
    pub fn slice(
        &self,
        path: &str,
        buffer: Index<gltf_json::Buffer>,
        offset: u64,
        length: u64,
    ) -> Result<&[u8], InputError> {
        let bytes = self.buffer(buffer)?;
        let range = usize::try_from(offset).ok().zip(usize::try_from(length).ok());
        let slice = range.and_then(|(offset, length)| bytes.get(offset..)?.get(..length));
        slice.ok_or_else(|| {
            let bound = format!("must lie in buffers[{}], which has {} bytes", buffer.value(), bytes.len());
            InputError::new(path, format!("{length} at {offset}"), bound)
        })
    }

    fn buffer(&self, index: Index<gltf_json::Buffer>) -> Result<&[u8], InputError> {
        let at = index.value();
        let path = format!("buffers[{at}]");
        let (Some(cell), Some(buffer)) = (self.buffers.get(at), self.root.buffers.get(at)) else {
            return Err(InputError::new(path, at, "must exist"));
        };
        let length = buffer.byte_length.0;
        if let Some(known) = cell.get() {
            return Ok(&known.get()[..length as usize]);
        }
        let bytes = match &buffer.uri {
            Some(uri) => Bytes::Elsewhere(self.resource(&format!("{path}.uri"), uri)?),
            None => match self.binary.filter(|_| at == 0) {
                Some(binary) => Bytes::Here(binary),
                None => {
                    return Err(InputError::new(
                        format!("{path}.uri"),
                        "missing",
                        "must be given outside GLBs",
                    ));
                }
            },
        };
        let there = bytes.get().len();
        if (there as u64) < length {
            let bound = format!("must be at most {there}, the bytes there are");
            return Err(InputError::new(format!("{path}.byteLength"), length, bound));
        }
        // The binary chunk of a GLB may end with padding, which is cut off.
        Ok(&cell.get_or_init(|| bytes).get()[..length as usize])
    }

    /// Returns the bytes of a `data:` URI, or of a file in the document's folder or below it.
    pub fn resource(&self, path: &str, uri: &str) -> Result<Rc<Vec<u8>>, InputError> {
        let shown: String = uri.chars().take(60).collect();
        let refused = |bound: String| InputError::new(path, &shown, bound);
        if let Some(data) = uri.strip_prefix("data:") {
            let (kind, text) = data.split_once(',').ok_or_else(|| refused("must have a comma".to_owned()))?;
            if !kind.ends_with(";base64") {
                return Err(refused("must be base64".to_owned()));
            }
            let decoded = BASE64.decode(text.trim());
            return decoded.map(Rc::new).map_err(|error| refused(format!("must be base64: {error}")));
        }
        let name = percent_encoding::percent_decode_str(uri).decode_utf8();
        let name = name.map_err(|error| refused(format!("must be UTF-8: {error}")))?;
        let bound = "must be a data: URI or a file in the document's folder or below";
        let name = path_below(&name).ok_or_else(|| refused(bound.to_owned()))?;
        let Some(read) = self.beside else {
            return Err(refused("lies in a file, and the document has no folder".to_owned()));
        };
        if let Some(known) = self.files.borrow().get(&name) {
            return Ok(Rc::clone(known));
        }
        let bytes = read(&name).map_err(|error| refused(error.to_string()))?;
        self.budget.add_bytes(bytes.len());
        Ok(Rc::clone(self.files.borrow_mut().entry(name).or_insert_with(|| Rc::new(bytes))))
    }
}

/// Base64 decoder. Padding is optional, because some exporters omit it.
const BASE64: base64::engine::GeneralPurpose = base64::engine::GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    base64::engine::GeneralPurposeConfig::new()
        .with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent),
);

/// Checks that the accessors of positions exist. Without this check, gltf-json's validation would panic for a missing accessor.
fn positions_exist(root: &Root) -> Result<(), InputError> {
    let meshes = root.meshes.iter().enumerate();
    for (mesh, at, primitive) in
        meshes.flat_map(|(mesh, all)| all.primitives.iter().enumerate().map(move |(at, one)| (mesh, at, one)))
    {
        let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        if let Some(index) = positions.filter(|index| index.value() >= root.accessors.len()) {
            let path = format!("meshes[{mesh}].primitives[{at}].attributes.POSITION");
            let bound = format!("must be below {}, the number of accessors", root.accessors.len());
            return Err(InputError::new(path, index.value(), bound));
        }
    }
    Ok(())
}

/// Path suffixes at which gltf-json reports missing positions or missing bounds of positions.
const OF_POSITIONS: [&str; 3] =
    [".attributes[\"POSITION\"]", ".attributes[\"POSITION\"].min", ".attributes[\"POSITION\"].max"];

/// Returns the first error that gltf-json finds. The import accepts four things that gltf-json refuses: accessors without a
/// buffer view, which glTF defines as zeros; primitives without positions, which are left out; positions without bounds, which
/// are not read; and extensions, which were checked before.
fn validate(root: &Root, document: impl FnOnce() -> Value) -> Result<(), InputError> {
    let mut first = None;
    root.validate(root, gltf_json::Path::new, &mut |path, fault| {
        if fault == Fault::Unsupported || first.is_some() {
            return;
        }
        let path = path().to_string();
        let is_allowed = path.starts_with("accessors[") && path.ends_with("].bufferView")
            || path.starts_with("meshes[") && OF_POSITIONS.iter().any(|end| path.ends_with(end));
        if fault != Fault::Missing || !is_allowed {
            first = Some((path, fault));
        }
    });
    // gltf-json does not validate the targets of channels.
    for (animation, all) in root.animations.iter().enumerate() {
        for (at, channel) in all.channels.iter().enumerate() {
            let path = |field| format!("animations[{animation}].channels[{at}].target.{field}");
            if channel.target.path == Checked::Invalid {
                first.get_or_insert_with(|| (path("path"), Fault::Invalid));
            }
            if channel.target.node.value() >= root.nodes.len() {
                first.get_or_insert_with(|| (path("node"), Fault::IndexOutOfBounds));
            }
        }
    }
    match first {
        Some((path, fault)) => Err(faults::of_value(&document(), &path, fault)),
        None => Ok(()),
    }
}
