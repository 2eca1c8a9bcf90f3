//! Import of models from files. The file extension selects the format.

use std::path::Path;

use super::model::Model;
use super::package::{Package, is_package};
use crate::asset::gltf::Beside;
use crate::{Error, InputError};

/// Extensions of the file formats that can be imported, in lower case.
#[doc(hidden)]
pub const ENDINGS: [&str; 4] = ["glb", "gltf", "obj", "rlv"];

/// A model, and what its file has beyond it.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelFile {
    /// The model.
    pub model: Model,
    /// The images of the model as PNG, JPEG or WebP; empty for a Wavefront OBJ file.
    pub images: Vec<Vec<u8>>,
    /// [`PackageHeader::quantization`](super::package::PackageHeader::quantization) of a package; otherwise 0.
    pub quantization: f32,
}

impl From<Model> for ModelFile {
    fn from(model: Model) -> Self {
        Self { model, images: Vec::new(), quantization: 0.0 }
    }
}

impl ModelFile {
    /// Reads a file like [`Model::from_file`], and keeps its images.
    ///
    /// # Errors
    /// The errors of [`Model::from_file`].
    pub fn open(path: &Path) -> Result<Self, Error> {
        Model::read(path, |bytes, beside| Self::from_bytes_beside(path, bytes, beside))
    }

    /// Reads a file from memory like [`Model::from_bytes_beside`], and keeps its images.
    ///
    /// # Errors
    /// The errors of [`Model::from_bytes_beside`].
    pub fn from_bytes_beside(name: &Path, bytes: &[u8], beside: Beside<'_>) -> Result<Self, InputError> {
        if is_package(bytes) {
            let (model, package) = (Model::from_rlv(bytes)?, Package::new(bytes)?);
            let header = package.header();
            let images = header.images.iter().filter_map(|image| bytes.get(image.range()));
            let images = images.map(<[u8]>::to_vec).collect();
            return Ok(Self { model, images, quantization: header.quantization });
        }
        if is_obj(name) {
            return Ok(Model::from_obj_beside(bytes, beside)?.into());
        }
        let (model, images) = Model::from_gltf_with_files(bytes, beside)?;
        Ok(Self { model, images, quantization: 0.0 })
    }
}

impl Model {
    /// Reads a package (`.rlv`, [`package`](super::package)), or a `.gltf`, `.glb` or `.obj` file with the buffers, material
    /// libraries and images that lie beside it. The model of a package has levels of detail.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read. [`Error::InputFile`] for content that the format forbids or that this crate
    /// does not support; the error has the path inside the file, or the line.
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        Self::read(path, |bytes, beside| Self::from_bytes_beside(path, bytes, beside))
    }

    /// Reads a file like [`Model::from_file`], but leaves out materials and images. Use it when nothing is drawn. Missing
    /// textures, and extensions for materials and images, cause no error. No vertex is duplicated for its tangents.
    ///
    /// # Errors
    /// The errors of [`Model::from_file`], except those about materials and images.
    pub fn from_file_bare(path: &Path) -> Result<Self, Error> {
        Self::read(path, |bytes, beside| match () {
            () if is_package(bytes) => Self::from_rlv_bare(bytes),
            () if is_obj(path) => Self::from_obj(bytes, None),
            () => Self::from_gltf_bare(bytes, beside),
        })
    }

    /// Reads a model from memory: a package if the bytes begin like one, Wavefront OBJ if its name ends in `.obj`, otherwise
    /// glTF. The function `beside` reads the
    /// other files; it receives their paths relative to the model's folder. No file system is needed.
    ///
    /// # Errors
    /// [`InputError`] with the path inside the glTF file, or the line of the OBJ file.
    pub fn from_bytes_beside(name: &Path, bytes: &[u8], beside: Beside<'_>) -> Result<Self, InputError> {
        match () {
            () if is_package(bytes) => Self::from_rlv(bytes),
            () if is_obj(name) => Self::from_obj_beside(bytes, beside),
            () => Self::from_gltf_beside(bytes, beside),
        }
    }

    /// Reads a file like [`Model::from_file`], with all levels of detail that an artist made: one model a level, the finest
    /// first. Levels are nodes with the extension `MSFT_lod` ([`gltf`](super::gltf#levels-of-detail)). A file without the
    /// extension has one level, and so has a package, whose model has levels of detail of its own.
    /// `relievo::ops::skinning::join_levels` makes one model of the levels.
    ///
    /// # Errors
    /// The errors of [`Model::from_file`], and [`Error::InputFile`] for nodes that cannot be levels
    /// (`nodes[0].extensions.MSFT_lod.ids[1]`).
    pub fn levels_from_file(path: &Path) -> Result<Vec<Self>, Error> {
        Self::read(path, |bytes, beside| Self::levels_from_bytes_beside(path, bytes, beside))
    }

    /// Reads levels of detail like [`Model::levels_from_file`], from memory like [`Model::from_bytes_beside`].
    ///
    /// # Errors
    /// [`InputError`] with the path inside the glTF file, or the line of the OBJ file.
    pub fn levels_from_bytes_beside(
        name: &Path,
        bytes: &[u8],
        beside: Beside<'_>,
    ) -> Result<Vec<Self>, InputError> {
        match is_obj(name) || is_package(bytes) {
            true => Ok(vec![Self::from_bytes_beside(name, bytes, beside)?]),
            false => Self::levels_from_gltf_beside(bytes, beside),
        }
    }

    fn read<T>(
        path: &Path,
        import: impl FnOnce(&[u8], Beside<'_>) -> Result<T, InputError>,
    ) -> Result<T, Error> {
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        import(&bytes, &|name: &Path| std::fs::read(folder.join(name)))
            .map_err(|source| Error::InputFile { path: path.to_owned(), source })
    }
}

fn is_obj(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj"))
}
