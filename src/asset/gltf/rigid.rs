//! Meshes without a skin. Each follows, as a whole, the lowest node at or above its own that may move.

use glam::DMat4;
use gltf_json::Root;

use super::nodes::rest;
use super::scene::Scene;
use crate::InputError;
use crate::asset::skeleton::inverse_bind;

/// A node with a mesh and no skin.
pub struct Rigid {
    pub node: usize,
    /// Node that the mesh follows: its own or an ancestor. It must be a bone.
    pub anchor: usize,
    /// Matrix from the mesh's space to the anchor's, column-major.
    pub bind: [f32; 16],
}

/// All nodes of the scene with a mesh and no skin, in the order of the nodes. An anchor is a joint, an ancestor of joints, or
/// an animated node; otherwise it is the root of the tree.
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

/// For each node, its anchor and the matrix from the node's space to the anchor's.
struct Followed(Vec<Option<(usize, DMat4)>>);

impl Followed {
    /// Finds the anchors of the nodes in `wanted`, which must contain all their ancestors.
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

/// Local matrix of a node: the file's, sheared or not, or the product of its translation, rotation and scale.
fn local(root: &Root, node: usize) -> Result<DMat4, InputError> {
    if let Some(matrix) = &root.nodes[node].matrix {
        inverse_bind(&format!("nodes[{node}].matrix"), matrix)?;
        return Ok(DMat4::from_cols_array(&matrix.map(f64::from)));
    }
    Ok(rest(node, &root.nodes[node])?.wide().into())
}
