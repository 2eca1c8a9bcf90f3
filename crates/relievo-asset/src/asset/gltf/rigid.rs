//! Meshes without a skin. Such a mesh follows one node as a whole: the lowest node that may move, at or above the mesh's node.

use glam::DMat4;
use gltf_json::Root;

use super::nodes::rest;
use super::scene::Scene;
use crate::InputError;
use crate::asset::skeleton::inverse_bind;

/// A node with a mesh and no skin.
pub struct Rigid {
    pub node: usize,
    /// Node that the mesh follows: the mesh's own node or an ancestor. This node must become a bone.
    pub anchor: usize,
    /// Matrix from the mesh's space to the anchor's space, column-major.
    pub bind: [f32; 16],
}

/// Returns all nodes of the scene with a mesh but no skin, in the order of the nodes. The anchor of such a node is the lowest
/// node, at or above it, that is a joint, an ancestor of joints, or animated; otherwise it is the root of the tree.
pub fn rigid(
    root: &Root,
    scene: &Scene,
    joints: &[usize],
    animated: &[bool],
) -> Result<Vec<Rigid>, InputError> {
    let is_rigid = |node: &usize| {
        let of_node = &root.nodes[*node];
        scene.contains[*node] && of_node.mesh.is_some() && of_node.skin.is_none()
    };
    let nodes: Vec<usize> = (0..root.nodes.len()).filter(is_rigid).collect();
    let above_joints = scene.with_ancestors(joints);
    let followed = Followed::new(root, scene, &scene.with_ancestors(&nodes), |node| {
        above_joints[node] || animated[node] || scene.parents[node].is_none()
    })?;
    nodes.into_iter().map(|node| followed.rigid(node)).collect()
}

/// For each node, its anchor, and the matrix from the node's space to the anchor's space.
struct Followed(Vec<Option<(usize, DMat4)>>);

impl Followed {
    /// Finds the anchors of the nodes in `wanted`. This set must contain all ancestors of its nodes.
    fn new(
        root: &Root,
        scene: &Scene,
        wanted: &[bool],
        is_anchor: impl Fn(usize) -> bool,
    ) -> Result<Self, InputError> {
        let mut followed = Self(vec![None; wanted.len()]);
        let mut waiting: Vec<usize> =
            (0..wanted.len()).filter(|node| wanted[*node] && scene.parents[*node].is_none()).collect();
        while let Some(node) = waiting.pop() {
            let local = local(root, node)?;
            let above = scene.parents[node].and_then(|parent| followed.0[parent]);
            followed.0[node] = Some(match above {
                Some((anchor, bind)) if !is_anchor(node) => (anchor, bind * local),
                _ => (node, DMat4::IDENTITY),
            });
            waiting.extend(scene.children(&root.nodes, node).filter(|child| wanted[*child]));
        }
        Ok(followed)
    }

    fn rigid(&self, node: usize) -> Result<Rigid, InputError> {
        let (anchor, bind) = self.0[node].unwrap_or((node, DMat4::IDENTITY));
        let bind = bind.to_cols_array().map(|x| x as f32);
        inverse_bind(&format!("nodes[{node}].matrix"), &bind)?;
        Ok(Rigid { node, anchor, bind })
    }
}

/// Local matrix of a node: the matrix of the file, which may have shear, or the product of translation, rotation and scale.
fn local(root: &Root, node: usize) -> Result<DMat4, InputError> {
    if let Some(matrix) = &root.nodes[node].matrix {
        inverse_bind(&format!("nodes[{node}].matrix"), matrix)?;
        return Ok(DMat4::from_cols_array(&matrix.map(f64::from)));
    }
    Ok(rest(node, &root.nodes[node])?.wide().into())
}
