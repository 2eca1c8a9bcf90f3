//! Parts of a merged model: sets of meshes that are drawn with one pipeline.

use crate::InputError;
use crate::asset::material::{Alpha, Sampling};
use crate::asset::{Material, Mesh, Model};

/// The largest number of parts per object, unless morphed or blended meshes need more.
pub const MAX_PARTS: usize = 4;

/// The draw state that all meshes of a part share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartKey {
    /// Whether pixels are cut out by their alpha: [`Alpha::Mask`] or [`Alpha::Dithered`].
    pub cut_out: bool,
    /// Whether the part is blended with the background: [`Alpha::Blended`].
    pub blended: bool,
    /// Whether triangles are visible from both sides.
    pub double_sided: bool,
    /// Sampling of the base colour textures; `None` without base colour textures.
    pub sampling: Option<Sampling>,
    /// Sampling of the normal maps; `None` without normal maps.
    pub normal_sampling: Option<Sampling>,
}

impl PartKey {
    /// The draw state of one mesh of a model.
    ///
    /// # Errors
    /// The same errors as [`Model::material`].
    pub fn of(model: &Model, mesh: &Mesh) -> Result<Self, InputError> {
        let material = model.material(mesh)?;
        let alpha = material.map_or(Alpha::Opaque, |Material { alpha, .. }| *alpha);
        Ok(Self {
            cut_out: matches!(alpha, Alpha::Mask(_) | Alpha::Dithered),
            blended: alpha == Alpha::Blended,
            double_sided: mesh.double_sided,
            sampling: material.and_then(|material| material.texture).map(|texture| texture.sampling),
            normal_sampling: material.and_then(|material| material.normal).map(|texture| texture.sampling),
        })
    }

    /// Whether meshes with the key `other` can join a part with this key without losing a texture sampling.
    fn covers(&self, other: &Self) -> bool {
        let covers = |own: Option<Sampling>, other: Option<Sampling>| other.is_none() || own == other;
        covers(self.sampling, other.sampling) && covers(self.normal_sampling, other.normal_sampling)
    }
}

/// A part under construction: meshes with the same draw state.
pub(super) struct Sorted {
    /// Index of the group of meshes that are merged into one mesh.
    pub group: usize,
    pub key: PartKey,
    /// Indices of the part's meshes in the model, ascending; at least one.
    pub meshes: Vec<usize>,
}

impl Sorted {
    /// The sum of the meshes' triangle indices, each mesh at its fullest level.
    fn triangles(&self, model: &Model) -> usize {
        let most = |mesh: &usize| model.meshes[*mesh].all_triangles().map(<[u32]>::len).max().unwrap_or(0);
        self.meshes.iter().map(most).sum()
    }

    fn is_beside(&self, other: &Self) -> bool {
        let pair = |part: &Self| {
            let PartKey { cut_out, blended, double_sided, .. } = part.key;
            (part.group, cut_out, blended, double_sided)
        };
        pair(self) == pair(other)
    }
}

/// Sorts the meshes of all groups into parts. Parts of one group are adjacent. `keys` has the draw state of every mesh
/// of the model.
pub(super) fn parts(model: &Model, groups: &[Vec<usize>], keys: &[PartKey]) -> Vec<Sorted> {
    let mut parts: Vec<Sorted> = Vec::new();
    for (group, meshes) in groups.iter().enumerate() {
        for mesh in meshes {
            let key = keys[*mesh];
            match parts.iter_mut().find(|part| part.group == group && part.key == key) {
                Some(part) => part.meshes.push(*mesh),
                None => parts.push(Sorted { group, key, meshes: vec![*mesh] }),
            }
        }
    }
    let covers = |part: &Sorted, given: &Sorted| part.is_beside(given) && part.key.covers(&given.key);
    while let Some(least) = (0..parts.len()).find(|at| has_other(&parts, *at, covers)) {
        give_up(model, &mut parts, least, covers);
    }
    while parts.len() > MAX_PARTS {
        let others = (0..parts.len()).filter(|at| has_other(&parts, *at, Sorted::is_beside));
        let Some(least) = others.min_by_key(|at| parts[*at].triangles(model)) else { break };
        give_up(model, &mut parts, least, Sorted::is_beside);
    }
    parts
}

/// Whether the part at `at` can be merged into at least one other part.
fn has_other(parts: &[Sorted], at: usize, fits: impl Fn(&Sorted, &Sorted) -> bool) -> bool {
    parts.iter().enumerate().any(|(other, part)| other != at && fits(part, &parts[at]))
}

/// Merges the part at `at` into the fitting part with the most triangles. Among equals, the first is taken. If that
/// part lacks a texture sampling, it gets the sampling of the part at `at`.
fn give_up(model: &Model, parts: &mut Vec<Sorted>, at: usize, fits: impl Fn(&Sorted, &Sorted) -> bool) {
    let given = parts.remove(at);
    let mut most: Option<&mut Sorted> = None;
    for part in parts.iter_mut().filter(|part| fits(part, &given)) {
        if most.as_ref().is_none_or(|most| part.triangles(model) > most.triangles(model)) {
            most = Some(part);
        }
    }
    if let Some(most) = most {
        most.key.sampling = most.key.sampling.or(given.key.sampling);
        most.key.normal_sampling = most.key.normal_sampling.or(given.key.normal_sampling);
        most.meshes.extend(given.meshes);
        most.meshes.sort_unstable();
    }
}
