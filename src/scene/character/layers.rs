//! Animation layers above a character's base clip, and bounds for blends of clips.

use std::collections::BTreeSet;

use glam::Vec3;

use super::{Character, Runtime};
use crate::InputError;
use crate::animation::Pose;
use crate::animation::layers::{MAX_LAYERS, mask_below};
use crate::asset::Model;
use crate::gpu::{Staged, Upload as _};
use crate::scene::chunk::common;
use crate::scene::instances::Changed;
use crate::scene::options::LayerMask;
use crate::scene::placement::Play;
use crate::scene::playing::Playing;
use crate::skinning::bounding_sphere::{BoundingSphere, MARGIN, middle_of, poses};

/// An animation layer of a character, for all of its instances.
#[derive(Debug)]
pub(super) struct CharacterLayer {
    /// Factor of the layer's weight per bone; `None` = 1 for all bones.
    pub mask: Option<Vec<f32>>,
    pub plays: Vec<Playing>,
    pub weights: Vec<Weight>,
    pub changed: Changed,
    weighed: Changed,
    /// Instances whose weight is changing.
    fading: BTreeSet<u32>,
}

/// The weight of a layer for one instance: a linear change from `from` to `to`, which starts at scene time `start`.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::scene) struct Weight {
    /// The weight at `start`, which [`Character::fade`] sets.
    pub from: f32,
    pub to: f32,
    pub start: f64,
    pub seconds: f32,
    /// Whether the layer's clip becomes the base clip at the end of the change.
    pub hands_over: bool,
}

impl Weight {
    /// The weight at scene time `now`.
    pub fn at(&self, now: f64) -> f32 {
        if self.is_reached(now) {
            return self.to;
        }
        let part = ((now - self.start) / f64::from(self.seconds)).clamp(0.0, 1.0) as f32;
        self.from + (self.to - self.from) * part
    }

    fn is_reached(&self, now: f64) -> bool {
        now >= self.start + f64::from(self.seconds)
    }

    fn is_heard(&self) -> bool {
        self.from > 0.0 || self.to > 0.0
    }
}

impl CharacterLayer {
    /// One layer per bone mask in `masks`. Each layer has weight 0 for all of `capacity` instances.
    pub fn of_masks(
        model: &Model,
        masks: &[LayerMask<'_>],
        bone: impl Fn(&str) -> Result<usize, InputError>,
        capacity: usize,
    ) -> Result<Vec<Self>, InputError> {
        let bound = || format!("must be below {MAX_LAYERS}");
        InputError::check(masks.len() < MAX_LAYERS, "options.layers.len", masks.len(), bound)?;
        let mask = |mask: &LayerMask<'_>| match mask {
            LayerMask::All => Ok(None),
            LayerMask::Below(name) => mask_below(&model.skeleton, bone(name)?).map(Some),
        };
        let layer = |mask: Option<Vec<f32>>| {
            let (plays, weights) = (Vec::new(), Vec::new());
            let (changed, weighed, fading) = Default::default();
            let mut layer = Self { mask, plays, weights, changed, weighed, fading };
            layer.resize(capacity);
            layer
        };
        masks.iter().map(|of| Ok(layer(mask(of)?))).collect()
    }

    /// Changes the capacity to `capacity` instances. Marks all instances for upload.
    pub fn resize(&mut self, capacity: usize) {
        self.plays.resize(capacity, Playing::REST);
        self.weights.resize(capacity, Weight::default());
        self.changed.all(capacity);
        self.weighed.all(capacity);
    }

    fn set(&mut self, index: u32, weight: Weight) {
        self.weights[index as usize] = weight;
        self.weighed.add(index, self.weights.len());
        self.fading.insert(index);
    }
}

impl Character {
    /// Plays a clip on a layer of an instance.
    pub fn play_on(&mut self, index: u32, layer: usize, play: &Play<'_>) -> Result<(), InputError> {
        play.validate()?;
        let clip = self.clip(play.clip)? as u32;
        let layer = self.layer(layer)?;
        layer.plays[index as usize] = Playing { clip, wrap: play.wrap, start: play.start, rate: play.rate };
        layer.changed.add(index, layer.plays.len());
        Ok(())
    }

    /// Changes a layer's weight linearly, from its value at `weight.start` to `weight.to`.
    pub fn fade(&mut self, index: u32, layer: usize, weight: Weight) -> Result<(), InputError> {
        let Weight { to, start, seconds, .. } = weight;
        InputError::check((0.0..=1.0).contains(&to), "weight", to, || "must be in 0..=1")?;
        InputError::check((0.0..=1e6).contains(&seconds), "seconds", seconds, || "must be in 0..=1e6")?;
        let layer = self.layer(layer)?;
        if weight.hands_over && layer.mask.is_some() {
            return Err(InputError::new("layer", "masked", "must be a layer on all bones"));
        }
        let from = layer.weights[index as usize].at(start);
        layer.set(index, Weight { from, ..weight });
        Ok(())
    }

