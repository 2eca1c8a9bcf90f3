//! Reads nodes and skins. Builds the skeleton, and a skin for every mesh without one.

use gltf_json::Root;
use gltf_json::animation::Property;
use gltf_json::scene::Node;
use gltf_json::validation::Checked;

use super::document::Document;
use super::rigid::{Rigid, rigid};
use super::scene::Scene;
use crate::InputError;
use crate::asset::skeleton::{Bone, Skeleton, Skin, inverse_bind};
use crate::asset::transform::{Transform, decomposed};

/// The skeleton and the skins of the scene, with the mapping from nodes to bones.
pub struct Nodes {
    pub skeleton: Skeleton,
    /// First the skins of the document that the scene uses, then one skin for each entry of [`Nodes::rigid`].
    pub skins: Vec<Skin>,
    /// Nodes of the scene with a mesh and a skin: the index of the node, and the index of its skin in [`Nodes::skins`].
    pub skinned: Vec<(usize, usize)>,
    /// Nodes of the scene with a mesh but no skin.
    pub rigid: Vec<Rigid>,
    bones: Vec<Option<u32>>,
}

impl Nodes {
    pub fn new(document: &Document<'_>) -> Result<Self, InputError> {
        let root = &document.root;
        let scene = Scene::new(root)?;
        document.extensions.check_copies(&scene.contains)?;
        let used = used_skins(root, &scene);
        let joints = joints(root, &used)?;
        let animated = animated(root);
        let rigid = rigid(root, &scene, &joints, &animated)?;
        let mut needed = joints.clone();
        needed.extend(rigid.iter().map(|rigid| rigid.anchor));
        if used.is_empty() {
            needed.extend((0..root.nodes.len()).filter(|node| animated[*node] && scene.contains[*node]));
        }
        if needed.is_empty() {
            let bound = "must have a mesh, a skin or an animated node in the default scene";
            return Err(InputError::new("nodes", format!("[{} nodes]", root.nodes.len()), bound));
        }
        let order = order(&root.nodes, &scene, &needed);
        let mut bones = vec![None; root.nodes.len()];
        for (node, bone) in order.iter().zip(0..) {
            bones[*node] = Some(bone);
        }
        let skeleton = skeleton(root, &scene, &order, &joints, &bones)?;
        let mut skins =
            used.iter().map(|skin| read_skin(document, *skin, &bones)).collect::<Result<Vec<_>, _>>()?;
        skins.extend(rigid.iter().map(|rigid| Skin {
            name: node_name(root, rigid.node),
            bones: bones[rigid.anchor].into_iter().collect(),
            inverse_binds: vec![rigid.bind],
        }));
        let skinned = skinned(root, &scene, &used);
        Ok(Self { skeleton, skins, skinned, rigid, bones })
    }

    /// Number of leading entries of [`Nodes::skins`] that come from the document.
    pub fn own_skins(&self) -> usize {
        self.skins.len() - self.rigid.len()
    }

    /// Bone index of a node; `None` if the node is not a bone.
    pub fn bone(&self, node: usize) -> Option<usize> {
        self.bones.get(node).copied().flatten().map(|bone| bone as usize)
    }
}

/// The node's name, or a name made from its index if it has none.
pub fn node_name(root: &Root, node: usize) -> String {
    root.nodes[node].name.clone().unwrap_or_else(|| format!("node_{node}"))
}

/// Skins that the scene's nodes use. Also skins that no node uses, if all their joints lie in the scene.
fn used_skins(root: &Root, scene: &Scene) -> Vec<usize> {
    let (mut here, mut anywhere) = (vec![false; root.skins.len()], vec![false; root.skins.len()]);
    for (node, skin) in root.nodes.iter().enumerate().filter_map(|(at, node)| Some((at, node.skin?.value())))
    {
        anywhere[skin] = true;
        here[skin] |= scene.contains[node];
    }
    let lies_here = |skin: usize| root.skins[skin].joints.iter().all(|joint| scene.contains[joint.value()]);
    (0..root.skins.len()).filter(|skin| here[*skin] || !anywhere[*skin] && lies_here(*skin)).collect()
}

/// Node indices of the joints of `skins`, each once.
fn joints(root: &Root, skins: &[usize]) -> Result<Vec<usize>, InputError> {
    let mut seen = vec![false; root.nodes.len()];
    let mut joints = Vec::new();
    for index in skins {
        let skin = &root.skins[*index];
        if skin.joints.is_empty() {
            let bound = "must have at least one joint";
            return Err(InputError::new(format!("skins[{index}].joints"), "[]", bound));
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

/// For each node, whether an animation translates, rotates or scales it.
fn animated(root: &Root) -> Vec<bool> {
    let mut animated = vec![false; root.nodes.len()];
    for channel in root.animations.iter().flat_map(|animation| &animation.channels) {
        let is_of_weights = channel.target.path == Checked::Valid(Property::MorphTargetWeights);
        if let Some(node) = animated.get_mut(channel.target.node.value()).filter(|_| !is_of_weights) {
            *node = true;
        }
    }
    animated
}

/// Nodes of the scene with a mesh and one of `skins`. Each comes with the position of its skin in `skins`.
fn skinned(root: &Root, scene: &Scene, skins: &[usize]) -> Vec<(usize, usize)> {
    let mut place = vec![None; root.skins.len()];
    skins.iter().enumerate().for_each(|(at, skin)| place[*skin] = Some(at));
    let nodes = root.nodes.iter().enumerate().filter(|(at, node)| scene.contains[*at] && node.mesh.is_some());
    nodes.filter_map(|(at, node)| Some((at, place[node.skin?.value()]?))).collect()
}

/// Returns the nodes in `wanted` and all their ancestors, in depth-first order.
fn order(nodes: &[Node], scene: &Scene, wanted: &[usize]) -> Vec<usize> {
    let needed = scene.with_ancestors(wanted);
    let is_root = |node: &usize| needed[*node] && scene.parents[*node].is_none();
    let mut waiting: Vec<usize> = (0..nodes.len()).rev().filter(is_root).collect();
    let mut order = Vec::new();
    while let Some(node) = waiting.pop() {
        order.push(node);
        waiting.extend(scene.children(nodes, node).filter(|child| needed[*child]).rev());
    }
    order
}

/// Builds the skeleton from the nodes in `order`. If there are no skins, all bones are joints.
fn skeleton(
    root: &Root,
    scene: &Scene,
    order: &[usize],
    joints: &[usize],
    bones: &[Option<u32>],
) -> Result<Skeleton, InputError> {
    let bone = |node: &usize| {
        let parent = scene.parents[*node].and_then(|parent| bones[parent]);
        Ok(Bone { name: node_name(root, *node), parent, rest: rest(*node, &root.nodes[*node])? })
    };
    let all = order.iter().map(bone).collect::<Result<Vec<_>, InputError>>()?;
    match joints.is_empty() {
        true => Skeleton::of_joints(all),
        false => Skeleton::new(all, joints.iter().filter_map(|node| bones[*node]).collect()),
    }
}

/// Transform of a node in its rest pose, relative to its parent.
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
        Some(accessor) => document.elements(accessor).vectors::<16>()?,
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
