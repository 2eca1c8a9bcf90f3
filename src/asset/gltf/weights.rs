//! Reads the weights of morph targets, and the keys that animate them.

use gltf_json::animation::{Interpolation as GltfInterpolation, Property};
use gltf_json::validation::Checked;

use super::document::Document;
use crate::InputError;
use crate::asset::clip::Interpolation;
use crate::asset::morph::WeightKeys;

/// The weights of a node's targets: the node's own, or its mesh's, or 0.
pub fn weights(document: &Document<'_>, node: usize, mesh: usize) -> Result<Vec<f32>, InputError> {
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
pub fn weight_keys(
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
            let floats =
                |accessor| Ok(document.elements(accessor).vectors::<1>()?.into_iter().flatten().collect());
            let paths = [format!("{path}.input"), format!("{path}.output")];
            let (times, values) = (floats(sampler.input)?, floats(sampler.output)?);
            let keys = WeightKeys::new([&paths[0], &paths[1]], times, values, interpolation, targets)?;
            all.push((clip, keys));
        }
    }
    Ok(all)
}
