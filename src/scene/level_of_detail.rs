//! How an object's levels of detail are chosen and how they change.

use crate::InputError;
use crate::lod::LodObject;
use crate::lod::criterion::Criterion;
use crate::lod::transition::{Pace, Transition};
use crate::shared::lod::budget::MAX_FACTOR;
use crate::shared::lod::object::{FADE_PROGRESS, NO_RANK, RANKS, object_flags_word};
use crate::shared::lod::select::MAX_MOTION;

/// An object's `metric_floor` is its largest threshold divided by this number. The number is half of the largest factor by
/// which a triangle budget may enlarge a metric.
const FLOOR: f32 = 0.5 * MAX_FACTOR;

/// How the levels of detail of an object are chosen, in every view, and how they change.
///
/// # Examples
///
/// Hand-set distances, and a dither of 0.3 seconds:
///
/// ```no_run
/// use relievo::scene::{Criterion, DistanceTo, LevelChoice, LevelOfDetail, Pace, Transition};
/// # fn tune(scene: &mut relievo::scene::Scene, tree: relievo::scene::ObjectId) -> Result<(), relievo::Error> {
/// let criterion = Criterion::Distance { to: DistanceTo::Center, from: vec![20.0, 60.0, 200.0] };
/// scene.set_level_of_detail(
///     tree,
///     &LevelOfDetail {
///         choice: LevelChoice::By(criterion),
///         transition: Transition::Dither(Pace::Seconds(0.3)),
///         ..LevelOfDetail::default()
///     },
/// )?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LevelOfDetail {
    /// How a level is chosen: by a criterion, or one level for all instances.
    pub choice: LevelChoice,
    /// How instances change from one level to the next.
    pub transition: Transition,
    /// Hysteresis h: half width of the interval around each threshold in which an instance keeps its level (thesis A,
    /// section 7.2). It is a fraction of the threshold, at least 0 and below 1. With distances, an instance takes the
    /// coarser level at (1 + h) times the threshold, and returns to the finer level at (1 − h) times the threshold. With
    /// sizes, which shrink with distance, the two factors change places. With [`Criterion::Error`], hysteresis never makes
    /// the error exceed the allowed displacement: an instance takes a coarser level once the coarser level's error is at
    /// most (1 − h) times the allowed displacement. Hysteresis applies only if levels change at once or fade over a time
    /// ([`Pace::Seconds`]).
    pub hysteresis: f32,
    /// Factor of the metric (allowed displacement or distance), above 0. With 2, levels are chosen as if an instance were
    /// twice as far away, and errors may reach 2 times [`Quality::pixels`](super::Quality::pixels). Thesis A's *late
    /// switching* (section 7.1) is a factor below 1.
    pub bias: f32,
    /// Importance among the objects that share a budget of triangles ([`Quality::triangles`](super::Quality::triangles)), 0
    /// to 7. Objects of rank 0 are coarsened first (thesis A, section 6.3). If any object of the scene has a rank, objects
    /// without a rank are never coarsened by the budget.
    pub rank: Option<u8>,
    /// Perceptual factors: instances that are perceived poorly may be coarser.
    pub perceptual: Perceptual,
    /// Whether instances outside the view volume are left out.
    pub culling: Culling,
}

/// How the level of an instance is chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum LevelChoice {
    /// By a criterion, for each instance in each view.
    By(Criterion),
    /// The same level for all instances in all views, for debugging; 0 is the finest level.
    Forced(u32),
}

/// Strength of the perceptual factors (thesis A, section 6.4). The metric of an instance, which is a distance or an allowed
/// displacement, is multiplied by 1 + `motion` · v + `periphery` · r. Levels are chosen as if the instance were further away.
///
/// v is the speed of the instance's middle in the picture, in picture heights per second, at most 4. It is 0 if the last
/// frame did not show the instance. r is the distance between the instance's middle and the picture's middle, as a fraction
/// of half the picture's height, at most 1. The formula is ours; thesis A gives none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Perceptual {
    /// Relative increase of the metric at a speed of one picture height per second. At least 0; 0 by default.
    pub motion: f32,
    /// Relative increase of the metric at half a picture height from the picture's middle. At least 0; 0 by default.
    pub periphery: f32,
}

/// Whether instances outside the view volume are left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Culling {
    /// Instances whose bounding sphere is outside the view volume are left out.
    #[default]
    Frustum,
    /// No instance is left out: for debugging, and for shaders that move an instance out of its sphere.
    Never,
}

impl Default for LevelOfDetail {
    /// Levels are chosen by projected error and change at once, with a hysteresis of 0.1.
    fn default() -> Self {
        Self {
            choice: LevelChoice::By(Criterion::Error),
            transition: Transition::Hard,
            hysteresis: 0.1,
            bias: 1.0,
            rank: None,
            perceptual: Perceptual::default(),
            culling: Culling::Frustum,
        }
    }
}

impl From<Transition> for LevelOfDetail {
    fn from(transition: Transition) -> Self {
        Self { transition, ..Self::default() }
    }
}

