//! A parsed and validated document: glTF's JSON, and its buffers.

use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

use base64::Engine as _;
use gltf_json::extensions::texture::TextureTransform;
use gltf_json::mesh::Semantic;
use gltf_json::validation::{Checked, Error as Fault, Validate};
use gltf_json::{Index, Root, buffer};
use serde::Deserialize as _;
use serde_json::Value;

use super::Beside;
use super::budget::Budget;
use super::container::Container;
use crate::InputError;

/// A document whose indices are all in range.
pub struct Document<'a> {
    pub root: Root,
    /// Whether some meshes are compressed with Draco and have no uncompressed form.
    pub is_draco: bool,
    /// For each material, the `KHR_texture_transform` of its normal texture, which gltf-json does not read.
    pub normal_transforms: Vec<Option<TextureTransform>>,
    /// What the document may allocate.
    pub budget: Budget,
    binary: Option<&'a [u8]>,
    beside: Option<Beside<'a>>,
    buffers: Vec<OnceCell<Bytes<'a>>>,
    /// External files, each read once.
    files: RefCell<HashMap<PathBuf, Rc<Vec<u8>>>>,
}

/// The bytes of a buffer: part of the document, or read from elsewhere.
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

/// The extensions that a document may require. Only meshes are left out of a document with Draco compression.
const READ: [&str; 3] = [DRACO, "KHR_mesh_quantization", "KHR_texture_transform"];

const DRACO: &str = "KHR_draco_mesh_compression";

/// Extensions that a document may also require if materials and images are not read: other image formats.
const OF_IMAGES: [&str; 4] =
    ["EXT_texture_avif", "EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds"];

/// The prefix of those for other materials.
const OF_MATERIALS: &str = "KHR_materials_";

impl<'a> Document<'a> {
    /// Parses and validates a document. `is_bare` means that materials and images are not needed.
    pub fn new(bytes: &'a [u8], beside: Option<Beside<'a>>, is_bare: bool) -> Result<Self, InputError> {
        let Container { json, binary } = Container::new(bytes)?;
        let mut value: Value = serde_json::from_slice(json).map_err(|error| {
            let place = format!("line {} column {}", error.line(), error.column());
            InputError::new("JSON", place, format!("must be glTF 2.0, as GLB or JSON ({error})"))
        })?;
        check_required(&value, is_bare)?;
        let is_draco = required_names(&value).any(|name| name == DRACO);
        leave_out_channels_without_node(&mut value);
        leave_out_own_attributes(&mut value);
        add_nodes_of_scenes(&mut value);
        let normal_transforms = normal_transforms(&value)?;
        let root: Root = serde_path_to_error::deserialize(value).map_err(|error| {
            let path = error.path().to_string();
            let field = if path == "." { "glTF".to_owned() } else { path };
            InputError::new(field, "unreadable", error.inner().to_string())
        })?;
        positions_exist(&root)?;
        validate(&root)?;
        let buffers = root.buffers.iter().map(|_| OnceCell::new()).collect();
        let budget = Budget::default();
        budget.add_bytes(bytes.len());
        Ok(Self {
            root,
            is_draco,
            normal_transforms,
            budget,
            binary,
            beside,
            buffers,
            files: RefCell::default(),
        })
    }

    /// The bytes of a buffer view, and its stride.
    pub fn view(&self, index: Index<buffer::View>) -> Result<(&[u8], Option<usize>), InputError> {
        let path = format!("bufferViews[{}]", index.value());
        let view = self.root.buffer_views.get(index.value());
        let view = view.ok_or_else(|| InputError::new(&path, index.value(), "must exist"))?;
        let bytes = self.buffer(view.buffer)?;
        let offset = view.byte_offset.map_or(0, |offset| offset.0);
        let range = usize::try_from(offset).ok().zip(usize::try_from(view.byte_length.0).ok());
        let slice = range.and_then(|(offset, length)| bytes.get(offset..)?.get(..length));
        let slice = slice.ok_or_else(|| {
            let value = format!("{} at {offset}", view.byte_length.0);
            let bound =
                format!("must lie in buffers[{}], which has {} bytes", view.buffer.value(), bytes.len());
            InputError::new(format!("{path}.byteLength"), value, bound)
        })?;
        Ok((slice, view.byte_stride.map(|stride| stride.0)))
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
        // The binary chunk of a GLB may have padding.
        Ok(&cell.get_or_init(|| bytes).get()[..length as usize])
    }

