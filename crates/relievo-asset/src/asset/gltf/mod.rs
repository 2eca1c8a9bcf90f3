//! Import of glTF 2.0, as JSON or GLB: the nodes of the default scene, skins, animations, and meshes.
//!
//! - **Scene.** Only one scene is imported: the default scene that the document names, or else its first scene. If the document
//!   has no scene, every node is imported.
//! - **Bones.** Bones are the joints of every skin that the scene's nodes use, each once, and all ancestors of those joints.
//!   Ancestors are included because a joint's position in the scene is the product of all transforms from the root down.
//!   Animations may move any of these nodes, even nodes that no skin uses.
//! - glTF requires that joints lie in the same scene as the node with the skin. Joints outside the scene become bones
//!   nevertheless, because vertices follow them. Such joints are posed relative to their own root. A skin that no node uses is
//!   imported if all its joints lie in the scene.
//! - If there is no skin, bones are the nodes that carry meshes (see below), the nodes that an animation moves, and all their
//!   ancestors. All of these are [joints](crate::asset::Skeleton::joints).
//! - Matrices of nodes are decomposed into translation, rotation and scale.
//! - Accessors may be sparse, interleaved, and of normalized integers. Buffers may lie in the GLB, in `data:` URIs, or in files
//!   beside the document.
//! - A channel adds no keys to the clip if it animates morph weights, or if its node is not a bone. The times of such a channel
//!   still count for the clip's duration.
//! - **Meshes.** Each primitive becomes one [`Mesh`](crate::asset::Mesh), with vertices in the file's order. Meshes of nodes
//!   with a skin come first, in the order of the nodes; meshes of nodes without a skin follow in the same order.
//! - A mesh without a skin follows one bone, through a skin of its own. The bone is the lowest node, at or above the mesh's
//!   node, that is a joint, an ancestor of joints, or animated. If there is none, the bone is the root of the tree, which never
//!   moves. A node that becomes a bone only because a mesh follows it does not become a joint. All its ancestors become bones
//!   as well.
//! - Strips and fans become lists of triangles. Points, lines, and primitives without positions are left out. If no primitive
//!   has positions, the document is refused.
//! - Missing normals become smooth normals. Missing tangents, and tangents given without normals, are computed by MikkTSpace.
//!   If there is a normal texture, MikkTSpace uses the texture coordinates of that texture, before any `KHR_texture_transform`.
//!   A vertex whose corners have different tangents is duplicated at the end of its primitive, one copy per tangent.
//! - A vertex whose weights are all 0 follows the joint in its first slot, as in three.js. A vertex with more than
//!   [`MAX_INFLUENCES`](crate::asset::influences::MAX_INFLUENCES) joints follows the strongest of them.
//! - Triangles that are mirrored at rest get the reverse winding, see [`Mesh::indices`](crate::asset::Mesh::indices). If only
//!   some bones of a mesh mirror, this is decided triangle by triangle. If a clip gives a bone's scale another sign than at
//!   rest, the triangles that follow the bone are seen from inside.
//! - **Materials.** The import reads base colour with its texture, the normal map with its scale, samplers, alpha, and
//!   `doubleSided`. Images may be PNG, JPEG or WebP, in the GLB, in `data:` URIs or in files beside the document.
//! - Textures may use any set of texture coordinates; `KHR_texture_transform` is applied to the coordinates. A normal map is
//!   left out if it is sampled at other coordinates than the base colour's texture.
//! - The opacity of `BLEND` becomes a [screen-door pattern](crate::asset::material::Alpha::Dithered);
//!   [`Model::blend`](crate::asset::Model::blend) turns the pattern into blending. Extensions of materials, and
//!   materials that no mesh uses, are left out.
//! - **What scenes do not draw.** The import also reads metallic-roughness, occlusion and emission with their textures
//!   ([`Pbr`](crate::asset::material::Pbr)), `COLOR_0`, and a second set of texture coordinates: that of the first of these
//!   textures which lies elsewhere than the mesh's own coordinates, or else `TEXCOORD_1`. A texture that needs a third set is left
//!   out. Their images are decoded when their texels are asked for ([`Image`](crate::asset::Image)).
//!
//! # Levels of detail
//!
//! At each level that `MSFT_lod` lists, another node takes the place of a node and of everything below it: below the same
//! parent, with its own transform. A node without the extension is in every level. A node with fewer levels than others keeps
//! its last one. Of nodes with levels below other nodes with levels, the upper ones count. Bones are the same at every level.
//! A listed node must exist, be listed once, and have neither levels nor a parent; it must not be in the scene. There are at
//! most 8 levels.
//!
//! `extras` may be any value. Integers may be written with a fraction of 0 or an exponent.
//!
//! # Extensions
//!
//! A document may require the extensions of the first table except `KHR_animation_pointer`, and also `KHR_lights_punctual` and
//! every `KHR_materials_*`. A document that requires another extension is refused; the error names the extension. Extensions
//! that a document uses are treated as follows:
//!
//! | read | remarks |
//! |---|---|
//! | `KHR_draco_mesh_compression` | decompressed, even if the file also has the uncompressed data |
//! | `EXT_meshopt_compression`, `KHR_meshopt_compression` | decompressed, even if the file also has the uncompressed data |
//! | `KHR_mesh_quantization` | |
//! | `KHR_texture_transform` | for all textures |
//! | `EXT_texture_webp` | if there is no PNG or JPEG beside it |
//! | `KHR_materials_pbrSpecularGlossiness` | the diffuse colour is the base colour |
//! | `KHR_animation_pointer` | pointers at translation, rotation, scale and weights of nodes |
//! | `MSFT_lod` on nodes | [`Model::levels_from_file`](crate::asset::Model::levels_from_file) reads all levels, other functions the finest |
//!
//! | refused | where |
//! |---|---|
//! | `EXT_mesh_gpu_instancing` | on a node of the scene |
//! | `KHR_texture_basisu` (KTX2), `EXT_texture_avif`, `MSFT_texture_dds` | in a texture that is read and has no PNG, JPEG or WebP beside it; the error says how to convert it |
//!
//! | left out | remarks |
//! |---|---|
//! | other `KHR_materials_*` | of materials, only the core of glTF is read; with `KHR_materials_variants`, meshes keep their default material |
//! | `KHR_lights_punctual`, cameras | |
//! | `KHR_animation_pointer` with any other target | |
//! | `KHR_node_visibility` | hidden nodes are read like others |
//! | `MSFT_lod` on materials | the finest is read: levels are chosen by the error of their surface, which materials do not change |
//! | `MSFT_screencoverage` | errors of levels are measured instead |
//! | `EXT_mesh_features`, `EXT_structural_metadata`, and others that add data to meshes | |
//!
//! [`Model::from_file_bare`](crate::asset::Model::from_file_bare) ignores extensions that concern materials and images.
//!
//! # Limits
//!
//! Every error names the fault with its path in the file (`accessors[3].count`). No file causes a panic. No file causes an
//! allocation out of proportion to its size, because counts are checked against the bytes present. Data that may be much larger
//! than its bytes in the file has separate limits:
//!
//! - An accessor without a buffer view has at most 65,536 elements, or one for each byte of the document and its buffers,
//!   whichever is more.
//! - Data that is read repeatedly (meshes of several nodes, keys of several channels) has at most 128 elements per byte, up to
//!   16 million elements in total. Large documents may have more: 4 elements per byte, or 16 if meshes are compressed.
//! - All images together have at most 256 texels per byte of the document, or 16 million texels, whichever is more. The width
//!   and height of an image are at most 8192.

