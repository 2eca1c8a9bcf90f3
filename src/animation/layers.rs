//! Animation layers: each instance plays several clips, blended one over the other.
//!
//! Layer 0 is the base: a clip that each instance plays on all its bones. Each layer above the base plays a clip with its own
//! start, rate and wrap. A layer has a *weight* per instance and a *mask* value per bone. Blending goes from the base upwards.
//! Let `below` be a bone's translation, rotation or scale after blending all lower layers. The next layer changes it to
//!
//! `below + (layer − below) · weight · mask`
//!
//! Rotations are blended along the chord to the nearer of q and −q, then normalized (nlerp). At the weights 0 and 1 they are
//! exact. In between, they follow the shortest arc, but not at constant speed. Compared with constant speed (slerp), the largest
//! deviation is 0.002 rad for rotations 45° apart, 0.016 rad for 90° and 0.14 rad for 180°. A layer costs no memory reads on
//! bones where weight times mask is 0.
//!
//! A cross-fade of two clips is one layer without a mask. A walk with a waving arm is one layer with the mask of the arm
//! ([`mask_below`]).
//!
//! ```
//! use relievo::ops::animation::{AnimationLayer, ClipSet, Instance, Wrap, layers::mask_below};
//! use relievo_samples::creature;
//!
//! let model = creature()?;
//! let set = ClipSet::new(&model.clips.iter().collect::<Vec<_>>())?;
//! let walk = vec![Instance::new(0, Wrap::Loop, 0.0, 1.0); 100];
//! let wave = AnimationLayer::new(vec![Instance::new(2, Wrap::Loop, 0.0, 1.0); 100], vec![1.0; 100]);
//! let arm = model.skeleton.bones().iter().position(|bone| bone.name == "upper_arm_left").expect("there");
//! let layers = [wave.masked(mask_below(&model.skeleton, arm)?)];
//! // Crowd::layered(&gpu, &set, &walk, &layers)?, sampled by SamplePass::layered; later crowd.set_weights(&gpu, 1, …)?
//! layers[0].validate("layers[0]", 100, set.clips().len(), set.bones())?;
//! # Ok::<(), relievo::InputError>(())
//! ```

use crate::InputError;
use crate::animation::instance::Instance;
use crate::asset::skeleton::Skeleton;

/// Largest number of layers of a crowd, including the base.
pub const MAX_LAYERS: usize = 8;

/// An animation layer above the base.
#[derive(Debug, Clone, PartialEq)]
pub struct AnimationLayer {
    /// Playback of each instance on this layer: clip, wrap, start and rate.
    pub instances: Vec<Instance>,
    /// Weight of the layer for each instance, 0 to 1.
    pub weights: Vec<f32>,
    /// Mask value for each bone, 0 to 1; `None` means 1 on all bones.
    pub mask: Option<Vec<f32>>,
}

impl AnimationLayer {
    /// Creates a layer that affects all bones, because it has no mask. `instances` and `weights` have one entry per instance of
    /// the crowd.
    pub fn new(instances: Vec<Instance>, weights: Vec<f32>) -> Self {
        Self { instances, weights, mask: None }
    }

    /// Sets the layer's mask, one value from 0 to 1 per bone, and returns the layer.
    #[must_use]
    pub fn masked(self, mask: Vec<f32>) -> Self {
        Self { mask: Some(mask), ..self }
    }

    /// Blend weight for one bone of one instance: the instance's weight times the bone's mask value.
    pub fn weight(&self, instance: usize, bone: usize) -> f32 {
        self.weights[instance] * self.mask.as_ref().map_or(1.0, |mask| mask[bone])
    }

