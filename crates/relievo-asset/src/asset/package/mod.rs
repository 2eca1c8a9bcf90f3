//! Packages (`.rlv`): a model with its levels of detail, for disk and wire. Any prefix that ends at the end of a level is a
//! model at that level.
//!
//! | bytes | content |
//! |---|---|
//! | 4 | `RLV` and a line feed |
//! | 4 | length of the header, little-endian |
//! | 32 | SHA-256 of the header |
//! | … | the header: JSON ([`PackageHeader`]) |
//! | … | the model's skeleton, skins, clips and materials |
//! | … | the levels, the coarsest first |
//! | … | the images |
//!
//! The chunks lie one behind the other, in the order of the header. A level's chunk refines the level before. Vertices and
//! triangles have the order in which they are decoded.
//!
//! A package is lossless. Attributes that lie on a grid take few bytes; `relievo::ops::skinning::cook` moves them there.
//! Vertices that no triangle uses are left out.

mod attributes;
mod coder;
mod grid;
mod header;
mod mesh;
mod parts;
mod snap;
mod surface;
mod write;

use super::gltf::budget::Budget;
use super::gltf::materials;
use super::image_file::Image;
use super::model::Model;
use crate::InputError;
use crate::hash;
use coder::{Reader, damaged};
pub use header::{PackageChunk, PackageHeader, PackageLevel, VERSION, sha256};
use mesh::{Contexts, LeveledMesh};
use parts::Parts;
pub use snap::{snapped, welded};
use surface::Room;
pub use write::{Packed, write};

/// Whether bytes begin like a package.
pub(super) fn is_package(bytes: &[u8]) -> bool {
    bytes.starts_with(&header::MAGIC)
}

/// A reader of a package, from the coarsest level to the finest.
///
/// ```
/// use relievo::asset::package::Package;
///
/// let rock = relievo_samples::rock()?.into();
/// let bytes = relievo::ops::skinning::cook(&rock, &mut |_| std::ops::ControlFlow::Continue(()))?;
/// let bytes = bytes.expect("not broken off");
/// let mut package = Package::new(&bytes)?;
/// let header = package.header().clone();
/// for level in &header.levels {
///     package.add_level(&bytes[level.chunk.range()])?; // as it arrives
///     assert_eq!(package.hash()?, level.hash);
/// }
/// # Ok::<(), relievo::InputError>(())
/// ```
pub struct Package {
    header: PackageHeader,
    parts: Parts,
    meshes: Vec<LeveledMesh<'static>>,
    contexts: Contexts,
    room: Room,
    /// Number of levels that were read.
    levels: usize,
    images: Vec<Image>,
    budget: Budget,
}

impl Package {
    /// Reads the header and the model's chunk. Later bytes may be missing.
    ///
    /// # Errors
    /// [`InputError`] in the cases of [`PackageHeader::read`], for missing bytes, and for a damaged chunk.
    pub fn new(bytes: &[u8]) -> Result<Self, InputError> {
        let (header, _) = PackageHeader::read(bytes)?;
        let Some(chunk) = bytes.get(header.model.range()) else {
            let bound = format!("must be at least {}, the end of the model's chunk", header.model.end);
            return Err(InputError::new("package.len", bytes.len(), bound));
        };
        header.model.check("package.model", chunk)?;
        let parts = Parts::unpacked(chunk)?;
        let motion = parts.motion.iter().try_for_each(|motion| motion.check(parts.clips.len()));
        motion.map_err(|error| error.below("package.model"))?;
        let level_bytes = header.level_bytes();
        let room = Room {
            points: header.vertices(),
            vertices: header.vertices(),
            triangles: header::most_triangles(level_bytes),
            moves: header::most_moves(level_bytes),
            tests: header::most_tests(level_bytes),
        };
        let mesh = |(at, mesh): (usize, &parts::MeshParts)| {
            LeveledMesh::new(mesh, &parts.skins, header.levels.len())
                .map_err(|error| error.below(&format!("package.model.meshes[{at}]")))
        };
        let meshes = parts.meshes.iter().enumerate().map(mesh).collect::<Result<_, _>>()?;
        let budget = Budget::default();
        header.images.iter().for_each(|image| budget.add_bytes(image.end - image.start));
        let (contexts, images) = (Contexts::new(), Vec::new());
        Ok(Self { header, parts, meshes, contexts, room, levels: 0, images, budget })
    }

    /// Reads a whole package, or one that ends with a level, without its images.
    fn with_levels(bytes: &[u8]) -> Result<Self, InputError> {
        let mut package = Self::new(bytes)?;
        let levels = package.header.levels.clone();
        let is_end = |level: &PackageLevel| level.chunk.end == bytes.len();
        let count = levels.iter().position(is_end).map_or(levels.len(), |at| at + 1);
        if count == levels.len() && !levels.last().is_some_and(is_end) {
            let reason = "the end of the last chunk; a shorter package must end with a level";
            InputError::check_same("package.len", bytes.len(), package.header.bytes(), reason)?;
        }
        for level in &levels[..count] {
            package.add_level(&bytes[level.chunk.range()])?;
        }
        Ok(package)
    }

