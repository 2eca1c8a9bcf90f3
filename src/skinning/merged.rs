//! Merging of a model's meshes, so that an object needs few draws even if its file has many primitives. The result is
//! one mesh with all vertices, one skin, and triangles sorted by draw state for each level of detail.

mod joined;
mod parts;

use std::ops::Range;

use super::character_levels::{level_errors_within, own_levels};
use crate::InputError;
use crate::asset::{Mesh, Model};
pub(super) use joined::morphs;
use joined::{Union, joined};

pub use parts::{MAX_PARTS, PartKey};

/// The largest number of draws per object: parts × levels × 2. The factor 2 is for mirrored instances, which are drawn
/// separately.
pub const MAX_DRAWS: usize = 64;

/// A model whose meshes are merged, and the parts in which it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// The merged model: the original skeleton, clips, materials and images, one skin, and the merged meshes.
    ///
    /// There is one merged mesh for all meshes without morph targets, and one for each set of morph weights. Each is
    /// drawn in parts. The `material` of a merged mesh is set only if all of its triangles have the same material. A
    /// merged mesh is double-sided if any of its meshes is.
    pub model: Model,
    /// The errors of levels 1, 2 … in the model's units, ascending: the [`level_errors`](super::level_errors) of the
    /// merged meshes. [`own_levels`] gives the level of each mesh at these errors.
    pub errors: Vec<f32>,
    /// For each merged mesh, the material of each of its vertices, as an index in the model.
    pub materials: Vec<Vec<Option<usize>>>,
    /// For each merged mesh, the index of the original mesh of each of its vertices.
    pub sources: Vec<Vec<u32>>,
    /// The parts of the merged meshes; one draw per part and level. Every triangle belongs to one part.
    pub parts: Vec<Part>,
}

/// Triangles of a merged mesh that are drawn with one pipeline.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Index of the part's mesh in the merged model.
    pub mesh: usize,
    /// The draw state of all of the part's triangles.
    pub key: PartKey,
    /// The part's range of indices at each level of the object, level 0 included. The range refers to the indices of
    /// the mesh's own level ([`Mesh::triangles`](crate::asset::Mesh::triangles) of [`own_levels`]).
    pub indices: Vec<Range<u32>>,
}

/// Merges the meshes of a model. The result has at most `levels` levels of detail, level 0 included.
///
/// Drawing the merged model is equivalent to drawing the model's meshes. At full detail, it has the same triangles with
/// the same positions, normals and tangents to the bit, in every pose. At coarser levels, each mesh contributes its own
/// level from [`own_levels`]. Vertices keep the order and weights of their influences. The one skin has every pair of a
/// bone and an inverse bind matrix that a vertex follows. Meshes without triangles at any level are left out.
///
/// Meshes with morph targets are merged only with meshes that have the same morph weights in every clip. Parts differ
/// in their [`PartKey`]. There are at most [`MAX_PARTS`] parts, unless the merged meshes need more. Each use of alpha
/// in a merged mesh needs one part, or two if only some of its triangles are double-sided. To stay within
/// [`MAX_PARTS`], the parts with the fewest triangles give up their texture sampling. They get the sampling of the
/// largest part with the same mesh, alpha and sides. A mesh without textures or normal maps joins a part with any
/// sampling. If many morphed meshes would exceed [`MAX_DRAWS`], there are fewer levels, but at least one.
///
/// # Errors
/// [`InputError`] if a mesh or skin does not match the model, if the model lacks a material or image that it names, or
/// if all meshes together have more vertices than a mesh may have.
pub fn merged(model: &Model, levels: usize) -> Result<Merged, InputError> {
    let keys = (0..model.meshes.len()).map(|mesh| checked(model, mesh)).collect::<Result<Vec<_>, _>>()?;
    let groups = groups(model);
    let parts = parts::parts(model, &groups, &keys);
    let draws = 2 * parts.len().max(1);
    let errors = level_errors_within(&model.meshes, levels.min(MAX_DRAWS / draws));
    let mut merged =
        Merged { model: bare(model), errors, materials: Vec::new(), sources: Vec::new(), parts: Vec::new() };
    let mut union = Union::default();
    for group in 0..groups.len() {
        merged.add(model, &mut union, parts.iter().filter(|part| part.group == group))?;
    }
    if !union.bones.is_empty() {
        merged.model.skins.push(union.skin(model));
    }
    merged.model.skinned = groups.iter().filter(|group| group[0] < model.skinned).count();
    merged.model.meshes.iter().try_for_each(|mesh| mesh.validate(&merged.model.skins))?;
    Ok(merged)
}

