//! Level of detail of a character's bones: its gate, its influences, and its skeletons.

use std::collections::{BTreeMap, BTreeSet};

use super::Character;
use crate::animation::priority::USER_DEFAULT;
use crate::animation::{
    AnimatedBones, BoundTable, ClipSet, ExpectationTable, Gate, Order, Priorities, PriorityTable,
    Range as DistanceRange, RotationPath, Weights, Wrap,
};
use crate::asset::influences::MAX_INFLUENCES;
use crate::asset::{Affine, Clip, Model, Skeleton};
use crate::scene::options::{BoneGate, CharacterOptions, InfluenceLod};
use crate::shared::lod::assign::AssignParams;
use crate::skinning::tiers::{MAX_TIERS, Tiers};
use crate::{Error, InputError};

/// Number of ticks per second of the gates' clock.
pub(in crate::scene) const TICKS: f64 = 65_536.0;

/// A character's motion has full weight in a budget of bones if the views allow it no more than this fraction of its radius.
const FULL_WEIGHT_RADII: f32 = 1.0 / 1024.0;

/// Largest error of a skeleton under [`BoneGate::Bounded`], as a fraction of the displacement that bones may have.
const TIER_FRACTION: f32 = 0.25;

/// One skeleton of a character: the whole one, or a reduced one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkeletonStatistics {
    /// Number of bones.
    pub bones: usize,
    /// Largest displacement of a vertex in any clip compared with the whole skeleton, in the model's units.
    pub error: f32,
    /// Memory on the device in bytes: keyframes of all clips; poses, matrices and palettes of all instances for which the object has
    /// memory.
    pub bytes: u64,
}

/// The skeletons, clips and gate of a character, and its assignment parameters without the scene's error budget.
pub(super) struct Detail {
    /// The tiers of the skeleton, without clips: `set` has them.
    pub tiers: Tiers,
    pub set: ClipSet,
    pub gate: Gate,
    pub assign: AssignParams,
}

impl Detail {
    /// The level of detail of a character. `radius` is the radius of its bounding sphere.
    pub fn new(options: &CharacterOptions<'_>, model: &Model, radius: f32) -> Result<Self, InputError> {
        let of = |error: InputError| error.below("options");
        options.gate.validate().map_err(of)?;
        options.influences.validate().map_err(of)?;
        let user = user_priorities(&options.priorities, model)?;
        // A bone that no gate skips collapses in no tier.
        let bones = model.skeleton.bones().iter().zip(&user);
        let keep: Vec<String> =
            bones.filter(|(_, priority)| **priority == 1.0).map(|(bone, _)| bone.name.clone()).collect();
        let mut tiers = Tiers::new(model, &options.tiers, &keep).map_err(of)?;
        let set = ClipSet::new(&tiers.clips.iter().collect::<Vec<_>>())?;
        let (gate, unit) = gate(options, model, &user, &tiers, &set)?;
        tiers.clips.clear();
        let falling = |range: DistanceRange| [range.min, (range.max - range.min).recip()];
        let [omega_start, omega_rate] = options.gate.range().map_or([0.0; 2], falling);
        let mut assign = AssignParams {
            first: 0,
            instances: 0,
            bone_fraction: 0.0,
            influence_fraction: 0.0,
            unit,
            stray: tiers.stray,
            max_influences: MAX_INFLUENCES as u32,
            omega_start,
            omega_rate,
            fade_start: 0.0,
            fade_rate: 0.0,
            tier_fraction: if options.gate == BoneGate::Bounded { TIER_FRACTION } else { 1.0 },
            full_weight_allowed: (FULL_WEIGHT_RADII * radius).max(f32::MIN_POSITIVE),
            tier_errors: std::array::from_fn::<f32, MAX_TIERS, _>(|tier| {
                tiers.errors.get(tier).copied().unwrap_or(f32::MAX)
            })
            .into(),
        };
        match options.influences {
            InfluenceLod::Bounded => {}
            InfluenceLod::Truncated(most) => assign.max_influences = most,
            InfluenceLod::Faded(range) => {
                [assign.fade_start, assign.fade_rate] = falling(range);
            }
        }
        Ok(Self { tiers, set, gate, assign })
    }
}

/// The caller's priority of each bone of a model, by bone index.
fn user_priorities(priorities: &BTreeMap<&str, f32>, model: &Model) -> Result<Vec<f32>, InputError> {
    let mut user = vec![USER_DEFAULT; model.skeleton.len()];
    for (name, priority) in priorities {
        let path = format!("options.priorities.{name}");
        let bone = model.bone(name).map_err(|error| InputError { path: path.clone(), ..error })?;
        InputError::check_within(path, *priority, 0.0..=1.0)?;
        user[bone] = *priority;
    }
    Ok(user)
}