mod accessor;
pub(super) mod budget;
mod clips;
mod container;
mod document;
mod draco;
mod extensions;
mod faults;
mod json;
mod levels;
pub(super) mod materials;
mod meshes;
mod meshopt;
mod nodes;
mod primitive;
mod rigid;
mod scene;
pub(super) mod tangents;
mod winding;
mod write;

use std::path::Path;

use super::model::Model;
use crate::InputError;
use document::Document;
use levels::Lods;
pub use levels::OBJECT_LEVELS;
use materials::Materials;

/// Callback that reads a file. It receives the file's path relative to the folder of the imported file.
pub type Beside<'a> = &'a dyn Fn(&Path) -> std::io::Result<Vec<u8>>;

impl Model {
    /// Reads glTF from memory. External buffers and images are read from `folder`; if it is `None`, documents that need them
    /// are refused.
    ///
    /// # Errors
    /// [`InputError`] with the path of the fault in the file.
    pub fn from_gltf(bytes: &[u8], folder: Option<&Path>) -> Result<Self, InputError> {
        match folder {
            Some(folder) => Self::from_gltf_beside(bytes, &|name| std::fs::read(folder.join(name))),
            None => Self::import(bytes, None, Materials::default()),
        }
    }

    /// Reads glTF from memory. The function `beside` reads external buffers and images; it receives their paths relative to the
    /// document's folder. No file system is needed.
    ///
    /// # Errors
    /// [`InputError`] with the path of the fault in the file.
    pub fn from_gltf_beside(bytes: &[u8], beside: Beside<'_>) -> Result<Self, InputError> {
        Self::import(bytes, Some(beside), Materials::default())
    }

