//! The options of all measurements, with their ranges.

use std::collections::BTreeMap;
use std::fmt;

use relievo::InputError;
use relievo::asset::{Clip, Model};
use relievo::ops::animation::{Range, Weights};
use relievo::scene::SkeletonTier;
use serde::{Serialize, Serializer};

use crate::measure::bounds::check;
use crate::measure::gates::GateMode;

/// Height of the picture, in pixels.
pub(crate) const LINES: u32 = 1080;

/// Width and height of the picture, in pixels.
pub(crate) const PICTURE: [u32; 2] = [LINES * 16 / 9, LINES];

/// The vertical field of view, in radians.
pub(crate) const FIELD_OF_VIEW: f32 = std::f32::consts::FRAC_PI_3;

/// Colour of the background, in linear light.
pub(crate) const SKY: [f32; 3] = [0.02, 0.025, 0.03];

/// Distance of the near plane, in units.
pub(crate) const NEAR: f32 = 1.0;

/// The largest number of frames: 32 bits of ticks hold them at any rate.
const MAX_FRAMES: u32 = 100_000;

/// Number of distances of the default sweep.
const SWEEP: u32 = 7;

/// The model and the clip that are measured.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The model's name in reports.
    pub name: &'a str,
    /// The model.
    pub model: &'a Model,
    /// The index of the clip among the model's clips.
    pub clip: usize,
}

impl<'a> Subject<'a> {
    /// The clip, if the model has it.
    pub(crate) fn clip(&self) -> Result<&'a Clip, InputError> {
        let clips = &self.model.clips;
        let bound = || format!("must be below {}, as many clips as the model has", clips.len());
        clips.get(self.clip).ok_or_else(|| InputError::new("subject.clip", self.clip, bound()))
    }

    /// A copy of the model that has this clip alone, with index 0.
    pub(crate) fn with_one_clip(&self) -> Result<Model, InputError> {
        let clip = self.clip()?.clone();
        let mut model = self.model.clone();
        model.clips = vec![clip];
        for mesh in &mut model.meshes {
            mesh.weight_keys.retain(|(of, _)| *of == self.clip);
            mesh.weight_keys.iter_mut().for_each(|(of, _)| *of = 0);
        }
        Ok(model)
    }
}

/// How a crowd stands before the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Rows and columns that face the camera.
    Grid,
    /// Random positions and angles, in the same square.
    Random,
}

/// A crowd of one model in one clip. [`size`](Self::size) defines how long a *unit* is.
#[derive(Debug, Clone, PartialEq)]
pub struct CrowdOptions {
    /// Number of instances, in 1..=100000. Default: 100.
    pub instances: usize,
    /// How instances are placed. Default: [`Layout::Grid`].
    pub layout: Layout,
    /// Seed of random positions and start times; another number gives another crowd. Default: 0.
    pub seed: u32,
    /// Number of units in the largest extent of the model at rest, in 0.001..=1e6. Default: 180, so that the
    /// units of a person are centimetres.
    pub size: f32,
    /// The gap between neighbours in a grid, in multiples of the model's size, in 0..=1000. Default: 0.5.
    pub spacing: f32,
    /// The distances in units between which Ω falls from 1 to 0. Default: 200 to 1700, as in A.
    pub range: Range,
    /// Number of frames to measure, after a first frame in full, in 1..=100000. Default: 240.
    pub frames: u32,
    /// Frames per second, in 1..=1000. Default: 60.
    pub rate: f64,
    /// The caller's priority of bones by name or index, 0 to 1; all other bones have 0.5. No gate skips a bone of priority 1
    /// ([`CharacterOptions::priorities`](relievo::scene::CharacterOptions::priorities)). Default: none.
    pub priorities: BTreeMap<String, f32>,
}

impl Default for CrowdOptions {
    fn default() -> Self {
        Self {
            instances: 100,
            layout: Layout::Grid,
            seed: 0,
            size: 180.0,
            spacing: 0.5,
            range: Range { min: 200.0, max: 1700.0 },
            frames: 240,
            rate: 60.0,
            priorities: BTreeMap::new(),
        }
    }
}

impl CrowdOptions {
    /// Checks all options.
    ///
    /// # Errors
    /// [`InputError`] for an option out of its range.
    pub fn validate(&self) -> Result<(), InputError> {
        check("size", self.size.into(), 1e-3..=1e6)?;
        check("spacing", self.spacing.into(), 0.0..=1e3)?;
        check("rate", self.rate, 1.0..=1000.0)?;
        check("instances", self.instances as f64, 1.0..=1e5)?;
        check("frames", f64::from(self.frames), 1.0..=f64::from(MAX_FRAMES))?;
        for (bone, priority) in &self.priorities {
            check(&format!("priorities.{bone}"), (*priority).into(), 0.0..=1.0)?;
        }
        self.range.validate()
    }

    /// Seven distances in units, evenly spaced from one end of the range to the other.
    pub fn sweep(&self) -> Vec<f32> {
        let Range { min, max } = self.range;
        let at = |step: u32| min + (max - min) * step as f32 / (SWEEP - 1) as f32;
        (0..SWEEP).map(|step| at(step).max(NEAR)).collect()
    }
}

/// A crowd under a gate, at several distances.
#[derive(Debug, Clone, PartialEq)]
pub struct LodOptions {
    /// The crowd.
    pub crowd: CrowdOptions,
    /// The gate to measure. Default: [`GateMode::Bounded`] with one pixel.
    pub gate: GateMode,
    /// Distances from the camera to the nearest instance in units, each in 1..=1e6; at least one. Default:
    /// [`CrowdOptions::sweep`].
    pub distances: Vec<f32>,
}

