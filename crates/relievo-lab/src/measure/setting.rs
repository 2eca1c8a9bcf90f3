//! The part of the reports over distances that describes units, camera and frames.

use serde::Serialize;

use crate::measure::stage::Stage;

/// The units, the camera and the frames of a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Setting {
    /// Number of units in the model's largest extent.
    pub size: f32,
    /// Length of a unit in metres of the model.
    pub metres_a_unit: f32,
    /// The gap between neighbours in a grid, in multiples of the model's size.
    pub spacing: f32,
    /// Distances in units: up to the first Ω is 1, from the second on it is 0.
    pub range: [f32; 2],
    /// Number of frames that were measured, after a first frame in full.
    pub frames: u32,
    /// Frames per second.
    pub rate: f64,
    /// The focal length: the size in pixels of a metre at a distance of one metre (1080 lines, 60 degrees).
    pub focal_pixels: f32,
}

impl Setting {
    pub(crate) fn new(stage: &Stage<'_>) -> Self {
        let options = stage.options;
        Self {
            size: options.size,
            metres_a_unit: stage.metres_a_unit,
            spacing: options.spacing,
            range: [options.range.min, options.range.max],
            frames: options.frames,
            rate: options.rate,
            focal_pixels: stage.projection.focal_pixels,
        }
    }
}
