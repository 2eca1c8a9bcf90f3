//! Options of characters and of terrain.

use std::collections::BTreeMap;

use crate::InputError;
use crate::animation::RootMotion;
use crate::animation::root_motion::Taken;
use crate::animation::{Range as DistanceRange, Weights as PriorityWeights};
use crate::asset::Model;
use crate::asset::influences::MAX_INFLUENCES;
use crate::skinning::SkeletonTier;

/// Animation layers, root motion and level of detail of a character, for
/// [`Scene::add_character_with`](crate::scene::Scene::add_character_with).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CharacterOptions<'a> {
    /// The animation layers above the base layer, at most 7. Their weights are 0 at first. A layer costs 16 bytes per
    /// instance. While its weight is above 0, it costs as much sampling as the base layer.
    pub layers: Vec<LayerMask<'a>>,
    /// Root motion to extract from all clips. The clips then play in place; [`Scene::root_motion`] returns the motion.
    ///
    /// [`Scene::root_motion`]: crate::scene::Scene::root_motion
    pub root_motion: Option<RootOptions<'a>>,
    /// How the bones to sample are chosen. The default keeps the view's error bound.
    pub gate: BoneGate,
    /// How many bones each vertex follows. The default keeps the view's error bound.
    pub influences: InfluenceLod,
    /// The caller's priority of bones, 0 to 1; all other bones have 0.5. A bone is given by its name, or by its index in digits.
    ///
    /// A bone of priority 1 is sampled in every frame that shows the instance, whatever the gate. Its own keyframes are then always
    /// exact, and it stays in every reduced skeleton. Bones above it may still be skipped. [`BoneGate::SkipPeriod`] uses the other
    /// values as the sixth term of priorities.
    pub priorities: BTreeMap<&'a str, f32>,
    /// Reduced skeletons for distant instances, at most 3, each with fewer bones than the one before. Empty by default.
    ///
    /// An instance uses the coarsest skeleton whose error is at most the displacement that bones may have
    /// ([`ErrorBudget::bones`](crate::scene::ErrorBudget::bones)); under [`BoneGate::Bounded`] at most a quarter of it, as the gate
    /// needs the rest. Bones, clips and influences change together. Each skeleton takes
    /// memory for its bones in every instance; [`Scene::skeletons`](crate::scene::Scene::skeletons) returns it.
    ///
    /// An instance keeps the whole skeleton while it carries an attached mesh, while bones of it are driven
    /// ([`Scene::drive`](crate::scene::Scene::drive)), and while layers are blended over its clip. Poses and bones on the host are
    /// always those of the whole skeleton. In [`PoseBuffers`](crate::scene::PoseBuffers), the bones of an instance with a reduced
    /// skeleton are outdated.
    pub tiers: Vec<SkeletonTier>,
}

/// A method that chooses the bones of a character that are sampled in a frame. The other bones keep their last local transforms
/// (thesis A, sections 10 to 12).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum BoneGate {
    /// Samples the bones whose missed motion would exceed the error that the views allow
    /// ([`ErrorBudget::bones`](crate::scene::ErrorBudget::bones)). All other gates bound no error, and
    /// [`ObjectStatistics::pixels`](crate::scene::ObjectStatistics::pixels) is infinite.
    #[default]
    Bounded,
    /// Samples all bones that the clip moves. The error is 0.
    Off,
    /// Samples all bones of an instance together, less often with the distance of the nearest eye: always up to the range's
    /// minimum, never beyond its maximum (thesis A's naïve method, section 10).
    Uniform(DistanceRange),
    /// Skips updates of single bones by priority and distance (thesis A's own method, section 12.10).
    SkipPeriod {
        /// Distances between which skips become more frequent. Beyond the maximum, no bone is sampled.
        range: DistanceRange,
        /// Time in seconds between two skipped updates of a bone of priority 1 at the range's minimum, above 0 and at most 65535.
        /// Thesis A has 1.
        period: f32,
        /// Weights of the six terms of a bone's priority. `None` derives them from each clip
        /// ([`PriorityWeights::analyze`]).
        weights: Option<PriorityWeights>,
    },
    /// Samples at most so many bones in a frame, over all instances of the object: those whose missed motion is most visible.
    /// Instances that come into view, or change their clip, are sampled in full even beyond this number.
    Budget {
        /// Largest number of bones.
        bones: u32,
    },
}