/// Each bone's value in a skeleton of several tiers. `of_model` has the values of the model's bones, which come first. A bone of a
/// reduced skeleton has the value of the bone with its name.
fn in_tiers(skeleton: &Skeleton, of_model: &[f32]) -> Vec<f32> {
    let mut by_name = BTreeMap::new();
    for (bone, value) in skeleton.bones().iter().zip(of_model) {
        by_name.entry(bone.name.as_str()).or_insert(*value);
    }
    let reduced = skeleton.bones().iter().skip(of_model.len());
    let value = |name: &str| by_name.get(name).copied().unwrap_or(USER_DEFAULT);
    of_model.iter().copied().chain(reduced.map(|bone| value(&bone.name))).collect()
}

/// The gate, and the unit of its motion in model units; 1 for a gate without motion.
fn gate(
    options: &CharacterOptions<'_>,
    model: &Model,
    user: &[f32],
    tiers: &Tiers,
    set: &ClipSet,
) -> Result<(Gate, f32), InputError> {
    let clips: Vec<&Clip> = tiers.clips.iter().collect();
    let (skeleton, path) = (&tiers.skeleton, RotationPath::default());
    let order = Order::new(skeleton);
    let animated = || AnimatedBones::new(&order, set, &clips);
    let user = in_tiers(skeleton, user);
    let (mut gate, unit) = match options.gate {
        BoneGate::Bounded => {
            let table = BoundTable::new(skeleton, set, &clips, &tiers.bone_radii, path)?;
            let unit = table.unit();
            (Gate::Bounded(table), unit)
        }
        BoneGate::Off => (Gate::Off(animated()?), 1.0),
        BoneGate::Uniform(_) => (Gate::Uniform(animated()?), 1.0),
        BoneGate::SkipPeriod { period, weights, .. } => {
            let of_clip = |(clip, own): (&&Clip, &Clip)| {
                let analyzed = || Weights::analyze(&model.skeleton, own, Wrap::Loop);
                let weights = weights.map_or_else(analyzed, Ok)?;
                Priorities::new(skeleton, clip, Wrap::Loop, &weights, &user)
            };
            let priorities = clips.iter().zip(&model.clips).map(of_clip).collect::<Result<Vec<_>, _>>()?;
            let table = PriorityTable::new(&order, set, &clips, &priorities)?;
            let period = (f64::from(period) * TICKS).round() as u32;
            (Gate::SkipPeriod { table, period }, 1.0)
        }
        BoneGate::Budget { bones } => {
            let table = ExpectationTable::new(skeleton, set, &clips, &tiers.bone_radii, path)?;
            (Gate::Budget { table, bones }, 1.0)
        }
    };
    gate.never_skip(&order, &user.iter().map(|priority| *priority == 1.0).collect::<Vec<_>>())?;
    Ok((gate, unit))
}

impl Character {
    /// Whether the character's settings keep the error that views allow.
    pub(super) fn keeps_bound(&self) -> bool {
        self.keeps_bound
    }

    /// Whether an instance needs all bones of its skeleton.
    pub(super) fn needs_skeleton(&self, index: u32) -> bool {
        self.watched.contains(&index) || self.is_driven(index) || self.is_blended(index)
    }

    /// Replaces the set of instances whose bones are watched. Returns the instances that are no longer or newly watched.
    pub fn watch(&mut self, watched: BTreeSet<u32>) -> Vec<u32> {
        let changed = self.watched.symmetric_difference(&watched).copied().collect();
        self.watched = watched;
        changed
    }

    /// The character's skeletons, the whole one first.
    pub fn skeletons(&self) -> Vec<SkeletonStatistics> {
        let (tiers, instances) = (&self.shared.tiers, self.plays.len() as u64);
        let of_tier = |tier: usize| {
            // A local transform, a model matrix, the sampled motion and a pair index per bone; a palette matrix per joint.
            let [bones, joints] = [tiers.bones[tier], tiers.joints[tier]].map(|count| count as u64);
            let matrix = size_of::<Affine>() as u64;
            let of_instance = bones * (2 * matrix + 8) + joints * matrix;
            SkeletonStatistics {
                bones: tiers.bones[tier],
                error: tiers.errors[tier],
                bytes: instances * of_instance + tiers.keyframes[tier] as u64,
            }
        };
        (0..tiers.bones.len()).map(of_tier).collect()
    }
}

impl crate::scene::Scene {
    /// The skeletons of a character: the whole one, then those of
    /// [`CharacterOptions::tiers`](crate::scene::CharacterOptions::tiers). A tier that would keep all bones of the tier before is
    /// missing. The list is empty for other kinds of objects.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn skeletons(&self, object: crate::scene::ObjectId) -> Result<Vec<SkeletonStatistics>, Error> {
        Ok(self.object_at(object)?.character().map(Character::skeletons).unwrap_or_default())
    }
}