    /// The header.
    pub fn header(&self) -> &PackageHeader {
        &self.header
    }

    /// Number of levels that were read.
    pub fn levels(&self) -> usize {
        self.levels
    }

    /// Number of vertices of each mesh at the finest level that was read. Finer levels add vertices behind them.
    pub fn mesh_vertices(&self) -> Vec<usize> {
        self.meshes.iter().map(LeveledMesh::vertices).collect()
    }

    /// Reads the chunk of the next finer level.
    ///
    /// # Errors
    /// [`InputError`] if there is no further level, and for bytes that are not those of the chunk. After damaged bytes with the
    /// hash of the header, the package cannot be read further.
    pub fn add_level(&mut self, bytes: &[u8]) -> Result<(), InputError> {
        let at = self.levels;
        let path = format!("package.levels[{at}]");
        let Some(level) = self.header.levels.get(at) else {
            return Err(InputError::new(path, at, format!("must be below {at}, the number of levels")));
        };
        level.chunk.check(&path, bytes)?;
        // Until the end, a further attempt is refused.
        self.levels = self.header.levels.len();
        let mut reader = Reader::new(bytes).map_err(|error| error.below("package"))?;
        let mut found = [0; 2];
        for mesh in &mut self.meshes {
            mesh.step(at, &mut reader, &mut self.contexts, &mut self.room)
                .map_err(|error| error.below("package"))?;
            found = [found[0] + mesh.vertices(), found[1] + mesh.triangles()];
        }
        if found != [level.vertices, level.triangles] {
            return Err(damaged().below("package"));
        }
        self.levels = at + 1;
        Ok(())
    }

    /// Reads the chunk of the next image.
    ///
    /// # Errors
    /// [`InputError`] if there is no further image, for bytes that are not those of the chunk, and for an image whose size cannot
    /// be read. The image is decoded later ([`Image::texels`]).
    pub fn add_image(&mut self, bytes: &[u8]) -> Result<(), InputError> {
        let path = format!("package.images[{}]", self.images.len());
        let Some(chunk) = self.header.images.get(self.images.len()) else {
            let bound = format!("must be below {}, the number of images", self.header.images.len());
            return Err(InputError::new(path, self.images.len(), bound));
        };
        chunk.check(&path, bytes)?;
        let size = materials::size(&self.budget, &path, bytes)?;
        self.images.push(Image::of_file(bytes.to_vec(), size));
        Ok(())
    }

    /// The model with the levels that were read; at least one. Materials show the images that were read.
    ///
    /// # Errors
    /// [`InputError`] for parts that do not match each other.
    pub fn model(&self) -> Result<Model, InputError> {
        let mut materials = self.parts.materials.clone();
        for material in &mut materials {
            // A texture that is not there yet is not shown.
            let is_missing = |image| (self.images.len()..self.header.images.len()).contains(&image);
            material.map_textures(|texture| Some(texture).filter(|texture| !is_missing(texture.image)));
        }
        let (meshes, quantization) = (self.meshes.iter().zip(&self.parts.meshes), self.header.quantization);
        let mut model = Model {
            skeleton: self.parts.skeleton.clone(),
            skins: self.parts.skins.clone(),
            clips: self.parts.clips.clone(),
            motion: None,
            meshes: meshes.map(|(mesh, parts)| mesh.mesh(parts, quantization)).collect::<Result<_, _>>()?,
            skinned: self.parts.skinned,
            materials,
            images: self.images.clone(),
        };
        model.check().map_err(|error| error.below("package"))?;
        model.motion = self.parts.motion.clone().map(|motion| motion.with_model(&model));
        Ok(model)
    }

    /// SHA-256 of the finest level that was read, as 64 hexadecimal digits. It covers the vertices with all attributes and the
    /// triangles of all meshes.
    ///
    /// # Errors
    /// As [`Package::model`].
    pub fn hash(&self) -> Result<String, InputError> {
        let model = self.model()?;
        let words = model.meshes.iter().flat_map(|mesh| mesh.level_words(0, mesh.vertices() as u32));
        Ok(hash::sha256(&words.collect::<Vec<_>>()))
    }
}

impl Model {
    /// Reads a package from memory: a whole one, or the beginning of one that ends with a level. Then the model has that level
    /// and the coarser ones, and materials show no images that are missing.
    ///
    /// # Errors
    /// [`InputError`] in the cases of [`Package`], and for bytes that are missing or too many.
    pub fn from_rlv(bytes: &[u8]) -> Result<Self, InputError> {
        let mut package = Package::with_levels(bytes)?;
        for image in package.header.images.clone().iter().filter(|image| image.end <= bytes.len()) {
            package.add_image(&bytes[image.range()])?;
        }
        package.model()
    }

    /// Reads a package like [`Model::from_rlv`], but leaves out materials and images.
    pub(super) fn from_rlv_bare(bytes: &[u8]) -> Result<Self, InputError> {
        let mut model = Package::with_levels(bytes)?.model()?;
        model.materials.clear();
        model.meshes.iter_mut().for_each(|mesh| mesh.material = None);
        Ok(model)
    }
}