    /// Reads glTF like [`Model::from_gltf_beside`], but leaves out materials and images.
    pub(super) fn from_gltf_bare(bytes: &[u8], beside: Beside<'_>) -> Result<Self, InputError> {
        Self::import(bytes, Some(beside), Materials::unread())
    }

    /// Reads glTF like [`Model::from_gltf_beside`]. Also returns the images as files.
    pub(super) fn from_gltf_with_files(
        bytes: &[u8],
        beside: Beside<'_>,
    ) -> Result<(Self, Vec<Vec<u8>>), InputError> {
        let mut materials = Materials::with_files();
        let model = Self::of_document(&Document::new(bytes, Some(beside), false)?, &mut materials)?;
        Ok((model, materials.files.unwrap_or_default()))
    }

    fn import(
        bytes: &[u8],
        beside: Option<Beside<'_>>,
        mut materials: Materials,
    ) -> Result<Self, InputError> {
        let document = Document::new(bytes, beside, materials.is_unread)?;
        Self::of_document(&document, &mut materials)
    }

    /// Reads all levels of detail (`MSFT_lod`) like [`Model::from_gltf_beside`], the finest first.
    pub(super) fn levels_from_gltf_beside(bytes: &[u8], beside: Beside<'_>) -> Result<Vec<Self>, InputError> {
        let mut all = Vec::new();
        loop {
            // Each level has a budget of its own.
            let mut document = Document::new(bytes, Some(beside), false)?;
            let lods = Lods::new(&document)?;
            let levels = lods.levels(&document.root);
            lods.choose(&mut document.root, all.len());
            all.push(Self::of_document(&document, &mut Materials::default())?);
            if all.len() == levels {
                return Ok(all);
            }
        }
    }

    fn of_document(document: &Document<'_>, materials: &mut Materials) -> Result<Self, InputError> {
        let nodes = nodes::Nodes::new(document)?;
        let clips = clips::clips(document, &nodes)?;
        let meshes = meshes::meshes(document, &nodes, materials)?;
        let (materials, images) =
            (std::mem::take(&mut materials.materials), std::mem::take(&mut materials.images));
        let own = nodes.own_skins();
        let skinned = meshes.iter().take_while(|mesh| mesh.skin < own).count();
        Ok(Self {
            skeleton: nodes.skeleton,
            skins: nodes.skins,
            clips,
            motion: None,
            meshes,
            skinned,
            materials,
            images,
        })
    }
}
