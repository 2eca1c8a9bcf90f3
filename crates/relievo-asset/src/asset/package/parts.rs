//! The parts of a model that have no levels of detail: skeleton, skins, clips, materials, and the fields of meshes without
//! vertices. They are stored with serde and compressed by deflate.

use serde::{Deserialize, Serialize};

use super::attributes::Grids;
use super::surface::Partners;
use crate::InputError;
use crate::asset::{Clip, Material, Mesh, Model, MotionBounds, Skeleton, Skin, WeightKeys};

/// Number of bytes that any chunk may unpack to, and that each of its bytes adds.
const UNPACKED: usize = 1 << 20;
const UNPACKED_A_BYTE: usize = 4;

/// Compression level of deflate: the best.
const BEST: u8 = 10;

/// A model without vertices, triangles and images.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Parts {
    pub skeleton: Skeleton,
    pub skins: Vec<Skin>,
    pub clips: Vec<Clip>,
    /// Bounds without the model that they were computed from.
    pub motion: Option<MotionBounds>,
    pub skinned: usize,
    pub materials: Vec<Material>,
    pub meshes: Vec<MeshParts>,
}

/// A mesh without vertices and triangles.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct MeshParts {
    name: String,
    skin: usize,
    double_sided: bool,
    material: Option<usize>,
    weights: Vec<f32>,
    weight_keys: Vec<(usize, WeightKeys)>,
    pub partners: Partners,
    pub grids: Grids,
    /// Errors of the mesh's own levels 1, 2 …
    pub errors: Vec<f32>,
    /// For each level of the package, the number of the mesh's own levels in its chunk.
    pub steps: Vec<u32>,
}

impl Parts {
    pub fn of(model: &Model, meshes: Vec<MeshParts>) -> Self {
        Self {
            skeleton: model.skeleton.clone(),
            skins: model.skins.clone(),
            clips: model.clips.clone(),
            motion: model.motion.clone().map(MotionBounds::unbound),
            skinned: model.skinned,
            materials: model.materials.clone(),
            meshes,
        }
    }

    /// The bytes of a chunk.
    pub fn packed(&self) -> Result<Vec<u8>, InputError> {
        let bytes = postcard::to_allocvec(self).map_err(|error| {
            InputError::new("package.model", "parts", format!("cannot be written: {error}"))
        })?;
        let packed = miniz_oxide::deflate::compress_to_vec(&bytes, BEST);
        // A reader refuses what unpacks to too much.
        Ok(match bytes.len() <= most_unpacked(packed.len()) {
            true => packed,
            false => miniz_oxide::deflate::compress_to_vec(&bytes, 0),
        })
    }

    /// Reads the bytes of a chunk. What serde reads is checked in itself, but skins, clips and materials may not fit together.
    pub fn unpacked(bytes: &[u8]) -> Result<Self, InputError> {
        let refused =
            |bound: String| InputError::new("package.model", format!("[{} bytes]", bytes.len()), bound);
        let most = most_unpacked(bytes.len());
        let unpacked = miniz_oxide::inflate::decompress_to_vec_with_limit(bytes, most)
            .map_err(|error| refused(format!("cannot be unpacked to at most {most} bytes: {error}")))?;
        postcard::from_bytes(&unpacked).map_err(|error| refused(format!("cannot be read: {error}")))
    }
}

fn most_unpacked(bytes: usize) -> usize {
    UNPACKED + UNPACKED_A_BYTE * bytes
}

impl MeshParts {
    pub fn of(mesh: &Mesh, steps: Vec<u32>) -> Self {
        Self {
            name: mesh.name.clone(),
            skin: mesh.skin,
            double_sided: mesh.double_sided,
            material: mesh.material,
            weights: mesh.weights.clone(),
            weight_keys: mesh.weight_keys.clone(),
            partners: if mesh.partners.is_empty() { Partners::Unknown } else { Partners::Known },
            grids: Grids::of(mesh),
            errors: mesh.levels.iter().map(|level| level.error).collect(),
            steps,
        }
    }

    /// Number of morph targets.
    pub fn targets(&self) -> usize {
        self.weights.len()
    }

    /// Number of bones of the mesh's skin.
    pub fn bones(&self, skins: &[Skin]) -> Result<usize, InputError> {
        InputError::check_below("mesh.skin", self.skin, skins.len())?;
        Ok(skins[self.skin].bones.len())
    }

    /// A mesh without vertices and triangles.
    pub fn mesh(&self) -> Mesh {
        Mesh {
            name: self.name.clone(),
            skin: self.skin,
            double_sided: self.double_sided,
            material: self.material,
            weights: self.weights.clone(),
            weight_keys: self.weight_keys.clone(),
            ..Mesh::default()
        }
    }
}