/// Checks a mesh against its model, and returns the mesh's draw state.
fn checked(model: &Model, mesh: usize) -> Result<PartKey, InputError> {
    model.check_mesh(mesh)?;
    model.check_material(mesh)?;
    PartKey::of(model, &model.meshes[mesh])
}

/// A copy of a model without meshes and skins.
fn bare(model: &Model) -> Model {
    Model {
        skeleton: model.skeleton.clone(),
        skins: Vec::new(),
        clips: model.clips.clone(),
        motion: None,
        meshes: Vec::new(),
        skinned: 0,
        materials: model.materials.clone(),
        images: model.images.clone(),
    }
}

/// Whether a mesh has a triangle at any level.
fn has_triangles(mesh: &Mesh) -> bool {
    mesh.all_triangles().any(|triangles| !triangles.is_empty())
}

/// Groups of meshes that may be merged. Meshes without morph targets form one group. Meshes with morph targets form one
/// group per set of morph weights. Meshes without triangles are left out.
fn groups(model: &Model) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (at, mesh) in model.meshes.iter().enumerate().filter(|(_, mesh)| has_triangles(mesh)) {
        let fits = |group: &&mut Vec<usize>| {
            let other = &model.meshes[group[0]];
            match (joined::morphs(mesh), joined::morphs(other)) {
                (false, false) => true,
                (true, true) => (&mesh.weights, &mesh.weight_keys) == (&other.weights, &other.weight_keys),
                _ => false,
            }
        };
        match groups.iter_mut().find(fits) {
            Some(group) => group.push(at),
            None => groups.push(vec![at]),
        }
    }
    groups
}

impl Merged {
    /// Adds the merged mesh of a group of meshes. `parts` are all parts of this group.
    fn add<'a>(
        &mut self,
        model: &Model,
        union: &mut Union,
        parts: impl Iterator<Item = &'a parts::Sorted> + Clone,
    ) -> Result<(), InputError> {
        let sources: Vec<usize> = parts.clone().flat_map(|part| part.meshes.iter().copied()).collect();
        let meshes: Vec<_> = sources.iter().map(|mesh| &model.meshes[*mesh]).collect();
        let own: Vec<Vec<u32>> = meshes.iter().map(|mesh| own_levels(mesh, &self.errors)).collect();
        let mesh = joined(model, &meshes, &own, &self.errors, union)?;
        let each = |mesh: &&Mesh| std::iter::repeat_n(mesh.material, mesh.vertices());
        self.materials.push(meshes.iter().flat_map(each).collect());
        let all = sources.iter().zip(&meshes);
        let own_source = all.flat_map(|(at, mesh)| std::iter::repeat_n(*at as u32, mesh.vertices()));
        self.sources.push(own_source.collect());
        let mut begins = vec![0_u32; self.errors.len() + 1];
        let mut first = 0;
        for part in parts {
            let own = &own[first..][..part.meshes.len()];
            let members = &meshes[first..][..part.meshes.len()];
            let range = |(level, begin): (usize, &mut u32)| {
                let len: usize =
                    members.iter().zip(own).map(|(mesh, own)| mesh.triangles(own[level]).len()).sum();
                let start = *begin;
                *begin += len as u32;
                start..*begin
            };
            let indices = begins.iter_mut().enumerate().map(range).collect();
            self.parts.push(Part { mesh: self.model.meshes.len(), key: part.key, indices });
            first += part.meshes.len();
        }
        self.model.meshes.push(mesh);
        Ok(())
    }

    /// Number of levels of detail, level 0 included.
    pub fn levels(&self) -> usize {
        self.errors.len() + 1
    }
}
