//! What all reports over distances say of how a crowd was looked at.

use serde::Serialize;

use super::stage::Stage;

/// How a crowd was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Setting {
    /// Units that the model's largest extent counts.
    pub size: f32,
    /// The model's metres that a unit is.
    pub metres_a_unit: f32,
    /// Between neighbours of a grid, in sizes of the model.
    pub spacing: f32,
    /// Units up to which Ω is 1, and from which on it is 0.
    pub range: [f32; 2],
    /// Frames that were measured, after a first one that is full.
    pub frames: u32,
    /// Frames a second.
    pub rate: f64,
    /// Pixels that a metre at a distance of one metre takes: 1080 lines, 60 degrees.
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
