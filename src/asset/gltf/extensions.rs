//! Extensions: which of them a document may have, and the data of those that gltf-json does not read.

use std::collections::HashMap;

use gltf_json::extensions::texture::TextureTransform;
use serde::Deserialize;
use serde_json::Value;

use super::draco::Draco;
use super::faults;
use super::meshopt::Meshopt;
use crate::InputError;

/// The extensions that a document may require. Lights are left out; Blender requires them wherever there are any.
const READ: [&str; 7] = [
    DRACO,
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    WEBP,
    "KHR_lights_punctual",
];

/// The prefix of extensions for materials, which a document may require as well: beside colours and normal maps everything
/// in materials is left out.
const OF_MATERIALS: &str = "KHR_materials_";

/// Draco compression of primitives.
pub const DRACO: &str = "KHR_draco_mesh_compression";

/// Meshoptimizer's compression of buffer views, under both of its names. The first one that a view has counts.
const MESHOPT: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// Many copies of a node's mesh.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Textures with WebP images.
const WEBP: &str = "EXT_texture_webp";

/// Extensions with images of formats that are not read, and what to do about them. A document may require them if materials
/// and images are not read.
const OF_IMAGES: [(&str, &str); 3] = [
    ("KHR_texture_basisu", DECOMPRESS),
    ("EXT_texture_avif", "convert its textures to PNG, as `gltf-transform png IN OUT` does"),
    ("MSFT_texture_dds", "convert its textures to PNG"),
];

/// What to do about KTX2.
pub const DECOMPRESS: &str = "decompress its textures, as `gltf-transform ktxdecompress IN OUT` does";

/// Data of extensions that gltf-json does not read.
pub struct Extensions {
    /// For each material, the `KHR_texture_transform` of its normal texture.
    pub normal_transforms: Vec<Option<TextureTransform>>,
    /// For each buffer view, how it is compressed.
    pub meshopt: Vec<Option<Meshopt>>,
    /// Compressed primitives, by their mesh and their place in it.
    draco: HashMap<(usize, usize), Draco>,
    /// For each texture, the image of `EXT_texture_webp`.
    pub webp: Vec<Option<usize>>,
    /// For each texture, an extension with an image that is not read, and what to do about it.
    pub unread_images: Vec<Option<(&'static str, &'static str)>>,
    /// Nodes with many copies of their mesh.
    instanced: Vec<usize>,
}

impl Extensions {
    /// Reads what a document has. `is_bare` means that materials and images are not needed.
    ///
    /// # Errors
    /// [`InputError`] for extensions that are required and not read.
    pub fn new(document: &Value, is_bare: bool) -> Result<Self, InputError> {
        check_required(document, is_bare)?;
        let mut draco = HashMap::new();
        for (mesh, of_mesh) in list(document, "meshes").enumerate() {
            for (at, primitive) in list(of_mesh, "primitives").enumerate() {
                let path = || format!("meshes[{mesh}].primitives[{at}]");
                if let Some(found) = extension(primitive, DRACO, path)? {
                    draco.insert((mesh, at), found);
                }
            }
        }
        let meshopt = list(document, "bufferViews").enumerate().map(|(at, view)| {
            let mut all = MESHOPT.iter().filter_map(|name| {
                let found: Result<Option<Meshopt>, _> =
                    extension(view, name, || format!("bufferViews[{at}]"));
                found.map(|found| found.map(|found| found.named(name))).transpose()
            });
            all.next().transpose()
        });
        let transforms = list(document, "materials").enumerate().map(|(at, material)| {
            let texture = material.get("normalTexture").unwrap_or(&Value::Null);
            extension(texture, "KHR_texture_transform", || format!("materials[{at}].normalTexture"))
        });
        let webp = list(document, "textures").enumerate().map(|(at, texture)| {
            let found: Option<Webp> = extension(texture, WEBP, || format!("textures[{at}]"))?;
            Ok(found.map(|found| found.source))
        });
        Ok(Self {
            webp: webp.collect::<Result<_, InputError>>()?,
            normal_transforms: transforms.collect::<Result<_, _>>()?,
            meshopt: meshopt.collect::<Result<_, _>>()?,
            draco,
            unread_images: list(document, "textures").map(unread_image).collect(),
            instanced: (list(document, "nodes").enumerate())
                .filter_map(|(at, node)| node.get("extensions")?.get(INSTANCING).map(|_| at))
                .collect(),
        })
    }

    /// Whether meshes are compressed.
    pub fn is_compressed(&self) -> bool {
        !self.draco.is_empty() || self.meshopt.iter().any(Option::is_some)
    }

    /// Refuses a node of which only one of many copies would be read.
    pub fn check_copies(&self, is_read: impl Fn(usize) -> bool) -> Result<(), InputError> {
        match self.instanced.iter().find(|node| is_read(**node)) {
            None => Ok(()),
            Some(node) => {
                let bound = "is not read: write a node for each copy";
                Err(InputError::new(format!("nodes[{node}].extensions.{INSTANCING}"), "given", bound))
            }
        }
    }

    /// How a primitive is compressed, if it is.
    pub fn draco(&self, mesh: usize, primitive: usize) -> Option<&Draco> {
        self.draco.get(&(mesh, primitive))
    }
}

#[derive(Deserialize)]
struct Webp {
    source: usize,
}

/// The elements of a list of an object; none if it has no such list.
fn list<'a>(value: &'a Value, name: &str) -> impl Iterator<Item = &'a Value> {
    value.get(name).and_then(Value::as_array).into_iter().flatten()
}

/// An extension of an object at `path`.
fn extension<'a, T: Deserialize<'a>>(
    object: &'a Value,
    name: &str,
    path: impl Fn() -> String,
) -> Result<Option<T>, InputError> {
    let Some(given) = object.get("extensions").and_then(|all| all.get(name)) else { return Ok(None) };
    serde_path_to_error::deserialize(given).map(Some).map_err(|error| {
        let path = format!("{}.extensions.{name}", path());
        let InputError { path: field, value, bound } = faults::of_type(given, &error);
        let path = if field == "glTF" { path } else { format!("{path}.{field}") };
        InputError { path, value, bound }
    })
}

/// Refuses a required extension that would change the result and that is not read.
fn check_required(document: &Value, is_bare: bool) -> Result<(), InputError> {
    let of_images = |name: &str| OF_IMAGES.iter().find(|(known, _)| *known == name);
    let is_read = |name: &str| {
        READ.contains(&name) || name.starts_with(OF_MATERIALS) || is_bare && of_images(name).is_some()
    };
    let mut names =
        list(document, "extensionsRequired").enumerate().filter_map(|(at, name)| Some((at, name.as_str()?)));
    match names.find(|(_, name)| !is_read(name)) {
        None => Ok(()),
        Some((at, name)) => {
            let remedy = of_images(name).map(|(_, remedy)| format!("; {remedy}"));
            let bound = format!(
                "is not read: must be one of {}, {OF_MATERIALS}*{}",
                READ.join(", "),
                remedy.unwrap_or_default()
            );
            Err(InputError::new(format!("extensionsRequired[{at}]"), name, bound))
        }
    }
}

/// An extension of a texture with an image that is not read.
fn unread_image(texture: &Value) -> Option<(&'static str, &'static str)> {
    let given = texture.get("extensions")?;
    OF_IMAGES.into_iter().find(|(name, _)| given.get(name).is_some())
}