    fn layer(&mut self, layer: usize) -> Result<&mut CharacterLayer, InputError> {
        let count = self.layers.len();
        let at = layer.checked_sub(1).and_then(|at| self.layers.get_mut(at));
        at.ok_or_else(|| {
            let bound = match count {
                0 => "must not be given: the character was added without layers (options.layers)".to_owned(),
                _ => format!("must be in 1..={count}, as options.layers"),
            };
            InputError::new("layer", layer, bound)
        })
    }

    /// Sets the weights of all layers to 0 for an instance that is spawned or despawned.
    pub fn clear_layers(&mut self, index: u32) {
        for layer in &mut self.layers {
            layer.set(index, Weight::default());
        }
    }

    /// Whether any layer of the instance has a weight above 0 at the start or the end of its fade.
    pub fn is_blended(&self, index: u32) -> bool {
        self.layers.iter().any(|layer| layer.weights[index as usize].is_heard())
    }

    /// Ends fades that have reached their target weight by scene time `now`. Returns the instances whose fades ended.
    pub(super) fn end_fades(&mut self, now: f64) -> Vec<u32> {
        let mut changed = Vec::new();
        for layer in &mut self.layers {
            for index in layer.fading.iter().copied().collect::<Vec<_>>() {
                let weight = layer.weights[index as usize];
                layer.weighed.add(index, layer.weights.len());
                if !weight.is_reached(now) {
                    continue;
                }
                layer.fading.remove(&index);
                let mut reached = Weight { from: weight.to, to: weight.to, ..Weight::default() };
                if weight.hands_over {
                    self.plays[index as usize] = layer.plays[index as usize];
                    self.changed.add(index, self.plays.len());
                    reached = Weight::default();
                }
                changed.push(index);
                layer.weights[index as usize] = reached;
            }
        }
        changed
    }

    /// Stages the changed clips and weights of all layers for upload.
    pub(super) fn stage_layers(&mut self, staged: &mut Staged, now: f64) -> Result<(), crate::Error> {
        let (count, clips) = (self.plays.len(), &self.merged.model.clips);
        let duration = |play: &Playing| f64::from(clips[play.clip as usize].duration());
        for (at, layer) in self.layers.iter_mut().enumerate() {
            let (changed, weighed) = (layer.changed.take(count), layer.weighed.take(count));
            for Runtime { slots, crowd, .. } in &self.runtimes {
                for own in changed.iter().filter_map(|[from, to]| common(&(*from..*to), slots)) {
                    let plays = layer.plays[own.clone()].iter();
                    let plays = plays.map(|play| play.on_device(duration(play), self.epoch));
                    let first = (1 + at) * slots.len() + own.start - slots.start;
                    staged.elements(&crowd.instances, first, &plays.collect::<Vec<_>>())?;
                }
                for own in weighed.iter().filter_map(|[from, to]| common(&(*from..*to), slots)) {
                    let weights: Vec<f32> =
                        layer.weights[own.clone()].iter().map(|weight| weight.at(now)).collect();
                    let first = at * slots.len() + own.start - slots.start;
                    staged.elements(&crowd.layer_weights, first, &weights)?;
                }
            }
        }
        Ok(())
    }
}

/// Bounds of bone positions in any blend of a model's clips, in model space.
#[derive(Debug, Clone)]
pub(super) struct Reach {
    center: Vec3,
    radius: f32,
    /// Per bone: largest distance of its origin from `center`, and the largest factor by which the bone enlarges a length.
    bones: Vec<(f32, f32)>,
}

impl Reach {
    /// Computes the bounds of a model. `radii` holds, per bone, the largest distance between the bone and a vertex that
    /// follows it; `None` without such a vertex.
    ///
    /// A blended transform lies between the clips' transforms. A root bone therefore stays in the box around its positions
    /// in all clips. Any other bone stays in a ball around its parent. The ball's radius is the largest distance between
    /// bone and parent in any clip.
    pub fn new(model: &Model, radii: &[Option<f32>]) -> Self {
        let skeleton = &model.skeleton;
        let mut lengths = vec![[0.0_f32; 2]; skeleton.len()];
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        for locals in model.clips.iter().flat_map(poses) {
            for ((bone, local), longest) in skeleton.bones().iter().zip(&locals).zip(&mut lengths) {
                let at = Vec3::from(local.translation);
                if bone.parent.is_none() {
                    (low, high) = (low.min(at), high.max(at));
                }
                let scale = local.scale.iter().fold(0.0_f32, |largest, scale| largest.max(scale.abs()));
                *longest = [longest[0].max(at.length()), longest[1].max(scale)];
            }
        }
        let half = low.distance(high) / 2.0;
        let mut bones: Vec<(f32, f32)> = Vec::with_capacity(skeleton.len());
        for (bone, [length, scale]) in skeleton.bones().iter().zip(lengths) {
            bones.push(match bone.parent.map(|parent| bones[parent as usize]) {
                None => (half, scale),
                Some((reach, stretch)) => (reach + stretch * length, stretch * scale),
            });
        }
        let vertices = bones
            .iter()
            .zip(radii)
            .map(|((reach, stretch), radius)| radius.map_or(0.0, |radius| reach + stretch * radius));
        Self { center: middle_of(low, high), radius: MARGIN * vertices.fold(0.0, f32::max), bones }
    }

