//! Import and export of Wavefront OBJ, with its material libraries (MTL).
//!
//! - Every object (`o`) and every group (`g`) becomes a bone that never moves; a group's bone is below its object's. Faces of
//!   one object, group and material (`usemtl`) become one [`Mesh`](crate::asset::Mesh), in the order of their first faces. Its
//!   name is that of its group or object, followed by a number. Faces without object and group belong to the bone `mesh`.
//! - Corners with the same indices of position, texture coordinates and normal in the file become one vertex. Vertices are
//!   sorted by these indices.
//! - Polygons become triangles: convex ones become fans around their first corner, others are cut by ear clipping, which leaves
//!   no corner out. Triangles that name a position twice are left out, as are points, lines and free-form surfaces.
//! - Corners without a normal get the smooth normal of their position, weighted by area over all such faces around it in the
//!   whole file. Smoothing groups are not read. Tangents are computed as for glTF.
//! - Texture coordinates have their origin at the bottom in the file, and at the top in the model.
//! - Of materials, the import reads colour (`Kd`, as sRGB), opacity (`d` or `Tr`, which becomes a [screen-door
//!   pattern](crate::asset::material::Alpha::Dithered)), `map_Kd`, `map_d` and the normal map. The normal map is `norm`, or
//!   else `map_Bump` or `bump` if it has colours: a grey image there is a height map, which is left out. Of the options of maps
//!   it reads `-o`, `-s`, `-clamp` and `-bm`. Offset and scale of `map_Kd` are applied to the texture coordinates.
//! - A library that does not exist is left out, and so is a material that no library has; its meshes have no material then.
//!   Everything else that the file names must exist.
//!
//! Every error names the line, counted from 1, with its text. No file causes a panic. Memory grows linearly with the file;
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
pub(crate) use write::{ObjWriter, Object};

impl Model {
    /// Reads Wavefront OBJ from memory. Material libraries and images are read from `folder`; without a folder they are left
    /// out.
    ///
    /// # Errors
    /// [`InputError`] with the line. Its path is `line 12`, or `wood.mtl line 12` for a line of a library.
    pub fn from_obj(bytes: &[u8], folder: Option<&Path>) -> Result<Self, InputError> {
        match folder {
            Some(folder) => Self::from_obj_beside(bytes, &|name| std::fs::read(folder.join(name))),
            None => model::import(bytes, None),
        }
    }

    /// Reads Wavefront OBJ from memory. `beside` reads material libraries and images, given their paths relative to the file's
    /// folder. It works without a file system.
    ///
    /// # Errors
    /// As [`Model::from_obj`].
    pub fn from_obj_beside(bytes: &[u8], beside: Beside<'_>) -> Result<Self, InputError> {
        model::import(bytes, Some(beside))
    }
}