impl Default for LodOptions {
    fn default() -> Self {
        let crowd = CrowdOptions::default();
        Self { distances: crowd.sweep(), crowd, gate: GateMode::Bounded { pixels: 1.0 } }
    }
}

impl LodOptions {
    /// Checks all options.
    ///
    /// # Errors
    /// [`InputError`] for an option out of its range.
    pub fn validate(&self) -> Result<(), InputError> {
        self.crowd.validate()?;
        self.gate.validate()?;
        if self.distances.is_empty() {
            return Err(InputError::new("distances.len", 0, "must be at least 1"));
        }
        (self.distances.iter().enumerate()).try_for_each(|(at, distance)| {
            check(&format!("distances[{at}]"), (*distance).into(), f64::from(NEAR)..=1e6)
        })
    }
}

/// How much of the influences of vertices, or of the triangles of meshes, is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Detail {
    /// All of them.
    Full,
    /// Influences fade only as far as that takes no vertex further away than a number of pixels; meshes have the coarsest level
    /// of detail whose surface is no further off.
    Bounded {
        /// The number of pixels, in 0..=1e6.
        pixels: f32,
    },
    /// Of meshes: the same, but levels move into each other
    /// ([`Transition::Geomorph`](relievo::scene::Transition::Geomorph)).
    Geomorph {
        /// The number of pixels, in 0..=1e6.
        pixels: f32,
    },
    /// Of influences: the strongest of each vertex. Their error is not bounded.
    Truncated {
        /// Largest number of influences per vertex, in 1..=8.
        most: u32,
    },
    /// Of influences: all at the nearer distance of [`CrowdOptions::range`], one at its farther distance. Their error is not
    /// bounded.
    Faded,
}

impl Detail {
    /// The number of pixels by which what is drawn may be off.
    pub fn pixels(self) -> f32 {
        match self {
            Self::Full | Self::Truncated { .. } | Self::Faded => 0.0,
            Self::Bounded { pixels } | Self::Geomorph { pixels } => pixels,
        }
    }
}

impl fmt::Display for Detail {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full"),
            Self::Bounded { pixels } => write!(f, "bounded:{pixels}"),
            Self::Geomorph { pixels } => write!(f, "geomorph:{pixels}"),
            Self::Truncated { most } => write!(f, "truncate:{most}"),
            Self::Faded => f.write_str("fade"),
        }
    }
}

impl Serialize for Detail {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// How a crowd is skinned and drawn. Its scene permits the sum of these pixels and those of the gate, and divides them by
/// [`ErrorBudget`](relievo::scene::ErrorBudget) in proportion.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnOptions {
    /// The influences that vertices follow; no geomorph. Default: those that half a pixel permits.
    pub skinning: Detail,
    /// The triangles that meshes have. Default: those that half a pixel permits.
    pub mesh: Detail,
    /// Reduced skeletons, used wherever the gate is ([`CharacterOptions::tiers`](relievo::scene::CharacterOptions::tiers)).
    /// Default: none.
    pub tiers: Vec<SkeletonTier>,
}

impl Default for DrawnOptions {
    fn default() -> Self {
        let half = Detail::Bounded { pixels: 0.5 };
        Self { skinning: half, mesh: half, tiers: Vec::new() }
    }
}

impl DrawnOptions {
    /// Checks both options.
    ///
    /// # Errors
    /// [`InputError`] for pixels or a number of influences out of their range, for influences with a geomorph, and for meshes with
    /// a method of influences.
    pub fn validate(&self) -> Result<(), InputError> {
        if let Detail::Geomorph { .. } = self.skinning {
            return Err(InputError::new("skinning", self.skinning, "must not be a geomorph"));
        }
        if let Detail::Truncated { most } = self.skinning {
            check("skinning.most", most.into(), 1.0..=8.0)?;
        }
        if let Detail::Truncated { .. } | Detail::Faded = self.mesh {
            return Err(InputError::new("mesh", self.mesh, "must be full, bounded or a geomorph"));
        }
        check("skinning.pixels", self.skinning.pixels().into(), 0.0..=1e6)?;
        check("mesh.pixels", self.mesh.pixels().into(), 0.0..=1e6)
    }
}

/// Options of the comparison of every gate at many settings, with all instances at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct ParetoOptions {
    /// The crowd; its layout, spacing and range are not used. Default: 25 instances.
    pub crowd: CrowdOptions,
    /// Period of [`GateMode::SkipPeriod`] in seconds, in 0..=65535. Default: 1.
    pub period: f64,
    /// Weights of the priorities of [`GateMode::SkipPeriod`]. Default: all equal.
    pub weights: Weights,
    /// Size on screen of the model's largest extent in pixels, in 1..=10000. Default: 100.
    pub tall_pixels: f32,
}

impl Default for ParetoOptions {
    fn default() -> Self {
        let crowd = CrowdOptions { instances: 25, ..CrowdOptions::default() };
        Self { crowd, period: 1.0, weights: Weights::default(), tall_pixels: 100.0 }
    }
}

impl ParetoOptions {
    /// Checks all options.
    ///
    /// # Errors
    /// [`InputError`] for an option out of its range.
    pub fn validate(&self) -> Result<(), InputError> {
        self.crowd.validate()?;
        GateMode::SkipPeriod { period: self.period, weights: self.weights }.validate()?;
        check("tall_pixels", self.tall_pixels.into(), 1.0..=1e4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeps_have_both_ends() {
        let sweep = |min, max| CrowdOptions { range: Range { min, max }, ..CrowdOptions::default() }.sweep();
        assert_eq!(sweep(200.0, 1700.0)[..2], [200.0, 450.0]);
        assert_eq!(sweep(0.0, 6.0), [1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }
}
