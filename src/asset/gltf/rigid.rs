//! Meshes without a skin: each follows the lowest node above it that may move, as a whole.

use glam::{DMat4, DQuat, DVec3};
use gltf_json::animation::Property;
use gltf_json::validation::Checked;

use super::document::Document;
use super::nodes::rest;
use crate::InputError;
use crate::asset::skeleton::inverse_bind;

/// A node with a mesh and no skin.
pub struct Rigid {
    pub node: usize,
    /// The node that it follows: itself, or one above it. It has to be a bone.
    pub anchor: usize,
    /// From the mesh's space into the anchor's.
    pub bind: [f32; 16],
    /// Whether it is turned outside in, at rest: glTF then turns its triangles round.
    pub is_mirrored: bool,
}

/// All of them, in the order of the nodes. An anchor is a joint, a node above joints, or an animated one; else a root.
pub fn rigid(
    document: &Document<'_>,
    parents: &[Option<usize>],
    joints: &[usize],
) -> Result<Vec<Rigid>, InputError> {
    // What Draco compressed has no vertices here.
    if document.is_draco {
        return Ok(Vec::new());
    }
    let nodes = &document.root.nodes;
    let movable = movable(document, parents, joints);
    let is_rigid = |node: &usize| nodes[*node].mesh.is_some() && nodes[*node].skin.is_none();
    (0..nodes.len()).filter(is_rigid).map(|node| follow(document, parents, &movable, node)).collect()
}

fn movable(document: &Document<'_>, parents: &[Option<usize>], joints: &[usize]) -> Vec<bool> {
    let mut movable = vec![false; parents.len()];
    for joint in joints {
        let mut next = Some(*joint);
        while let Some(node) = next.filter(|node| !std::mem::replace(&mut movable[*node], true)) {
            next = parents[node];
        }
    }
    for channel in document.root.animations.iter().flat_map(|animation| &animation.channels) {
        let is_of_weights = channel.target.path == Checked::Valid(Property::MorphTargetWeights);
        if let Some(node) = movable.get_mut(channel.target.node.value()).filter(|_| !is_of_weights) {
            *node = true;
        }
    }
    movable
}

fn follow(
    document: &Document<'_>,
    parents: &[Option<usize>],
    movable: &[bool],
    node: usize,
) -> Result<Rigid, InputError> {
    let (mut anchor, mut bind, mut is_mirrored) = (None, DMat4::IDENTITY, false);
    let mut above = node;
    // Who is its own ancestor has more than there are nodes.
    for _ in 0..parents.len() {
        let local = local(document, above)?;
        if anchor.is_none() && (movable[above] || parents[above].is_none()) {
            anchor = Some(above);
        }
        if anchor.is_none() {
            bind = local * bind;
        }
        is_mirrored ^= local.determinant() < 0.0;
        match (parents[above], anchor) {
            (Some(parent), _) => above = parent,
            (None, Some(anchor)) => {
                let bind = bind.to_cols_array().map(|x| x as f32);
                inverse_bind(&format!("nodes[{node}].matrix"), &bind)?;
                return Ok(Rigid { node, anchor, bind, is_mirrored });
            }
            (None, None) => break,
        }
    }
    let bound = "must not lie below itself: nodes are trees";
    Err(InputError::new(format!("nodes[{node}]"), node, bound))
}

/// A node's matrix as the file has it, sheared or not, or the product of its parts.
fn local(document: &Document<'_>, node: usize) -> Result<DMat4, InputError> {
    if let Some(matrix) = &document.root.nodes[node].matrix {
        inverse_bind(&format!("nodes[{node}].matrix"), matrix)?;
        return Ok(DMat4::from_cols_array(&matrix.map(f64::from)));
    }
    let rest = rest(node, &document.root.nodes[node])?;
    let rotation = DQuat::from_array(rest.rotation.map(f64::from)).normalize();
    let [scale, translation] = [rest.scale, rest.translation].map(|all| DVec3::from(all.map(f64::from)));
    Ok(DMat4::from_scale_rotation_translation(scale, rotation, translation))
}
