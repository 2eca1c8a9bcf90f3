//! Extensions that a document may require, and the data of extensions that gltf-json does not read.

use gltf_json::extensions::texture::TextureTransform;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::draco::Draco;
use super::faults;
use super::meshopt::Meshopt;
use crate::InputError;

/// Extensions that a document may require. Lights are not imported, but their extension is accepted, because Blender requires
/// it in every file with lights.
const READ: [&str; 8] = [
    DRACO,
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    WEBP,
    "KHR_lights_punctual",
    LOD,
];

/// Prefix of material extensions. A document may require any of them, because the import leaves out everything in materials
/// except colours and normal maps.
const OF_MATERIALS: &str = "KHR_materials_";

/// Extension for Draco compression of primitives.
pub const DRACO: &str = "KHR_draco_mesh_compression";

/// Both names of the extension for meshoptimizer compression of buffer views. If a view has both, the first name counts.
const MESHOPT: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// Extension for levels of detail of nodes and materials.
pub const LOD: &str = "MSFT_lod";

/// Extension that draws many copies of a node's mesh.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Extension for textures with WebP images.
const WEBP: &str = "EXT_texture_webp";

/// Extensions for image formats that are not supported, each with a remedy for the error message. A document may require them
/// if materials and images are not read.
const OF_IMAGES: [(&str, &str); 3] = [
    ("KHR_texture_basisu", DECOMPRESS),
    ("EXT_texture_avif", "convert its textures to PNG, as `gltf-transform png IN OUT` does"),
    ("MSFT_texture_dds", "convert its textures to PNG"),
];

/// Remedy that the error for a KTX2 image suggests.
pub const DECOMPRESS: &str = "decompress its textures, as `gltf-transform ktxdecompress IN OUT` does";

/// Data of extensions that gltf-json does not read.
pub struct Extensions {
    /// For each material, the `KHR_texture_transform` of its normal texture.
    pub normal_transforms: Vec<Option<TextureTransform>>,
    /// For each material, the transform of its occlusion texture.
    pub occlusion_transforms: Vec<Option<TextureTransform>>,
    /// For each buffer view, its meshoptimizer compression.
    pub meshopt: Vec<Option<Meshopt>>,
    /// For each mesh, the Draco compression of each of its primitives.
    pub draco: Vec<Vec<Option<Draco>>>,
    /// For each texture, the index of its `EXT_texture_webp` image.
    pub webp: Vec<Option<usize>>,
    /// For each texture, the name of an extension whose image cannot be read, and the remedy.
    pub unread_images: Vec<Option<(&'static str, &'static str)>>,
    /// For each node with levels of detail, the node as JSON.
    pub lods: Vec<Option<Value>>,
    /// For each node, whether `EXT_mesh_gpu_instancing` makes many copies of its mesh.
    instanced: Vec<bool>,
}

/// For each material, the transform of the texture in one of its fields.
fn transforms(document: &Value, field: &str) -> Result<Vec<Option<TextureTransform>>, InputError> {
    each(document, "materials", |material, path| {
        let texture = material.get(field).unwrap_or(&Value::Null);
        extension(texture, "KHR_texture_transform", &format!("{path}.{field}"))
    })
}

impl Extensions {
    /// Reads the extensions of a document. `is_bare` means that materials and images are not needed.
    ///
    /// # Errors
    /// [`InputError`] for extensions that the document requires and this crate does not support.
    pub fn new(document: &Value, is_bare: bool) -> Result<Self, InputError> {
        check_required(document, is_bare)?;
        Ok(Self {
            normal_transforms: transforms(document, "normalTexture")?,
            occlusion_transforms: transforms(document, "occlusionTexture")?,
            meshopt: each(document, "bufferViews", |view, path| {
                for name in MESHOPT {
                    if let Some(found) = extension::<Meshopt>(view, name, path)? {
                        return Ok(Some(found.named(name)));
                    }
                }
                Ok(None)
            })?,
            draco: each(document, "meshes", |mesh, path| {
                let draco = |primitive, at: &str| extension(primitive, DRACO, &format!("{path}.{at}"));
                each(mesh, "primitives", draco)
            })?,
            webp: each(document, "textures", |texture, path| {
                Ok(extension(texture, WEBP, path)?.map(|Webp { source }| source))
            })?,
            unread_images: list(document, "textures").map(unread_image).collect(),
            lods: (list(document, "nodes"))
                .map(|node| node.pointer("/extensions/MSFT_lod").is_some().then(|| node.clone()))
                .collect(),
            instanced: (list(document, "nodes"))
                .map(|node| node.get("extensions").is_some_and(|all| all.get(INSTANCING).is_some()))
                .collect(),
        })
    }

    /// Whether any mesh or buffer view of the document is compressed.
    pub fn is_compressed(&self) -> bool {
        self.draco.iter().flatten().any(Option::is_some) || self.meshopt.iter().any(Option::is_some)
    }

    /// Refuses an instanced node that the import reads, because only one copy of its mesh would be read.
    pub fn check_copies(&self, is_read: &[bool]) -> Result<(), InputError> {
        match self.instanced.iter().zip(is_read).position(|(is_instanced, is_read)| *is_instanced && *is_read)
        {
            None => Ok(()),
            Some(node) => {
                let bound = "is not read: write a node for each copy";
                Err(InputError::new(format!("nodes[{node}].extensions.{INSTANCING}"), "given", bound))
            }
        }
    }
}

#[derive(Deserialize)]
struct Webp {
    source: usize,
}

/// Iterates over the list `name` of an object; empty if the object has no such list.
fn list<'a>(value: &'a Value, name: &str) -> impl Iterator<Item = &'a Value> {
    value.get(name).and_then(Value::as_array).into_iter().flatten()
}

/// Applies `read` to each element of the list `name`, together with the element's path.
fn each<'a, T>(
    value: &'a Value,
    name: &str,
    read: impl Fn(&'a Value, &str) -> Result<T, InputError>,
) -> Result<Vec<T>, InputError> {
    list(value, name).enumerate().map(|(at, element)| read(element, &format!("{name}[{at}]"))).collect()
}

/// Reads the extension `name` of the object at `path`; `None` if the object does not have it.
pub fn extension<T: DeserializeOwned>(
    object: &Value,
    name: &str,
    path: &str,
) -> Result<Option<T>, InputError> {
    let Some(given) = object.get("extensions").and_then(|all| all.get(name)) else { return Ok(None) };
    let parse = |text: &[u8]| serde_json::from_slice(text);
    faults::read(&given.to_string(), parse, || given.clone()).map(Some).map_err(|error| {
        let path = format!("{path}.extensions.{name}");
        let InputError { path: field, value, bound } = error;
        let path = if field.is_empty() { path } else { format!("{path}.{field}") };
        InputError { path, value, bound }
    })
}

/// Refuses a document that requires an unsupported extension.
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

/// Returns the extension by which a texture uses an image format that cannot be read, and the remedy. `None` if there is none.
fn unread_image(texture: &Value) -> Option<(&'static str, &'static str)> {
    let given = texture.get("extensions")?;
    OF_IMAGES.into_iter().find(|(name, _)| given.get(name).is_some())
}
