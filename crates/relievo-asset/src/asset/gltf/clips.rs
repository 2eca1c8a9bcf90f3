//! Reads animations. Animations of bones become clips; animations of morph weights become weight keys of a mesh.

use gltf_json::accessor::Accessor;
use gltf_json::animation::{Interpolation as GltfInterpolation, Property};
use gltf_json::{Animation, Index};

use super::document::Document;
use super::nodes::Nodes;
use crate::InputError;
use crate::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use crate::asset::morph::WeightKeys;

/// Reads every animation of the document.
pub fn clips(document: &Document<'_>, nodes: &Nodes) -> Result<Vec<Clip>, InputError> {
    let animations = document.root.animations.iter().enumerate();
    animations.map(|(index, animation)| clip(document, nodes, index, animation)).collect()
}

fn clip(
    document: &Document<'_>,
    nodes: &Nodes,
    index: usize,
    animation: &Animation,
) -> Result<Clip, InputError> {
    // A bone has three tracks with at least one value each, even without keys.
    document.budget.spend(&format!("animations[{index}]"), 6 * nodes.skeleton.len())?;
    let mut bones = vec![BoneKeys::default(); nodes.skeleton.len()];
    let mut duration = 0.0_f32;
    for (at, channel) in animation.channels.iter().enumerate() {
        let (node, sampler) = (channel.target.node.value(), channel.sampler.value());
        let bone = nodes.bone(node).map(|bone| &mut bones[bone]);
        let property = channel.target.path.unwrap();
        let place = match (bone, property) {
            (Some(bone), Property::Translation) => &mut bone.translation,
            (Some(bone), Property::Rotation) => &mut bone.rotation,
            (Some(bone), Property::Scale) => &mut bone.scale,
            _ => {
                let times = document.elements(animation.samplers[sampler].input).floats()?.into_iter();
                duration = times.filter(|time| time.is_finite()).fold(duration, f32::max);
                continue;
            }
        };
        if place.is_some() {
            return Err(twice(index, at, node));
        }
        let Sampler { paths: [input, output], times, values, interpolation } =
            Sampler::new(document, index, sampler)?;
        let values = match property {
            Property::Rotation => document.elements(values).vectors()?,
            _ => document.elements(values).vectors()?.into_iter().map(|[x, y, z]| [x, y, z, 0.0]).collect(),
        };
        let keys = Keys { times, values, interpolation };
        keys.validate([&input, &output], property == Property::Rotation)?;
        *place = Some(keys);
    }
    let name = animation.name.clone().unwrap_or_else(|| format!("animation_{index}"));
    Clip::new(name, &nodes.skeleton, &bones, duration)
}

/// Reads the keys of a node's morph weights. Each entry has a clip's index, and the keys in that clip.
pub fn weight_keys(
    document: &Document<'_>,
    node: usize,
    targets: usize,
) -> Result<Vec<(usize, WeightKeys)>, InputError> {
    let mut all: Vec<(usize, WeightKeys)> = Vec::new();
    for (clip, animation) in document.root.animations.iter().enumerate() {
        for (at, channel) in animation.channels.iter().enumerate() {
            let is_of_weights = channel.target.path.unwrap() == Property::MorphTargetWeights;
            // A mesh without targets has no weights to animate.
            if !is_of_weights || channel.target.node.value() != node || targets == 0 {
                continue;
            }
            if all.last().is_some_and(|(last, _)| *last == clip) {
                return Err(twice(clip, at, node));
            }
            let Sampler { paths: [input, output], times, values, interpolation } =
                Sampler::new(document, clip, channel.sampler.value())?;
            let values = document.elements(values).floats()?;
            let keys = WeightKeys::new([&input, &output], times, values, interpolation, targets)?;
            all.push((clip, keys));
        }
    }
    Ok(all)
}

/// Error for a channel that has the same target as an earlier channel of the animation.
fn twice(animation: usize, channel: usize, node: usize) -> InputError {
    let path = format!("animations[{animation}].channels[{channel}].target");
    InputError::new(path, node, "must not be animated by two channels")
}

/// A sampler of an animation. Its times have been read, its values have not.
struct Sampler {
    /// Paths in the file of the sampler's times and of its values.
    paths: [String; 2],
    times: Vec<f32>,
    values: Index<Accessor>,
    interpolation: Interpolation,
}

impl Sampler {
    fn new(document: &Document<'_>, animation: usize, at: usize) -> Result<Self, InputError> {
        let sampler = &document.root.animations[animation].samplers[at];
        let interpolation = match sampler.interpolation.unwrap() {
            GltfInterpolation::Step => Interpolation::Step,
            GltfInterpolation::Linear => Interpolation::Linear,
            GltfInterpolation::CubicSpline => Interpolation::CubicSpline,
        };
        let paths = ["input", "output"].map(|name| format!("animations[{animation}].samplers[{at}].{name}"));
        let times = document.elements(sampler.input).floats()?;
        Ok(Self { paths, times, values: sampler.output, interpolation })
    }
}
