//! Joining of several meshes and skins into one mesh and one skin.

use std::collections::HashMap;

use crate::InputError;
use crate::asset::mesh::MAX_VERTICES;
use crate::asset::{Influences, Mesh, MeshLevel, Model, MorphTarget, Skin};

/// The pairs of a bone and an inverse bind matrix that vertices follow. They have no duplicates and are in the order of
/// first use.
#[derive(Default)]
pub(super) struct Union {
    pub bones: Vec<u32>,
    binds: Vec<[f32; 16]>,
    of_pairs: HashMap<(u32, [u32; 16]), u32>,
}

impl Union {
    /// The index in the union for the pair at index `at` of `skin`. The pair is added if it is new.
    fn index(&mut self, skin: &Skin, at: u32) -> u32 {
        let (bone, bind) = (skin.bones[at as usize], skin.inverse_binds[at as usize]);
        *self.of_pairs.entry((bone, bind.map(f32::to_bits))).or_insert_with(|| {
            self.bones.push(bone);
            self.binds.push(bind);
            self.bones.len() as u32 - 1
        })
    }

    /// The skin with all pairs. It has the name of the model's first skin.
    pub fn skin(self, model: &Model) -> Skin {
        let name = model.skins.first().map_or_else(String::new, |skin| skin.name.clone());
        Skin { name, bones: self.bones, inverse_binds: self.binds }
    }
}

/// Whether morph targets move at least one vertex of a mesh.
pub(in crate::ops::skinning) fn morphs(mesh: &Mesh) -> bool {
    mesh.targets.iter().any(|target| !target.vertices.is_empty())
}

/// Joins meshes, keeping the order of vertices and triangles. Expects at least one mesh. If the meshes morph, they must
/// have the same weights. For each mesh, `own` has the mesh's own level at every level of the object. `errors` are the
/// errors of levels 1, 2 ….
pub(super) fn joined(
    model: &Model,
    meshes: &[&Mesh],
    own: &[Vec<u32>],
    errors: &[f32],
    union: &mut Union,
) -> Result<Mesh, InputError> {
    let starts = starts(meshes)?;
    let all = |level: usize| {
        let moved = meshes.iter().zip(own).zip(&starts).flat_map(|((mesh, own), start)| {
            mesh.triangles(own[level]).iter().map(move |vertex| vertex + start)
        });
        moved.collect::<Vec<u32>>()
    };
    let is_new = |level: &usize| own.iter().any(|own| own[*level] != own[*level - 1]);
    let levels = (1..=errors.len()).filter(is_new);
    let first = meshes[0];
    let is_morphed = morphs(first);
    let is_same = meshes.iter().all(|mesh| mesh.material == first.material);
    Ok(Mesh {
        name: first.name.clone(),
        skin: 0,
        positions: concatenated(meshes, |mesh| &mesh.positions),
        normals: concatenated(meshes, |mesh| &mesh.normals),
        tangents: concatenated(meshes, |mesh| &mesh.tangents),
        uv: concatenated(meshes, |mesh| &mesh.uv),
        indices: all(0),
        double_sided: meshes.iter().any(|mesh| mesh.double_sided),
        material: first.material.filter(|_| is_same),
        influences: influences(model, meshes, union),
        targets: if is_morphed { targets(meshes, &starts) } else { Vec::new() },
        weights: if is_morphed { first.weights.clone() } else { Vec::new() },
        weight_keys: if is_morphed { first.weight_keys.clone() } else { Vec::new() },
        error: meshes.iter().map(|mesh| mesh.error).fold(0.0, f32::max),
        levels: levels.map(|level| MeshLevel { indices: all(level), error: errors[level - 1] }).collect(),
        partners: partners(meshes, own, &starts),
        // Scenes do not draw these.
        second_uv: Vec::new(),
        colors: Vec::new(),
    })
}

/// For each mesh, the index of its first vertex in the joined mesh.
fn starts(meshes: &[&Mesh]) -> Result<Vec<u32>, InputError> {
    let vertices: usize = meshes.iter().map(|mesh| mesh.vertices()).sum();
    let bound = || format!("must be at most {MAX_VERTICES} in all meshes that are merged");
    InputError::check(vertices <= MAX_VERTICES, "model.meshes.positions.len", vertices, bound)?;
    let mut next = 0;
    let start = |mesh: &&Mesh| {
        next += mesh.vertices() as u32;
        next - mesh.vertices() as u32
    };
    Ok(meshes.iter().map(start).collect())
}

/// The partners of all vertices: the vertices that replace them at coarser levels. A mesh's own level is skipped if no
/// level of the object uses it. The result is empty if a mesh has levels but no partners.
fn partners(meshes: &[&Mesh], own: &[Vec<u32>], starts: &[u32]) -> Vec<u32> {
    let is_lacking = |mesh: &&Mesh| mesh.partners.is_empty() && !mesh.levels.is_empty();
    if meshes.iter().any(is_lacking) || meshes.iter().all(|mesh| mesh.partners.is_empty()) {
        return Vec::new();
    }
    let of_mesh = |((mesh, own), start): ((&&Mesh, &Vec<u32>), &u32)| {
        let coarsest = mesh.coarsest_levels();
        let partner = |vertex: u32| {
            let Some(next) = own.iter().find(|level| **level > coarsest[vertex as usize]) else {
                return vertex;
            };
            let mut partner = vertex;
            // A chain of partners leads to coarser levels. It ends at a vertex that is its own partner
            // (`Mesh::validate`).
            while coarsest[partner as usize] < *next && mesh.partners[partner as usize] != partner {
                partner = mesh.partners[partner as usize];
            }
            partner
        };
        let known = 0..mesh.vertices() as u32;
        let partner = |vertex: u32| start + if mesh.partners.is_empty() { vertex } else { partner(vertex) };
        known.map(partner).collect::<Vec<u32>>()
    };
    meshes.iter().zip(own).zip(starts).flat_map(of_mesh).collect()
}

fn concatenated<T: Copy>(meshes: &[&Mesh], of: impl Fn(&Mesh) -> &[T]) -> Vec<T> {
    meshes.iter().flat_map(|mesh| of(mesh)).copied().collect()
}

fn influences(model: &Model, meshes: &[&Mesh], union: &mut Union) -> Influences {
    let mut all = Influences::default();
    for mesh in meshes {
        let skin = &model.skins[mesh.skin];
        all.append(&mesh.influences, |bone| union.index(skin, bone));
    }
    all
}

/// For each morph target, the displaced vertices of all meshes.
fn targets(meshes: &[&Mesh], starts: &[u32]) -> Vec<MorphTarget> {
    let target = |target: usize| {
        let mut all = MorphTarget::default();
        for (mesh, start) in meshes.iter().zip(starts) {
            let of_mesh = &mesh.targets[target];
            all.vertices.extend(of_mesh.vertices.iter().map(|vertex| vertex + start));
            all.deltas.extend(&of_mesh.deltas);
        }
        all
    };
    (0..meshes[0].targets.len()).map(target).collect()
}