    /// A sphere around all vertices, in any blend of the clips.
    pub fn sphere(&self) -> BoundingSphere {
        BoundingSphere { center: self.center, radius: self.radius }
    }

    /// Two bounds for a bone. The first is a sphere around all positions of the sphere `carried`, which moves with the bone.
    /// The second is the largest factor by which the bone enlarges a length.
    pub fn of_bone(&self, bone: usize, carried: &BoundingSphere) -> (BoundingSphere, f32) {
        let (reach, stretch) = self.bones[bone];
        let radius = MARGIN * (reach + stretch * (carried.center.length() + carried.radius));
        (BoundingSphere { center: self.center, radius }, MARGIN * stretch)
    }
}

/// The pose of a model's bones: the layers `above` blended over a clip. Each layer is a clip, a time in seconds, a weight
/// and a mask.
pub(super) fn layered_pose<'a>(
    model: &Model,
    clip: usize,
    seconds: f32,
    above: impl Iterator<Item = (usize, f32, f32, &'a Option<Vec<f32>>)>,
) -> Pose {
    let mut pose = Pose::on_host(&model.skeleton, &model.clips[clip], seconds);
    let mut is_blended = false;
    for (clip, seconds, weight, mask) in above.filter(|(_, _, weight, _)| *weight > 0.0) {
        let over = Pose::on_host(&model.skeleton, &model.clips[clip], seconds).locals;
        for (bone, (below, over)) in pose.locals.iter_mut().zip(&over).enumerate() {
            let weight = weight * mask.as_ref().map_or(1.0, |mask| mask[bone]);
            if weight > 0.0 {
                *below = crate::animation::sample::reference::blend(below, over, weight);
                is_blended = true;
            }
        }
    }
    if is_blended {
        let locals = &pose.locals;
        pose.model_matrices =
            crate::animation::local_to_model::reference::local_to_model(&model.skeleton, locals);
    }
    pose
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_change_in_their_time() {
        let weight = Weight { from: 0.2, to: 1.0, start: 3.0, seconds: 2.0, hands_over: false };
        let found = [2.0, 3.0, 4.0, 5.0, 9.0].map(|now| weight.at(now));
        assert!(
            found.iter().zip([0.2, 0.2, 0.6, 1.0, 1.0]).all(|(found, right)| (found - right).abs() < 1e-6)
        );
        assert!(weight.is_heard() && !Weight::default().is_heard() && Weight::default().is_reached(0.0));
    }

    /// In blends of all clips, masked or not, bones stay within the bounds. Spheres that move with bones
    /// stay within their own bounds.
    #[test]
    fn blends_stay_within_reach() {
        let model = crate::samples::creature().expect("valid");
        let radii = vec![Some(0.1); model.skeleton.len()];
        let reach = Reach::new(&model, &radii);
        let carried = BoundingSphere { center: Vec3::new(0.0, 0.4, 0.0), radius: 0.2 };
        let (around, stretch) = reach.of_bone(60, &carried);
        let mut farthest = 0.0_f32;
        for moment in 0_u16..40 {
            let part = f32::from(moment) / 39.0;
            let mask = Some(mask_below(&model.skeleton, usize::from(moment)).expect("a bone"));
            let above =
                (1..model.clips.len()).map(|clip| (clip, part * model.clips[clip].duration(), 0.6, &mask));
            let pose = layered_pose(&model, 0, part * model.clips[0].duration(), above);
            for matrix in &pose.model_matrices {
                farthest = farthest.max(Vec3::from(matrix.map(|row| row[3])).distance(reach.center));
            }
            let at = Vec3::from(pose.model_matrices[60].map(|[_, y, _, w]| 0.4 * y + w));
            assert!(at.distance(around.center) + carried.radius <= around.radius);
        }
        assert!(
            (farthest..6.0 * farthest).contains(&reach.radius) && stretch >= 1.0,
            "{} {farthest}",
            reach.radius
        );
    }
}
