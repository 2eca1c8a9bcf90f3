//! Import and export of Wavefront OBJ, with its material libraries (MTL).
//!
//! - Every object (`o`) and every group (`g`) becomes a bone that never moves. The bone of a group is a child of its object's
//!   bone. Faces without object and group belong to the bone `mesh`.
//! - Faces of one object, group and material (`usemtl`) become one [`Mesh`](crate::asset::Mesh). Meshes are in the order of
//!   their first faces. A mesh has the name of its group or object, followed by a number.
//! - Corners with the same indices of position, texture coordinates and normal in the file become one vertex. Vertices are
//!   sorted by these indices.
//! - Polygons become triangles. Convex polygons become fans around their first corner. Other polygons are cut by ear clipping,
//!   which leaves no corner out. Points, lines, free-form surfaces, and triangles that name a position twice are left out.
//! - A corner without a normal gets the smooth normal of its position: the area-weighted mean over all faces of the file that
//!   meet there and lack normals. Smoothing groups are not read. Tangents are computed as for glTF.
//! - Texture coordinates have their origin at the bottom of the image in the file, and at the top in the model.
//! - From a material, the import reads colour (`Kd`, as sRGB), opacity (`d` or `Tr`), `map_Kd`, `map_d` and the normal map, and
//!   emission (`Ke`, as sRGB), metalness (`Pm`) and roughness (`Pr`), which scenes do not draw.
//!   Opacity becomes a [screen-door pattern](crate::asset::material::Alpha::Dithered).
//! - The normal map is `norm`, or else `map_Bump` or `bump` if that image has colours. A grey image is a height map, which is
//!   left out.
//! - From the options of maps, the import reads `-o`, `-s`, `-clamp` and `-bm`. Offset and scale of `map_Kd` are applied to the
//!   texture coordinates.
//! - A library that does not exist is left out. A mesh whose material is in no library has no material. Everything else that
//!   the file names must exist.
//!
//! Every error has the line, counted from 1, and the line's text. No file causes a panic. Memory grows linearly with the file;
//! images have the same limits as in glTF ([`crate::asset::gltf`]).

mod library;
mod maps;
mod materials;
mod model;
mod parsed;
mod polygons;
mod statements;
mod write;

use std::path::Path;

use super::gltf::Beside;
use super::model::Model;
use crate::InputError;
pub use write::{ObjWriter, Object};

impl Model {
    /// Reads Wavefront OBJ from memory. Material libraries and images are read from `folder`, or left out if it is `None`.
    ///
    /// # Errors
    /// [`InputError`] whose path is the line: `line 12`, or `wood.mtl line 12` for a line of a library.
    pub fn from_obj(bytes: &[u8], folder: Option<&Path>) -> Result<Self, InputError> {
        match folder {
            Some(folder) => Self::from_obj_beside(bytes, &|name| std::fs::read(folder.join(name))),
            None => model::import(bytes, None),
        }
    }

    /// Reads Wavefront OBJ from memory. The function `beside` reads material libraries and images; it receives their paths
    /// relative to the file's folder. No file system is needed.
    ///
    /// # Errors
    /// The errors of [`Model::from_obj`].
    pub fn from_obj_beside(bytes: &[u8], beside: Beside<'_>) -> Result<Self, InputError> {
        model::import(bytes, Some(beside))
    }
}
