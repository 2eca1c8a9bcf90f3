//! Nodes and skins: the skeleton, and a skin for every mesh that has none.

use gltf_json::Root;
use gltf_json::scene::Node;

use super::document::Document;
use super::rigid::{Rigid, rigid};
use crate::InputError;
use crate::asset::skeleton::{Bone, Skeleton, Skin, inverse_bind};
use crate::asset::transform::{Transform, decomposed};

/// The skeleton of all skins, and which node became which bone.
pub struct Nodes {
    pub skeleton: Skeleton,
    /// The document's, then one for each of [`Nodes::rigid`].
    pub skins: Vec<Skin>,
    /// Nodes with a mesh and no skin.
    pub rigid: Vec<Rigid>,
    bones: Vec<Option<u32>>,
}

impl Nodes {
    pub fn new(document: &Document<'_>) -> Result<Self, InputError> {
        let root = &document.root;
        if root.skins.is_empty() {
            return Err(InputError::new(
                "skins",
                "none",
                "must be at least one: nothing here is articulated",
            ));
        }
        let parents = parents(&root.nodes)?;
        let joints = joints(document)?;
        let rigid = rigid(document, &parents, &joints)?;
        let needed: Vec<_> = joints.iter().copied().chain(rigid.iter().map(|rigid| rigid.anchor)).collect();
        let order = order(&root.nodes, &parents, &needed)?;
        let mut bones = vec![None; root.nodes.len()];
        for (node, bone) in order.iter().zip(0..) {
            bones[*node] = Some(bone);
        }
        let bone = |node: &usize| {
            let parent = parents[*node].and_then(|parent| bones[parent]);
            Ok(Bone { name: node_name(root, *node), parent, rest: rest(*node, &root.nodes[*node])? })
        };
        let all = order.iter().map(bone).collect::<Result<Vec<_>, InputError>>()?;
        let joints = joints.iter().filter_map(|node| bones[*node]).collect();
        let skeleton = Skeleton::new(all, joints)?;
        let mut skins = (0..root.skins.len())
            .map(|skin| read_skin(document, skin, &bones))
            .collect::<Result<Vec<_>, _>>()?;
        skins.extend(rigid.iter().map(|rigid| Skin {
            name: node_name(root, rigid.node),
            bones: bones[rigid.anchor].into_iter().collect(),
            inverse_binds: vec![rigid.bind],
        }));
        Ok(Self { skeleton, skins, rigid, bones })
    }

    /// The bone that a node became, if it did.
    pub fn bone(&self, node: usize) -> Option<usize> {
        self.bones.get(node).copied().flatten().map(|bone| bone as usize)
    }
}

/// The node's name, or one made of its number.
pub fn node_name(root: &Root, node: usize) -> String {
    root.nodes[node].name.clone().unwrap_or_else(|| format!("node_{node}"))
}

/// The joints of every skin, each once, as nodes.
fn joints(document: &Document<'_>) -> Result<Vec<usize>, InputError> {
    let mut seen = vec![false; document.root.nodes.len()];
    let mut joints = Vec::new();
    for (index, skin) in document.root.skins.iter().enumerate() {
        if skin.joints.is_empty() {
            return Err(InputError::new(
                format!("skins[{index}].joints"),
                "[]",
                "must have at least one joint",
            ));
        }
        let mut here = std::collections::HashSet::new();
        for (at, joint) in skin.joints.iter().enumerate() {
            let node = joint.value();
            if !here.insert(node) {
                let path = format!("skins[{index}].joints[{at}]");
                return Err(InputError::new(path, node, "must not be named twice"));
            }
            if !std::mem::replace(&mut seen[node], true) {
                joints.push(node);
            }
        }
    }
    Ok(joints)
}

/// The parent of each node; glTF's nodes are trees.
fn parents(nodes: &[Node]) -> Result<Vec<Option<usize>>, InputError> {
    let mut parents = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for (at, child) in node.children.iter().flatten().enumerate() {
            let child = child.value();
            if let Some(other) = parents[child].replace(parent) {
                let path = format!("nodes[{parent}].children[{at}]");
                return Err(InputError::new(
                    path,
                    child,
                    format!("must have one parent, and nodes[{other}] is it"),
                ));
            }
        }
    }
    Ok(parents)
}

/// These nodes and all above them, each with what lies below it behind it.
fn order(nodes: &[Node], parents: &[Option<usize>], wanted: &[usize]) -> Result<Vec<usize>, InputError> {
    let mut needed = vec![false; nodes.len()];
    let mut roots = Vec::new();
    for wanted in wanted {
        let mut node = *wanted;
        while !std::mem::replace(&mut needed[node], true) {
            match parents[node] {
                Some(parent) => node = parent,
                None => roots.push(node),
            }
        }
    }
    roots.sort_unstable();
    roots.reverse();
    let mut order = Vec::new();
    let mut waiting = roots;
    while let Some(node) = waiting.pop() {
        order.push(node);
        let children = nodes[node].children.iter().flatten().map(|child| child.value());
        waiting.extend(children.filter(|child| needed[*child]).rev());
    }
    // Who is its own ancestor hangs below no root.
    let mut reached = vec![false; nodes.len()];
    order.iter().for_each(|node| reached[*node] = true);
    match wanted.iter().find(|node| !reached[**node]) {
        None => Ok(order),
        Some(node) => {
            Err(InputError::new(format!("nodes[{node}]"), node, "must not lie below itself: nodes are trees"))
        }
    }
}

/// Where a node is when nothing moves it.
pub fn rest(index: usize, node: &Node) -> Result<Transform, InputError> {
    let path = format!("nodes[{index}]");
    if let Some(matrix) = &node.matrix {
        return decomposed(&format!("{path}.matrix"), matrix);
    }
    let rest = Transform {
        translation: node.translation.unwrap_or([0.0; 3]),
        rotation: node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0),
        scale: node.scale.unwrap_or([1.0; 3]),
    };
    rest.checked(&path)
}

fn read_skin(document: &Document<'_>, index: usize, bones: &[Option<u32>]) -> Result<Skin, InputError> {
    let skin = &document.root.skins[index];
    let joints: Vec<u32> = skin.joints.iter().filter_map(|joint| bones[joint.value()]).collect();
    let mut inverse_binds = match skin.inverse_bind_matrices {
        Some(accessor) => document.vectors::<16>(accessor)?,
        None => vec![glam::Mat4::IDENTITY.to_cols_array(); joints.len()],
    };
    let path = format!("skins[{index}].inverseBindMatrices");
    if inverse_binds.len() < joints.len() {
        let bound = format!("must be at least {}, one a joint", joints.len());
        return Err(InputError::new(path, format!("[{} matrices]", inverse_binds.len()), bound));
    }
    inverse_binds.truncate(joints.len());
    for (at, matrix) in inverse_binds.iter().enumerate() {
        inverse_bind(&format!("{path}[{at}]"), matrix)?;
    }
    let name = skin.name.clone().unwrap_or_else(|| format!("skin_{index}"));
    Ok(Skin { name, bones: joints, inverse_binds })
}
