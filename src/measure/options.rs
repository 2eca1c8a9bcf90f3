//! What is measured, and how: checked before anything is.

use std::fmt;

use serde::{Serialize, Serializer};

use super::bounds::check;
use super::gates::GateMode;
use crate::InputError;
use crate::animation::{Range, Weights};
use crate::asset::{Clip, Model};

/// The near plane, in units.
pub(crate) const NEAR: f32 = 1.0;

/// The most frames: 32 bits of ticks hold them at any rate.
const MAX_FRAMES: u32 = 100_000;

/// Distances of the default sweep.
const SWEEP: u32 = 7;

/// What plays.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// What reports call it.
    pub name: &'a str,
    /// The model.
    pub model: &'a Model,
    /// Which of its clips.
    pub clip: usize,
}

impl<'a> Subject<'a> {
    /// The clip.
    pub(crate) fn clip(&self) -> Result<&'a Clip, InputError> {
        let clips = &self.model.clips;
        let bound = || format!("must be below {}, as many clips as the model has", clips.len());
        clips.get(self.clip).ok_or_else(|| InputError::new("subject.clip", self.clip, bound()))
    }
}

/// How a crowd stands before the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Rows and columns that face the camera.
    Grid,
    /// Anywhere in the same square, turned any way.
    Random,
}

/// A crowd of one model in one clip. A *unit* is what [`size`](Self::size) makes it.
#[derive(Debug, Clone, PartialEq)]
pub struct CrowdOptions {
    /// How many, in 1..=100000. Default: 100.
    pub instances: usize,
    /// How they stand. Default: [`Layout::Grid`].
    pub layout: Layout,
    /// Another number gives other places and moments. Default: 0.
    pub seed: u32,
    /// Units that the largest extent of the model at rest counts, in 0.001..=1e6. Default: 180, a person in centimetres.
    pub size: f32,
    /// Between neighbours of a grid, in sizes of the model, in 0..=1000. Default: 0.5.
    pub spacing: f32,
    /// Units between which Ω falls from 1 to 0. Default: 200 to 1700, as A has it.
    pub range: Range,
    /// Frames that are measured, after a first one that is full, in 1..=100000. Default: 240.
    pub frames: u32,
    /// Frames a second, in 1..=1000. Default: 60.
    pub rate: f64,
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
        }
    }
}

impl CrowdOptions {
    /// Checks all of it.
    ///
    /// # Errors
    /// [`InputError`] for what is out of its bounds.
    pub fn validate(&self) -> Result<(), InputError> {
        check("size", self.size.into(), 1e-3..=1e6)?;
        check("spacing", self.spacing.into(), 0.0..=1e3)?;
        check("rate", self.rate, 1.0..=1000.0)?;
        check("instances", self.instances as f64, 1.0..=1e5)?;
        check("frames", f64::from(self.frames), 1.0..=f64::from(MAX_FRAMES))?;
        self.range.validate()
    }

    /// Seven distances in units, from one end of the range to the other.
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
    /// Who decides. Default: [`GateMode::Bounded`] with one pixel.
    pub gate: GateMode,
    /// Units from the camera to the nearest instance, each in 1..=1e6; at least one. Default: [`CrowdOptions::sweep`].
    pub distances: Vec<f32>,
}

impl Default for LodOptions {
    fn default() -> Self {
        let crowd = CrowdOptions::default();
        Self { distances: crowd.sweep(), crowd, gate: GateMode::Bounded { pixels: 1.0 } }
    }
}

impl LodOptions {
    /// Checks all of it.
    ///
    /// # Errors
    /// [`InputError`] for what is out of its bounds.
    pub fn validate(&self) -> Result<(), InputError> {
        self.crowd.validate()?;
        self.gate.validate()?;
        if self.distances.is_empty() {
            return Err(InputError::new("distance", "nothing", "must be at least one"));
        }
        self.distances
            .iter()
            .try_for_each(|distance| check("distance", (*distance).into(), f64::from(NEAR)..=1e6))
    }
}

/// Which bones vertices follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SkinningDetail {
    /// All of theirs.
    Full,
    /// The strongest alone.
    Truncate {
        /// How many, 1 to 4.
        max_influences: u32,
    },
    /// All at the first of the [`range`](CrowdOptions::range)'s distances, one from the second on.
    Fade,
    /// As many as it takes for no vertex to be further off.
    Bounded {
        /// How far, in 0..=1e6.
        pixels: f32,
    },
}

/// Which triangles meshes have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeshDetail {
    /// All of theirs.
    Full,
    /// As few as it takes for no surface to be further off.
    Bounded {
        /// How far, in 0..=1e6.
        pixels: f32,
    },
}

/// How a crowd is skinned and drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnOptions {
    /// Default: half a pixel.
    pub skinning: SkinningDetail,
    /// Default: half a pixel.
    pub mesh: MeshDetail,
}

impl Default for DrawnOptions {
    fn default() -> Self {
        let pixels = 0.5;
        Self { skinning: SkinningDetail::Bounded { pixels }, mesh: MeshDetail::Bounded { pixels } }
    }
}

impl DrawnOptions {
    /// Checks both.
    ///
    /// # Errors
    /// [`InputError`] for pixels or influences out of their bounds.
    pub fn validate(&self) -> Result<(), InputError> {
        match self.skinning {
            SkinningDetail::Truncate { max_influences } => {
                crate::skinning::instance_lod::InstanceLod::truncate(max_influences).map(drop)?;
            }
            SkinningDetail::Bounded { pixels } => check("skinning", pixels.into(), 0.0..=1e6)?,
            SkinningDetail::Full | SkinningDetail::Fade => {}
        }
        match self.mesh {
            MeshDetail::Bounded { pixels } => check("mesh", pixels.into(), 0.0..=1e6),
            MeshDetail::Full => Ok(()),
        }
    }
}

/// Every gate at every setting, of instances at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct ParetoOptions {
    /// The crowd, whose layout, spacing and range do not matter. Default: 25 instances.
    pub crowd: CrowdOptions,
    /// Seconds of [`GateMode::SkipPeriod`], in 0..=65535. Default: 1.
    pub period: f64,
    /// Of the same. Default: all alike.
    pub weights: Weights,
    /// Pixels that the model's largest extent takes, in 1..=10000. Default: 100.
    pub tall_pixels: f32,
}

impl Default for ParetoOptions {
    fn default() -> Self {
        let crowd = CrowdOptions { instances: 25, ..CrowdOptions::default() };
        Self { crowd, period: 1.0, weights: Weights::default(), tall_pixels: 100.0 }
    }
}

impl ParetoOptions {
    /// Checks all of it.
    ///
    /// # Errors
    /// [`InputError`] for what is out of its bounds.
    pub fn validate(&self) -> Result<(), InputError> {
        self.crowd.validate()?;
        GateMode::SkipPeriod { period: self.period, weights: self.weights }.validate()?;
        check("tall", self.tall_pixels.into(), 1.0..=1e4)
    }
}

impl fmt::Display for SkinningDetail {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full"),
            Self::Truncate { max_influences } => write!(f, "truncate:{max_influences}"),
            Self::Fade => f.write_str("fade"),
            Self::Bounded { pixels } => write!(f, "bounded:{pixels}"),
        }
    }
}

impl fmt::Display for MeshDetail {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full"),
            Self::Bounded { pixels } => write!(f, "bounded:{pixels}"),
        }
    }
}

impl Serialize for SkinningDetail {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Serialize for MeshDetail {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
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