impl LevelOfDetail {
    /// Checks the ranges of all fields, for an object with `levels` levels.
    ///
    /// # Errors
    /// [`InputError`] that names the invalid field.
    pub fn validate(&self, levels: usize) -> Result<(), InputError> {
        let Self { choice, transition, hysteresis, bias, rank, perceptual, .. } = self;
        match choice {
            LevelChoice::By(criterion) => {
                criterion.validate(levels)?;
                transition.validate(criterion)?;
            }
            LevelChoice::Forced(level) if *level as usize >= levels => {
                let bound = format!("must be below {levels}, the number of levels");
                return Err(InputError::new("choice.level", level, bound));
            }
            LevelChoice::Forced(_) => {}
        }
        if !(0.0..1.0).contains(hysteresis) {
            return Err(InputError::new("hysteresis", hysteresis, "must be at least 0 and below 1"));
        }
        InputError::check(*bias > 0.0 && bias.is_finite(), "bias", bias, || "must be finite, and above 0")?;
        if let Some(rank) = rank.filter(|rank| u32::from(*rank) >= RANKS) {
            return Err(InputError::new("rank", rank, format!("must be below {RANKS}")));
        }
        let factors =
            [("perceptual.motion", perceptual.motion), ("perceptual.periphery", perceptual.periphery)];
        match factors.into_iter().find(|(_, factor)| !(0.0..f32::INFINITY).contains(factor)) {
            Some((path, factor)) => Err(InputError::new(path, factor, "must be finite, and not negative")),
            None => Ok(()),
        }
    }

    /// Whether the levels keep the error that views allow.
    pub(super) fn is_bounded(&self) -> bool {
        matches!(self.choice, LevelChoice::By(Criterion::Error) | LevelChoice::Forced(0))
    }

    /// The criterion; [`Criterion::Error`] for a forced level.
    pub(super) fn criterion(&self) -> &Criterion {
        const ERROR: &Criterion = &Criterion::Error;
        match &self.choice {
            LevelChoice::By(criterion) => criterion,
            LevelChoice::Forced(_) => ERROR,
        }
    }

    /// The transition in effect: [`Transition::Hard`] for a forced level, which never changes.
    pub(super) fn transition(&self) -> Transition {
        match self.choice {
            LevelChoice::By(_) => self.transition,
            LevelChoice::Forced(_) => Transition::Hard,
        }
    }

    /// Threshold per level: the smallest metric at which the level is drawn or begins to morph. Input: the error and the
    /// number of triangles of each level.
    pub(super) fn thresholds(&self, errors: &[f32], triangles: &[u32]) -> Vec<f32> {
        match &self.choice {
            LevelChoice::By(criterion) => self.transition.begins(&criterion.thresholds(errors, triangles)),
            LevelChoice::Forced(level) => {
                let threshold = |of: usize| if of as u32 <= *level { 0.0 } else { f32::MAX };
                (0..errors.len()).map(threshold).collect()
            }
        }
    }

    /// The object `of` in device format, with these settings. `is_ranked` tells whether any object of the scene has a rank.
    pub(super) fn on_device(&self, is_shown: bool, is_ranked: bool, of: LodObject) -> LodObject {
        let (criterion, transition) = (self.criterion(), self.transition());
        let pace = transition.pace();
        let [finer, coarser] = match (pace, transition) {
            (_, Transition::Geomorph) => [1.0; 2],
            (Some(Pace::Band(band)), _) => criterion.band(band),
            _ => criterion.hysteresis(self.hysteresis),
        };
        let seconds = match pace {
            Some(Pace::Seconds(seconds)) => Some(seconds),
            _ => None,
        };
        let [fade_begin, fade_end] = match transition {
            Transition::Alpha { opaque, gone } => {
                [opaque, gone].map(|value| criterion.metric_of(value).unwrap_or(0.0))
            }
            _ => [0.0; 2],
        };
        let flags = object_flags_word(
            is_shown.into(),
            (self.culling == Culling::Never).into(),
            seconds.is_some().into(),
            transition.code(),
            criterion.code(),
        );
        // Thresholds of levels that are never drawn do not count.
        let reached = of.thresholds.as_flattened()[..of.levels as usize].iter().filter(|at| **at < f32::MAX);
        let farthest = reached.fold(0.0, |farthest: f32, threshold| farthest.max(*threshold));
        LodObject {
            metric_scale: self.bias * of.metric_scale,
            metric_floor: farthest * coarser.max(1.0) / FLOOR,
            flags,
            finer,
            coarser,
            rate: seconds.map_or(0.0, |seconds| FADE_PROGRESS as f32 / seconds),
            motion: self.perceptual.motion,
            periphery: self.perceptual.periphery,
            rank: self.rank_on_device(is_ranked),
            fade_begin,
            fade_end,
            point: criterion.point().map_or(of.point, Into::into),
            ..of
        }
    }

    /// The object's rank on the device. If no object of the scene has a rank, all objects have rank 0.
    pub(super) fn rank_on_device(&self, is_ranked: bool) -> u32 {
        if is_ranked { self.rank.map_or(NO_RANK, u32::from) } else { 0 }
    }

    /// Largest factor by which the settings enlarge the displacement that a view allows.
    pub(super) fn largest_factor(&self) -> f32 {
        self.bias * (1.0 + MAX_MOTION * self.perceptual.motion + self.perceptual.periphery)
    }
}