    /// Checks that the layer matches a crowd. `count`, `clips` and `bones` are the crowd's numbers of instances, clips and bones.
    /// `path` is the prefix of field names in errors.
    ///
    /// # Errors
    /// [`InputError`] in these cases:
    ///
    /// - there is not one playback and one weight per instance;
    /// - the mask does not have one value per bone;
    /// - a weight or mask value is outside 0..=1;
    /// - an instance plays a clip that does not exist.
    pub fn validate(&self, path: &str, count: usize, clips: usize, bones: usize) -> Result<(), InputError> {
        let each = |field: &str, len: usize, wanted: usize, item: &str| {
            InputError::check_len(&format!("{path}.{field}"), len, wanted, item)
        };
        each("instances", self.instances.len(), count, "an instance of the base")?;
        each("weights", self.weights.len(), count, "an instance of the base")?;
        check_weights(&format!("{path}.weights"), &self.weights)?;
        if let Some(mask) = &self.mask {
            each("mask", mask.len(), bones, "a bone")?;
            check_weights(&format!("{path}.mask"), mask)?;
        }
        self.instances.iter().try_for_each(|instance| instance.validate(clips))
    }
}

/// Returns an error if a value is outside 0..=1. The error names the first such value by its index.
pub(crate) fn check_weights(path: &str, values: &[f32]) -> Result<(), InputError> {
    InputError::check_each(path, values, |value| (0.0..=1.0).contains(value), "must be in 0..=1")
}

/// Mask that selects a bone and its descendants: 1 for these bones, 0 for all others.
///
/// # Errors
/// [`InputError`] if the skeleton has no such bone.
pub fn mask_below(skeleton: &Skeleton, bone: usize) -> Result<Vec<f32>, InputError> {
    InputError::check_below("bone", bone, skeleton.len())?;
    let mut mask = vec![0.0; skeleton.len()];
    mask[bone] = 1.0;
    for (below, node) in skeleton.bones().iter().enumerate().skip(bone + 1) {
        if let Some(parent) = node.parent {
            mask[below] = mask[parent as usize];
        }
    }
    Ok(mask)
}

/// Concatenates the instances of all layers, the base first. This is the order of a crowd's buffers.
pub fn all_instances(base: &[Instance], layers: &[AnimationLayer]) -> Vec<Instance> {
    base.iter().chain(layers.iter().flat_map(|layer| &layer.instances)).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::instance::Wrap;

    #[test]
    fn layers_are_checked_field_by_field() {
        let instance = Instance::new(1, Wrap::Loop, 0.0, 1.0);
        let good = AnimationLayer::new(vec![instance; 2], vec![0.0, 1.0]).masked(vec![0.5; 3]);
        assert_eq!(good.validate("layers[0]", 2, 2, 3), Ok(()));
        assert_eq!(good.weight(1, 2), 0.5);
        let refused = |layer: AnimationLayer| layer.validate("layers[0]", 2, 2, 3).expect_err("refused").path;
        assert_eq!(
            refused(AnimationLayer { instances: vec![instance], ..good.clone() }),
            "layers[0].instances.len"
        );
        assert_eq!(
            refused(AnimationLayer { weights: vec![1.0; 3], ..good.clone() }),
            "layers[0].weights.len"
        );
        for wrong in [f32::NAN, f32::INFINITY, -0.1, 1.1] {
            assert_eq!(
                refused(AnimationLayer { weights: vec![0.0, wrong], ..good.clone() }),
                "layers[0].weights[1]"
            );
            assert_eq!(refused(good.clone().masked(vec![wrong, 0.0, 0.0])), "layers[0].mask[0]");
        }
        assert_eq!(refused(good.clone().masked(vec![1.0; 2])), "layers[0].mask.len");
        let other = Instance { clip: 2, ..instance };
        assert_eq!(refused(AnimationLayer { instances: vec![instance, other], ..good }), "instance.clip");
    }

    #[test]
    fn masks_reach_down() {
        let model = crate::samples::creature().expect("valid");
        for bone in [0, 10, 152] {
            let mask = mask_below(&model.skeleton, bone).expect("a bone");
            let ones = mask.iter().filter(|value| **value == 1.0).count();
            assert_eq!(ones, 1 + model.skeleton.descendants()[bone] as usize);
            assert!(mask.iter().all(|value| [0.0, 1.0].contains(value)));
        }
        assert_eq!(mask_below(&model.skeleton, 153).expect_err("refused").path, "bone");
    }
}