/// How many bones each vertex of a character follows (thesis A, section 8.4).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum InfluenceLod {
    /// Weak influences fade out as far as the views allow ([`ErrorBudget::influences`](crate::scene::ErrorBudget::influences)). The
    /// other methods bound no error, and [`ObjectStatistics::pixels`](crate::scene::ObjectStatistics::pixels) is infinite.
    #[default]
    Bounded,
    /// Each vertex follows at most so many bones, 1 to 8: those with the largest weights. All 8 omit nothing.
    Truncated(u32),
    /// Influences fade with the distance of the nearest eye: all of them up to the range's minimum, one bone per vertex beyond its
    /// maximum.
    Faded(DistanceRange),
}

impl BoneGate {
    /// Whether the gate keeps the error that views allow.
    pub(super) fn is_bounded(&self) -> bool {
        matches!(self, Self::Bounded | Self::Off)
    }

    /// The distances over which Ω falls; `None` if it is always 1.
    pub(super) fn range(&self) -> Option<DistanceRange> {
        match self {
            Self::Uniform(range) | Self::SkipPeriod { range, .. } => Some(*range),
            Self::Bounded | Self::Off | Self::Budget { .. } => None,
        }
    }

    /// Checks the gate's parameters.
    ///
    /// # Errors
    /// [`InputError`] for a range that [`DistanceRange::validate`] refuses, for a period out of range, and for weights that
    /// [`PriorityWeights::validate`] refuses.
    pub fn validate(&self) -> Result<(), InputError> {
        if let Some(range) = self.range() {
            range.validate().map_err(|error| error.below("gate"))?;
        }
        if let Self::SkipPeriod { period, weights, .. } = self {
            if !(*period > 0.0 && *period <= MAX_PERIOD) {
                let bound = format!("must be above 0, and at most {MAX_PERIOD}");
                return Err(InputError::new("gate.period", period, bound));
            }
            weights.iter().try_for_each(|weights| weights.validate().map_err(|error| error.below("gate")))?;
        }
        Ok(())
    }
}

/// Largest [`BoneGate::SkipPeriod::period`] in seconds. Its ticks fit 32 bits.
const MAX_PERIOD: f32 = 65_535.0;

impl InfluenceLod {
    /// Whether the method keeps the error that views allow.
    pub(super) fn is_bounded(&self) -> bool {
        matches!(self, Self::Bounded | Self::Truncated(8))
    }

    /// Checks the method's parameter.
    ///
    /// # Errors
    /// [`InputError`] for a number of bones out of range, and for a range that [`DistanceRange::validate`] refuses.
    pub fn validate(&self) -> Result<(), InputError> {
        match self {
            Self::Bounded => Ok(()),
            Self::Truncated(most) => {
                InputError::check_within("influences", *most as usize, 1..=MAX_INFLUENCES)
            }
            Self::Faded(range) => range.validate().map_err(|error| error.below("influences")),
        }
    }
}

/// The bones that an animation layer moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerMask<'a> {
    /// All bones.
    All,
    /// A bone and all bones below it. The bone is given by its name, or by its index in digits.
    Below(&'a str),
}

/// Root motion to extract from clips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RootOptions<'a> {
    /// The bone that carries the motion, given by its name, or by its index in digits.
    pub bone: &'a str,
    /// The components of the motion to extract.
    pub taken: Taken,
}

impl RootOptions<'_> {
    /// Extracts the root motion from all clips of a model. The model keeps clips that play in place. Returns one motion
    /// per clip.
    ///
    /// # Errors
    /// As for [`RootMotion::extract`]; [`InputError`] for a bone that the model does not have.
    pub(super) fn take(&self, model: &mut Model) -> Result<Vec<RootMotion>, InputError> {
        let bone = model.bone(self.bone)?;
        let extracted =
            model.clips.iter().map(|clip| RootMotion::extract(&model.skeleton, clip, bone, self.taken));
        let (clips, motions) = extracted.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        model.clips = clips;
        Ok(motions)
    }
}

/// Appearance of terrain in the layer [`Layer::Color`](crate::render::Layer::Color). The style has no effect on other
/// layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TerrainStyle {
    /// The textures of the terrain's zones, blended by height.
    #[default]
    Textured,
    /// Lit edges of the drawn triangles on dark, unlit ground.
    Wireframe,
}
