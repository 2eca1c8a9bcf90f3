//! Merges the meshes of a model, so that an object takes few draws however many primitives its file has: one mesh
//! with the vertices of all of them, one skin, and for each level of detail the triangles sorted by what a draw must
//! have in common.

mod joined;
mod parts;

use std::ops::Range;

use super::character_levels::{level_errors_within, own_levels};
use crate::InputError;
use crate::asset::Model;
use joined::{Union, joined};

pub use parts::{MAX_PARTS, PartKey};

/// The largest number of draws of an object: parts × levels × 2, since mirrored instances have draws of their own.
pub const MAX_DRAWS: usize = 64;

/// A model whose meshes are merged.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// The model, with the skeleton, clips, materials and images that it had, one skin, and the merged meshes. It has
    /// one mesh, and one more for each set of morph weights. They are drawn part by part: the `material` of a mesh is
    /// only set where all of it has the same, and it is double-sided if any of it is.
    pub model: Model,
    /// The errors of its levels 1, 2 … in the model's units, ascending; they are the
    /// [`level_errors`](super::level_errors) of the merged meshes, whose [`own_levels`] tell what they use at each
    /// level.
    pub errors: Vec<f32>,
    /// For each mesh, the material of each of its vertices, as an index in the model.
    pub materials: Vec<Vec<Option<usize>>>,
    /// For each mesh, the mesh of the model from which each of its vertices comes, as an index.
    pub sources: Vec<Vec<u32>>,
    /// What is drawn at once. Every triangle belongs to one part.
    pub parts: Vec<Part>,
}

/// Triangles of a merged mesh that one pipeline draws.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Index of the mesh in the merged model.
    pub mesh: usize,
    /// What its triangles have in common.
    pub key: PartKey,
    /// For each level of the object, level 0 included, the part's indices among those of the mesh's own level there
    /// ([`Mesh::triangles`](crate::asset::Mesh::triangles) of [`own_levels`]).
    pub indices: Vec<Range<u32>>,
}

/// Merges the meshes of a model, with at most `levels` levels of detail, level 0 included.
///
/// Drawing the merged model is drawing the meshes of the model: at full detail they have the same triangles, whose
/// vertices have the same positions, normals and tangents to the bit, in every pose. At a level, each mesh
/// contributes the own level that [`own_levels`] gives it. A vertex keeps the order and the weights of its
/// influences, which name the bones of one skin: all pairs of a bone and an inverse bind matrix that any vertex
/// follows. Meshes without triangles are left out.
///
/// Meshes that morph targets move are merged with those that have the same weights in every clip, and stay meshes of
/// their own otherwise. Parts differ in their [`PartKey`]. There are at most [`MAX_PARTS`] of them, or one or two for
/// each merged mesh and use of alpha if these are more: samplings are given up until then, those with the fewest
/// triangles first, in favour of the one that has most triangles of the same mesh, alpha and sides. A mesh that
/// lacks textures or normal maps joins any sampling of these. Should there be so many morphed meshes that draws exceed [`MAX_DRAWS`], there are
/// fewer levels, at least one.
///
/// # Errors
/// [`InputError`] for a mesh or a skin that does not match the model, for a material or an image that the model
/// lacks, and for more vertices in all than a mesh may have.
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

/// The key of a mesh that matches its model.
fn checked(model: &Model, mesh: usize) -> Result<PartKey, InputError> {
    model.check_mesh(mesh)?;
    model.check_material(mesh)?;
    PartKey::of(model, &model.meshes[mesh])
}

/// A model without its meshes and skins.
fn bare(model: &Model) -> Model {
    Model {
        skeleton: model.skeleton.clone(),
        skins: Vec::new(),
        clips: model.clips.clone(),
        meshes: Vec::new(),
        skinned: 0,
        materials: model.materials.clone(),
        images: model.images.clone(),
    }
}

/// The meshes that have triangles, each group those that may become one: all that no morph target moves, and for each
/// set of morph weights those that it moves.
fn groups(model: &Model) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (at, mesh) in model.meshes.iter().enumerate().filter(|(_, mesh)| !mesh.indices.is_empty()) {
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
    /// Adds the mesh that a group of meshes becomes; `parts` are all parts of the group.
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
        let each = |mesh: &&crate::asset::Mesh| std::iter::repeat_n(mesh.material, mesh.vertices());
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
