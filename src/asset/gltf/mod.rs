//! Import of glTF 2.0, as JSON or GLB: the nodes of the default scene that meshes follow, skins, animations, and meshes.
//!
//! - Only the default scene is imported: the one that the document names, or its first; every node where it has no
//!   scene.
//! - Bones are the joints of every skin that the scene's nodes have, each once, and all nodes above them: a joint's place
//!   in the scene is the product of every node from the root, whether or not a skin uses it, and animations may move any
//!   of them. glTF asks that such joints lie in the same scene; where they lie outside, they are bones all the same,
//!   posed as they stand below their own root, since vertices follow them. Skins that no node has count where all their
//!   joints lie in the scene.
//! - Without a skin, bones are the nodes that carry meshes (see below), those that an animation moves, and all above
//!   them; and all of these are [joints](crate::asset::Skeleton::joints).
//! - Matrix nodes are taken apart into translation, rotation and scale.
//! - Accessors may be sparse, interleaved, and of normalized integers. Buffers lie in the GLB, in `data:` URIs, or in
//!   files beside the document.
//! - Channels that move no node, or one that is no bone, are left out, but count for the clip's duration.
//! - Meshes are those of the scene's nodes with a skin, a [`Mesh`](crate::asset::Mesh) a primitive, in the order of the nodes,
//!   vertices in the file's order; behind them those of nodes without one, in the same order. The latter follow one
//!   bone, by a skin of their own: the lowest node at or above them that is a joint, lies above joints, or is animated;
//!   where there is none, the root of their tree, which never moves. Such a node becomes a bone with all above it, as
//!   joints do, but no joint. Strips and fans become triangles; points and lines have none. Normals that are
//!   missing are smooth. Tangents that are missing, or given without normals, are MikkTSpace's, from the texture
//!   coordinates of the normal texture where there is one, before any `KHR_texture_transform`. Where corners of a vertex
//!   have different tangents, it is repeated behind all others of its primitive, one copy a tangent. Meshes that Draco
//!   compressed are left out.
//! - Triangles of what is mirrored at rest are turned round, mesh by mesh, and in a mesh whose bones mirror some of it and
//!   some not triangle by triangle: [`Mesh::indices`](crate::asset::Mesh::indices). What a clip mirrors, or mirrors back,
//!   by a scale of another sign than at rest, is seen from inside.
//! - Of materials: base colour with its texture (PNG or JPEG, in the GLB, in `data:` URIs or in files beside the
//!   document; any set of texture coordinates, `KHR_texture_transform` applied to these), samplers, alpha, and
//!   `doubleSided`. Opacity of `BLEND` becomes a [screen-door](crate::asset::material::Alpha::Dithered). Colours of
//!   vertices, everything else of materials, and materials of no mesh are left out.
//!
//! Of `extensionsRequired`, `KHR_draco_mesh_compression` (without the meshes), `KHR_mesh_quantization` and
//! `KHR_texture_transform` are read, and every other one is refused; those of materials and images matter only where
//! these are read.
//!
//! Every error names what is wrong with its path inside the file (`accessors[3].count`). No file makes it panic, nor
//! allocate what its bytes do not account for: counts are checked against the bytes that are there. What needs none has
//! bounds of its own: an accessor without a buffer view has at most 65,536 elements, or one for each byte of the document
//! and its buffers; what is read again and again (meshes of several nodes, keys of several channels) at most 128 elements
//! a byte up to 16 million, or 4 a byte; images 256 texels a byte, or 16 million, and 8192 in width and height.

mod accessor;
mod budget;
mod clips;
mod container;
mod document;
mod materials;
mod meshes;
mod nodes;
mod rigid;
mod scene;
mod tangents;
mod winding;

use std::path::Path;

use super::model::Model;
use crate::{Error, InputError};
use document::Document;
use materials::Materials;

impl Model {
    /// Reads a `.gltf` or `.glb` file, and the buffers beside it.
    ///
    /// # Errors
    /// [`Error::File`] when the file cannot be read, [`Error::InputFile`] with the path inside the file for
    /// everything that glTF forbids or that the crate does not read.
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        Self::read(path, Materials::default())
    }

    /// As [`Model::from_file`], without materials and images: for those who draw nothing, whatever textures lack, and
    /// whichever extensions they require. No vertex is repeated for its tangents.
    ///
    /// # Errors
    /// As [`Model::from_file`], but for materials and images.
    pub fn from_file_bare(path: &Path) -> Result<Self, Error> {
        Self::read(path, Materials::unread())
    }

    fn read(path: &Path, materials: Materials) -> Result<Self, Error> {
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::import(&bytes, Some(folder), materials)
            .map_err(|source| Error::InputFile { path: path.to_owned(), source })
    }

    /// Reads glTF from memory. External buffers lie in `folder`; without one they are refused.
    ///
    /// # Errors
    /// [`InputError`] with the path inside the file.
    pub fn from_gltf(bytes: &[u8], folder: Option<&Path>) -> Result<Self, InputError> {
        Self::import(bytes, folder, Materials::default())
    }

    fn import(bytes: &[u8], folder: Option<&Path>, mut materials: Materials) -> Result<Self, InputError> {
        let document = Document::new(bytes, folder, materials.is_unread)?;
        let nodes = nodes::Nodes::new(&document)?;
        let clips = clips::clips(&document, &nodes)?;
        // What Draco compressed has no vertices here.
        let meshes = match document.is_draco {
            true => Vec::new(),
            false => meshes::meshes(&document, &nodes, &mut materials)?,
        };
        let Materials { materials, images, .. } = materials;
        let own = nodes.own_skins();
        let skinned = meshes.iter().take_while(|mesh| mesh.skin < own).count();
        Ok(Self { skeleton: nodes.skeleton, skins: nodes.skins, clips, meshes, skinned, materials, images })
    }
}
