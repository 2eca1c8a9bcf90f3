//! Writes the meshes of a document: primitives with attributes, influences and morph targets.

use std::ops::Range;

use serde_json::{Value, json};

use super::super::primitive::flipped;
use super::super::winding::turn_mirrored;
use super::binary::Binary;
use crate::asset::morph::MorphTarget;
use crate::asset::{Influences, Mesh, Model};

/// Consecutive meshes of a model that become the primitives of one node.
pub(super) struct Group {
    /// The node's name.
    pub name: String,
    /// Range of these meshes in the model.
    pub meshes: Range<usize>,
    /// Whether the node has a skin. Without a skin, the node follows one bone.
    pub is_skinned: bool,
}

/// Groups a model's meshes into nodes. Meshes of a group share a skin and have equal morph weights. Their names follow the
/// import's pattern for primitives: a common name, followed by numbers from 0. Meshes of coarser levels are left out.
pub(super) fn groups(model: &Model) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let finest = model.meshes.iter().enumerate().filter(|(_, mesh)| !mesh.is_of_coarse_levels());
    for (at, mesh) in finest {
        let is_skinned = at < model.skinned || model.skins[mesh.skin].bones.len() != 1;
        let parts =
            mesh.name.rsplit_once('_').and_then(|(name, number)| Some((name, number.parse::<usize>().ok()?)));
        if let (Some(group), Some((name, number))) = (groups.last_mut(), parts) {
            let first = &model.meshes[group.meshes.start];
            let is_next =
                number == group.meshes.len() && group.meshes.end == at && number > 0 && name == group.name;
            let is_alike = (first.skin, &first.weights) == (mesh.skin, &mesh.weights)
                && first.weight_keys == mesh.weight_keys
                && group.is_skinned == is_skinned;
            if is_next && is_alike {
                group.meshes.end = at + 1;
                continue;
            }
        }
        let name = match parts {
            Some((name, 0)) => name,
            _ => &mesh.name,
        };
        groups.push(Group { name: name.to_owned(), meshes: at..at + 1, is_skinned });
    }
    groups
}

/// Writes a primitive. `mirrors` says which bones of its skin mirror. Triangles that follow such bones are reversed in the
/// file, because the import reverses them back.
pub(super) fn primitive(
    mesh: &Mesh,
    is_skinned: bool,
    mirrors: &[bool],
    material: Option<usize>,
    binary: &mut Binary,
) -> Value {
    let mut attributes = json!({ "POSITION": binary.floats(&mesh.positions, true) });
    attributes["NORMAL"] = binary.floats(&mesh.normals, false).into();
    let tangents: Vec<_> = mesh.tangents.iter().map(|tangent| flipped(*tangent)).collect();
    attributes["TANGENT"] = binary.floats(&tangents, false).into();
    attributes["TEXCOORD_0"] = binary.floats(&mesh.uv, false).into();
    if !mesh.second_uv.is_empty() {
        attributes["TEXCOORD_1"] = binary.floats(&mesh.second_uv, false).into();
    }
    if !mesh.colors.is_empty() {
        attributes["COLOR_0"] = binary.floats(&mesh.colors, false).into();
    }
    if is_skinned {
        add_influences(&mesh.influences, &mut attributes, binary);
    }
    let mut turned = Mesh { levels: Vec::new(), targets: Vec::new(), ..mesh.clone() };
    turn_mirrored(&mut turned, mirrors);
    let mut primitive = json!({ "attributes": attributes, "indices": binary.indices(&turned.indices) });
    if let Some(material) = material {
        primitive["material"] = material.into();
    }
    if !mesh.targets.is_empty() {
        let targets = mesh.targets.iter().map(|target| morph_target(target, mesh.vertices(), binary));
        primitive["targets"] = targets.collect();
    }
    primitive
}

/// Adds as many sets of four joints and weights as the vertex with the most influences needs.
fn add_influences(influences: &Influences, attributes: &mut Value, binary: &mut Binary) {
    for set in 0..influences.most().div_ceil(4).max(1) {
        let of = |vertex: usize, at: usize| influences.of(vertex).get(4 * set + at);
        let vertices = 0..influences.vertices();
        let joints: Vec<[u16; 4]> = vertices
            .clone()
            .map(|vertex| [0, 1, 2, 3].map(|at| of(vertex, at).map_or(0, |influence| influence.bone as u16)))
            .collect();
        let weights: Vec<[f32; 4]> = vertices
            .map(|vertex| [0, 1, 2, 3].map(|at| of(vertex, at).map_or(0.0, |influence| influence.weight)))
            .collect();
        attributes[format!("JOINTS_{set}")] = binary.joints(&joints).into();
        attributes[format!("WEIGHTS_{set}")] = binary.floats(&weights, false).into();
    }
}

/// Writes a morph target, with one displacement per vertex of the mesh.
fn morph_target(target: &MorphTarget, vertices: usize, binary: &mut Binary) -> Value {
    let mut all = [(); 3].map(|()| vec![[0.0_f32; 3]; vertices]);
    for (vertex, delta) in target.vertices.iter().zip(&target.deltas) {
        let deltas = [delta.position, delta.normal, delta.tangent];
        all.iter_mut().zip(deltas).for_each(|(all, delta)| all[*vertex as usize] = delta);
    }
    let [positions, normals, tangents] = all;
    json!({
        "POSITION": binary.floats(&positions, true),
        "NORMAL": binary.floats(&normals, false),
        "TANGENT": binary.floats(&tangents, false),
    })
}
