//! The options of the sweep, with their ranges.

use relievo::InputError;
use relievo::ops::animation::{Range, Weights};
use relievo::scene::BoneGate;
use serde::Serialize;

use crate::measure::bounds::check;
use crate::measure::gates::GateName;

/// The modes that a sweep compares, in the order of its rows: no level of detail, A's two methods (sections 10 and 12.10), and
/// the error bound.
pub const SWEEP_MODES: [GateName; 4] =
    [GateName::Off, GateName::Uniform, GateName::SkipPeriod, GateName::Bounded];

/// Largest number of instances whose errors are measured in a frame.
const MAX_MEASURED: usize = 1000;

/// How a group of models stands around its centre.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum GroupLayout {
    /// Rows and columns on the ground. All models face the camera.
    Grid,
    /// Random positions in a cube, each turned by a random angle about the vertical axis.
    Cube,
}

impl GroupLayout {
    /// Both layouts, in the order of A's two tests.
    pub const ALL: [Self; 2] = [Self::Grid, Self::Cube];

    /// The name as reports have it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Cube => "cube",
        }
    }
}

/// Options of [`distance_sweep`](super::distance_sweep). Distances are in units, of which the model's largest extent at rest has
/// [`size`](Self::size).
#[derive(Debug, Clone, PartialEq)]
pub struct DistanceSweepOptions {
    /// Number of instances, in 1..=10000. Default: 100, as in A.
    pub instances: usize,
    /// Seed of the start times, and of the positions and turns in the cube; another number gives another group. Default: 0.
    pub seed: u32,
    /// Number of units in the largest extent of the model at rest, in 0.001..=1e6. Default: 180, so that the units of a person
    /// are centimetres.
    pub size: f32,
    /// Distance in units between neighbours in the grid, in 0..=1e6. Default: 55. The last row of a 10 × 10 grid is then 248
    /// units behind its centre, and its corners pass 1,700 units when the camera is 1,434 units from the centre: between the
    /// 1,400 and 1,500 that A reports.
    pub spacing: f32,
    /// Length in units of an edge of the cube, in 0..=1e6. Default: 1000. Models are then up to 866 units from a camera in
    /// the centre, which is beyond the 200 from which Ω falls, as A describes.
    pub edge: f32,
    /// Distances in units between which Ω falls from 1 to 0. Default: 200 to 1700, as in A.
    pub range: Range,
    /// For [`GateName::SkipPeriod`]: seconds between two skipped updates at priority 1 and Ω = 1, above 0, at most 65535.
    /// Default: 1, as in A.
    pub period: f32,
    /// For [`GateName::SkipPeriod`]: weights of the six terms of a bone's priority. Default: all 1/6, as in A.
    pub weights: Weights,
    /// For [`GateName::Bounded`]: the largest error that may show, in pixels, in 0..=1e6. Default: 1.
    pub pixels: f32,
    /// Distances in units from the camera to the group's centre, in the order of the sweep, each in 0..=1e6; at least one.
    /// Default: 0 to 2,400, the last of which is beyond the range for every model of both groups.
    pub distances: Vec<f32>,
    /// Number of frames that are timed and counted for each distance and mode, in 1..=10000. Default: 30.
    pub frames: u32,
    /// Number of frames whose errors are measured for each distance and mode, in 1..=10000. They follow the timed ones. Default:
    /// 10.
    pub error_frames: u32,
    /// Number of frames that are drawn and timed as a whole for each distance and mode, in 0..=10000. Default: 5. 0 draws
    /// nothing.
    pub drawn_frames: u32,
    /// Frames per second of the scene's time, in 1..=1000. Default: 60.
    pub rate: f64,
    /// Largest number of visible instances whose errors are measured in a frame, in 1..=1000. Default: 16.
    pub measured: usize,
}

impl Default for DistanceSweepOptions {
    fn default() -> Self {
        Self {
            instances: 100,
            seed: 0,
            size: 180.0,
            spacing: 55.0,
            edge: 1000.0,
            range: Range { min: 200.0, max: 1700.0 },
            period: 1.0,
            weights: Weights::default(),
            pixels: 1.0,
            distances: Self::DISTANCES.to_vec(),
            frames: 30,
            error_frames: 10,
            drawn_frames: 5,
            rate: 60.0,
            measured: 16,
        }
    }
}

impl DistanceSweepOptions {
    /// The distances of the default sweep, in units.
    pub const DISTANCES: [f32; 15] = [
        0.0, 100.0, 200.0, 400.0, 600.0, 800.0, 1000.0, 1200.0, 1400.0, 1500.0, 1600.0, 1800.0, 2000.0,
        2200.0, 2400.0,
    ];

    /// Checks all options.
    ///
    /// # Errors
    /// [`InputError`] for an option out of its range.
    pub fn validate(&self) -> Result<(), InputError> {
        check("instances", self.instances as f64, 1.0..=1e4)?;
        check("size", self.size.into(), 1e-3..=1e6)?;
        check("spacing", self.spacing.into(), 0.0..=1e6)?;
        check("edge", self.edge.into(), 0.0..=1e6)?;
        check("pixels", self.pixels.into(), 0.0..=1e6)?;
        for (field, frames, least) in [
            ("frames", self.frames, 1.0),
            ("error_frames", self.error_frames, 1.0),
            ("drawn_frames", self.drawn_frames, 0.0),
        ] {
            check(field, frames.into(), least..=1e4)?;
        }
        check("rate", self.rate, 1.0..=1000.0)?;
        check("measured", self.measured as f64, 1.0..=MAX_MEASURED as f64)?;
        check("period", self.period.into(), f64::from(f32::MIN_POSITIVE)..=65_535.0)?;
        self.range.validate()?;
        self.weights.validate()?;
        if self.distances.is_empty() {
            return Err(InputError::new("distances.len", 0, "must be at least 1"));
        }
        (self.distances.iter().enumerate())
            .try_for_each(|(at, distance)| check(&format!("distances[{at}]"), (*distance).into(), 0.0..=1e6))
    }

    /// The gate of one of [`SWEEP_MODES`]. World units are the options' units.
    pub(super) fn gate(&self, mode: GateName) -> BoneGate {
        match mode {
            GateName::Uniform => BoneGate::Uniform(self.range),
            GateName::SkipPeriod => {
                BoneGate::SkipPeriod { range: self.range, period: self.period, weights: Some(self.weights) }
            }
            GateName::Bounded => BoneGate::Bounded,
            _ => BoneGate::Off,
        }
    }

    /// Distance in units from the group's centre to its front, along the camera's way. When the camera is this much further away
    /// than the range's maximum, Ω is 0 for every model.
    pub fn half_depth(&self, layout: GroupLayout) -> f32 {
        match layout {
            GroupLayout::Grid => 0.5 * self.spacing * (grid(self.instances)[1] - 1) as f32,
            GroupLayout::Cube => 0.5 * self.edge,
        }
    }
}

/// Numbers of columns and rows of a grid.
pub(super) fn grid(instances: usize) -> [usize; 2] {
    let columns = (instances as f64).sqrt().ceil() as usize;
    [columns, instances.div_ceil(columns)]
}
