//! Reads animations as clips.

use gltf_json::Animation;
use gltf_json::animation::{Interpolation as GltfInterpolation, Property};
use gltf_json::validation::Checked;

use super::document::Document;
use super::nodes::Nodes;
use crate::InputError;
use crate::asset::clip::{BoneKeys, Clip, Interpolation, Keys};

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
    // Each bone has three tracks with at least one value, with or without keys.
    document.budget.spend(&format!("animations[{index}]"), 6 * nodes.skeleton.len())?;
    let mut bones = vec![BoneKeys::default(); nodes.skeleton.len()];
    let mut duration = 0.0_f32;
    for (at, channel) in animation.channels.iter().enumerate() {
        let path = format!("animations[{index}].channels[{at}]");
        let node = channel.target.node.value();
        if node >= document.root.nodes.len() {
            let bound = format!("must be below {}", document.root.nodes.len());
            return Err(InputError::new(format!("{path}.target.node"), node, bound));
        }
        let Checked::Valid(property) = channel.target.path else {
            return Err(InputError::new(format!("{path}.target.path"), "unknown", "must be one of glTF's"));
        };
        let sampler = channel.sampler.value();
        let keys = match (nodes.bone(node), property) {
            (Some(bone), Property::Translation) => Some(&mut bones[bone].translation),
            (Some(bone), Property::Rotation) => Some(&mut bones[bone].rotation),
            (Some(bone), Property::Scale) => Some(&mut bones[bone].scale),
            _ => None,
        };
        let Some(place) = keys else {
            let input = animation.samplers[sampler].input;
            let times = document.elements(input).vectors::<1>()?.into_iter().flatten();
            duration = times.filter(|time| time.is_finite()).fold(duration, f32::max);
            continue;
        };
        if place.is_some() {
            return Err(InputError::new(
                format!("{path}.target"),
                node,
                "must not be animated by two channels",
            ));
        }
        *place = Some(keys_of(document, index, animation, sampler, property)?);
    }
    let name = animation.name.clone().unwrap_or_else(|| format!("animation_{index}"));
    Clip::new(name, &nodes.skeleton, &bones, duration)
}

fn keys_of(
    document: &Document<'_>,
    index: usize,
    animation: &Animation,
    sampler: usize,
    property: Property,
) -> Result<Keys, InputError> {
    let path = format!("animations[{index}].samplers[{sampler}]");
    let sampler = &animation.samplers[sampler];
    let interpolation = match sampler.interpolation {
        Checked::Valid(GltfInterpolation::Step) => Interpolation::Step,
        Checked::Valid(GltfInterpolation::Linear) => Interpolation::Linear,
        Checked::Valid(GltfInterpolation::CubicSpline) => Interpolation::CubicSpline,
        Checked::Invalid => {
            let bound = "must be STEP, LINEAR or CUBICSPLINE";
            return Err(InputError::new(format!("{path}.interpolation"), "unknown", bound));
        }
    };
    let times = document.elements(sampler.input).vectors::<1>()?.into_iter().flatten().collect();
    let values = match property {
        Property::Rotation => document.elements(sampler.output).vectors::<4>()?,
        _ => document
            .elements(sampler.output)
            .vectors::<3>()?
            .into_iter()
            .map(|[x, y, z]| [x, y, z, 0.0])
            .collect(),
    };
    let keys = Keys { times, values, interpolation };
    let paths = [format!("{path}.input"), format!("{path}.output")];
    keys.validate([&paths[0], &paths[1]], property == Property::Rotation)?;
    Ok(keys)
}