    /// The bytes of a `data:` URI, or of a file in the document's folder or below it.
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
        let relative = Path::new(&*name);
        let is_plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        // Refuses a scheme or a drive letter, and paths that lead out of the document's folder.
        if name.contains(':') || !relative.components().all(is_plain) {
            return Err(refused(
                "must be a data: URI or a file in the document's folder or below".to_owned(),
            ));
        }
        let Some(read) = self.beside else {
            return Err(refused("lies in a file, and the document has no folder".to_owned()));
        };
        let name: PathBuf = relative.components().filter(|part| *part != Component::CurDir).collect();
        if let Some(known) = self.files.borrow().get(&name) {
            return Ok(Rc::clone(known));
        }
        let bytes = read(&name).map_err(|error| refused(error.to_string()))?;
        self.budget.add_bytes(bytes.len());
        Ok(Rc::clone(self.files.borrow_mut().entry(name).or_insert_with(|| Rc::new(bytes))))
    }
}

/// Some exporters leave the padding out.
const BASE64: base64::engine::GeneralPurpose = base64::engine::GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    base64::engine::GeneralPurposeConfig::new()
        .with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent),
);

/// Refuses a required extension that would change the result and that is not read.
fn check_required(value: &Value, is_bare: bool) -> Result<(), InputError> {
    let is_read = |name: &str| {
        READ.contains(&name) || is_bare && (OF_IMAGES.contains(&name) || name.starts_with(OF_MATERIALS))
    };
    match required_names(value).enumerate().find(|(_, name)| !is_read(name)) {
        None => Ok(()),
        Some((at, name)) => {
            let bound = format!("is not read: must be one of {}", READ.join(", "));
            Err(InputError::new(format!("extensionsRequired[{at}]"), name, bound))
        }
    }
}

fn required_names(value: &Value) -> impl Iterator<Item = &str> {
    let required = value.pointer("/extensionsRequired").and_then(Value::as_array);
    required.into_iter().flatten().filter_map(Value::as_str)
}

/// For each material, the `KHR_texture_transform` of its normal texture.
fn normal_transforms(value: &Value) -> Result<Vec<Option<TextureTransform>>, InputError> {
    let materials = value.get("materials").and_then(Value::as_array);
    let transform = |(at, material): (usize, &Value)| {
        let Some(given) = material.pointer("/normalTexture/extensions/KHR_texture_transform") else {
            return Ok(None);
        };
        TextureTransform::deserialize(given).map(Some).map_err(|error| {
            let path = format!("materials[{at}].normalTexture.extensions.KHR_texture_transform");
            InputError::new(path, "unreadable", error.to_string())
        })
    };
    materials.into_iter().flatten().enumerate().map(transform).collect()
}

/// Removes application-specific attributes, which glTF permits and gltf-json rejects.
fn leave_out_own_attributes(value: &mut Value) {
    let meshes = value.get_mut("meshes").and_then(Value::as_array_mut).into_iter().flatten();
    let primitives = meshes.filter_map(|mesh| mesh.get_mut("primitives")?.as_array_mut()).flatten();
    for attributes in primitives.filter_map(|primitive| primitive.get_mut("attributes")?.as_object_mut()) {
        attributes.retain(|name, _| !name.starts_with('_'));
    }
}

/// Adds an empty list of nodes to scenes without one, which glTF permits and gltf-json rejects.
fn add_nodes_of_scenes(value: &mut Value) {
    let scenes = value.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten();
    for scene in scenes.filter_map(Value::as_object_mut) {
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
}

/// Removes animation channels without a target node. glTF lets extensions animate other things than nodes, and
/// readers that do not know them skip such channels.
fn leave_out_channels_without_node(value: &mut Value) {
    let animations = value.get_mut("animations").and_then(Value::as_array_mut);
    for animation in animations.into_iter().flatten() {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            let has_node = |channel: &Value| {
                channel
                    .get("target")
                    .and_then(Value::as_object)
                    .is_none_or(|target| target.contains_key("node"))
            };
            channels.retain(has_node);
        }
    }
}

/// Checks that primitives have positions: gltf-json's validation assumes it, and panics otherwise.
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

/// Reports the first error that gltf-json finds. Two kinds are not errors here: accessors without a buffer
/// view, which glTF defines as zeros, and extensions, which are checked before.
fn validate(root: &Root) -> Result<(), InputError> {
    let mut first = None;
    root.validate(root, gltf_json::Path::new, &mut |path, fault| {
        if fault == Fault::Unsupported || first.is_some() {
            return;
        }
        let path = path().to_string();
        if fault != Fault::Missing || !(path.starts_with("accessors[") && path.ends_with("].bufferView")) {
            first = Some((path, fault));
        }
    });
    let Some((path, fault)) = first else { return Ok(()) };
    let (value, bound) = match fault {
        Fault::IndexOutOfBounds => ("an index", "must lie in the list it points into"),
        Fault::Missing => ("missing", "must be given"),
        Fault::Oversize => ("too large", "must fit the machine's memory"),
        Fault::Invalid | Fault::Unsupported => ("invalid", "must be one of the values that glTF allows"),
    };
    Err(InputError::new(path, value, bound))
}
