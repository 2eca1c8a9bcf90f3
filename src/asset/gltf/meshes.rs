//! Reads the meshes of nodes: a mesh a primitive, with the weights of its morph targets and their keys.

use gltf_json::animation::{Interpolation as GltfInterpolation, Property};
use gltf_json::validation::Checked;

use super::document::Document;
use super::materials::Materials;
use super::nodes::{Nodes, node_name};
use super::primitive::Reader;
use super::winding::{mirrored, mirrors, turn_mirrored};
use crate::InputError;
use crate::asset::clip::Interpolation;
use crate::asset::mesh::Mesh;
use crate::asset::morph::WeightKeys;

/// Elements charged for a primitive, whatever it contains.
const PRIMITIVE: usize = 32;

/// Reads every primitive of the scene's nodes that have a skin, in the order of the nodes; then those of nodes
/// without a skin.
pub fn meshes(
    document: &Document<'_>,
    nodes: &Nodes,
    materials: &mut Materials,
) -> Result<Vec<Mesh>, InputError> {
    let skinned = nodes.skinned.iter().map(|(node, skin)| (*node, *skin, false));
    let rigid = nodes.rigid.iter().zip(nodes.own_skins()..);
    let rigid = rigid.map(|(rigid, skin)| (rigid.node, skin, true));
    let mirrored = mirrored(&nodes.skeleton);
    let mirrors: Vec<_> = nodes.skins.iter().map(|skin| mirrors(&mirrored, skin)).collect();
    let mut meshes = Vec::new();
    for (node, skin, is_rigid) in skinned.chain(rigid) {
        let Some(mesh) = document.root.nodes[node].mesh else { continue };
        let mesh = mesh.value();
        let weights = weights(document, node, mesh)?;
        let weight_keys = weight_keys(document, node, weights.len())?;
        let keys =
            weight_keys.iter().map(|(_, keys)| keys.parts().0.len() + keys.parts().1.len()).sum::<usize>();
        let name = node_name(&document.root, node);
        for (at, primitive) in document.root.meshes[mesh].primitives.iter().enumerate() {
            let path = format!("meshes[{mesh}].primitives[{at}]");
            document.budget.spend(&path, PRIMITIVE + keys)?;
            let is_bare = materials.is_unread;
            let reader = Reader { document, primitive, path, is_rigid, is_bare };
            let mut read = reader.mesh(&nodes.skins[skin], weights.len())?;
            turn_mirrored(&mut read, &mirrors[skin]);
            let material =
                primitive.material.filter(|_| !is_bare).map(|material| materials.read(document, material));
            meshes.push(Mesh {
                name: format!("{name}_{at}"),
                skin,
                material: material.transpose()?,
                weights: weights.clone(),
                weight_keys: weight_keys.clone(),
                ..read
            });
        }
    }
    Ok(meshes)
}

/// The weights of a node's targets: the node's own, or its mesh's, or 0.
fn weights(document: &Document<'_>, node: usize, mesh: usize) -> Result<Vec<f32>, InputError> {
    let (of_node, of_mesh) = (&document.root.nodes[node], &document.root.meshes[mesh]);
    let first = of_mesh.primitives.first().and_then(|primitive| primitive.targets.as_ref());
    let targets = first.map_or(0, Vec::len);
    let (path, weights) = match (&of_node.weights, &of_mesh.weights) {
        (Some(weights), _) => (format!("nodes[{node}].weights"), weights.clone()),
        (None, Some(weights)) => (format!("meshes[{mesh}].weights"), weights.clone()),
        (None, None) => return Ok(vec![0.0; targets]),
    };
    if weights.len() != targets {
        let bound = format!("must be {targets}, one a morph target");
        return Err(InputError::new(format!("{path}.len"), weights.len(), bound));
    }
    crate::asset::transform::finite(&path, &weights)?;
    Ok(weights)
}

/// The clips that animate the weights of a node's targets.
fn weight_keys(
    document: &Document<'_>,
    node: usize,
    targets: usize,
) -> Result<Vec<(usize, WeightKeys)>, InputError> {
    let mut all: Vec<(usize, WeightKeys)> = Vec::new();
    for (clip, animation) in document.root.animations.iter().enumerate() {
        for (at, channel) in animation.channels.iter().enumerate() {
            let is_of_weights = channel.target.path == Checked::Valid(Property::MorphTargetWeights);
            // A mesh without targets has no weights to animate.
            if !is_of_weights || channel.target.node.value() != node || targets == 0 {
                continue;
            }
            if all.last().is_some_and(|(last, _)| *last == clip) {
                let path = format!("animations[{clip}].channels[{at}].target");
                return Err(InputError::new(path, node, "must not be animated by two channels"));
            }
            let path = format!("animations[{clip}].samplers[{}]", channel.sampler.value());
            let sampler = &animation.samplers[channel.sampler.value()];
            let interpolation = match sampler.interpolation {
                Checked::Valid(GltfInterpolation::Step) => Interpolation::Step,
                Checked::Valid(GltfInterpolation::CubicSpline) => Interpolation::CubicSpline,
                _ => Interpolation::Linear,
            };
            let floats = |accessor| Ok(document.vectors::<1>(accessor)?.into_iter().flatten().collect());
            let paths = [format!("{path}.input"), format!("{path}.output")];
            let (times, values) = (floats(sampler.input)?, floats(sampler.output)?);
            let keys = WeightKeys::new([&paths[0], &paths[1]], times, values, interpolation, targets)?;
            all.push((clip, keys));
        }
    }
    Ok(all)
}
