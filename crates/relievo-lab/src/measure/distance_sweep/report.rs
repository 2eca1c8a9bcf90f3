//! The report of a sweep.

use relievo::ops::animation::Weights;
use relievo::scene::StageTimes;
use serde::Serialize;

use crate::harness::TimedBy;
use crate::measure::distance_sweep::options::GroupLayout;
use crate::measure::gates::GateName;

/// What a sweep found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DistanceSweepReport {
    /// The device's adapter.
    pub adapter: String,
    /// The device's driver.
    pub driver: String,
    /// The clock of [`SweepRow::update_milliseconds`]: the device's for the stages and the host's for the recording
    /// (`timestamp`), or, on a device without timestamps, the host's alone (`wall`).
    pub timed_by: TimedBy,
    /// The model's name.
    pub model: String,
    /// The clip's name.
    pub clip: String,
    /// Number of instances.
    pub instances: usize,
    /// Number of bones of an instance.
    pub bones: usize,
    /// Number of bones of an instance that the clip moves.
    pub animated_bones: usize,
    /// Number of vertices of an instance.
    pub vertices: usize,
    /// The seed of the start times and the random places.
    pub seed: u32,
    /// Number of units in the model's largest extent.
    pub size: f32,
    /// Distance in units between neighbours in the grid.
    pub spacing: f32,
    /// Length in units of an edge of the cube.
    pub edge: f32,
    /// Distances in units: up to the first Ω is 1, from the second on it is 0.
    pub range: [f32; 2],
    /// Seconds between two skipped updates at priority 1 and Ω = 1.
    pub period: f32,
    /// Weights of the six terms of priorities.
    pub weights: Weights,
    /// The largest error in pixels that `bounded` may show.
    pub pixels: f32,
    /// Frames per second of the scene's time.
    pub rate: f64,
    /// Number of frames of a row that were timed and counted.
    pub frames: u32,
    /// Number of frames of a row whose errors were measured.
    pub error_frames: u32,
    /// Largest number of visible instances whose errors were measured in a frame.
    pub measured: usize,
    /// Number of frames of a row that were drawn and timed as a whole; 0 if nothing was drawn.
    pub drawn_frames: u32,
    /// Width and height of the picture in pixels.
    pub picture: [u32; 2],
    /// One entry per layout.
    pub layouts: Vec<SweepLayout>,
}

/// The measurements of one layout.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepLayout {
    /// The layout.
    pub layout: GroupLayout,
    /// One row per distance and mode: for each distance, the modes in the order of
    /// [`SWEEP_MODES`](super::SWEEP_MODES).
    pub rows: Vec<SweepRow>,
}

/// One mode at one distance. Times are lower quartiles over frames, because other programs on the machine only lengthen them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SweepRow {
    /// Distance in units from the camera to the group's centre.
    pub distance: f32,
    /// The mode.
    pub mode: GateName,
    /// Number of instances that the view drew. Instances out of view are updated in no mode.
    pub visible: u32,
    /// Number of bones that were interpolated between keyframes, a frame (mean).
    pub interpolated: f64,
    /// Interpolated bones, divided by the bones of visible instances that the clip moves; 0 if nothing is visible.
    pub fraction: f64,
    /// The host's time for recording the frame's compute work, in milliseconds.
    pub record_milliseconds: f64,
    /// The device's time of each stage; missing on a device without timestamps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stages: Option<StageTimes>,
    /// Time of the bones' update in milliseconds: the recording, and the stages that choose, sample and concatenate bones. On a
    /// device without timestamps, recording and execution of all compute work, with culling and skinning.
    pub update_milliseconds: f64,
    /// Updates per second: 1000 / [`update_milliseconds`](Self::update_milliseconds).
    pub update_rate: f64,
    /// Time of a whole frame in milliseconds, from the start of its recording until the device has drawn it; missing if nothing
    /// was drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame_milliseconds: Option<f64>,
    /// Whole frames per second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame_rate: Option<f64>,
    /// How far points that follow bones were from where full evaluation puts them.
    pub error: SweepError,
}

/// Errors of points on the axes of bones, at the distance of the furthest vertex that follows the bone, inside the picture.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct SweepError {
    /// The largest error on screen, in pixels.
    pub max_pixels: f64,
    /// The root mean square on screen, in pixels.
    pub rms_pixels: f64,
    /// The largest error in space, in units.
    pub max_units: f64,
    /// Number of points, summed over instances and frames.
    pub points: u64,
}
