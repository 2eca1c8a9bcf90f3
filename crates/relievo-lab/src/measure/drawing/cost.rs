//! What drawing a crowd costs, and what its level of detail shows.

use relievo::ops::lod::OBJECT_LEVELS;
use serde::Serialize;

use crate::measure::displacement::Displacement;
use crate::measure::frames::DrawnLevel;

/// The cost of animating, skinning and drawing a crowd by a scene, and how far what is drawn lies from its place. Times are
/// medians over the frames that were timed; the rest is of the frames that were measured, which are two pairs of
/// successive ones in a run of at least 8.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameCost {
    /// The pixels that are permitted.
    pub pixels: f32,
    /// The time of what the scene records and of the drawing in one submission.
    pub frame_nanoseconds: f64,
    /// The time of what the scene records, submitted alone: culling, levels, gate, sampling, concatenation and skinning.
    pub compute_nanoseconds: f64,
    /// The time of the drawing, submitted alone.
    pub draw_nanoseconds: f64,
    /// Number of bones that were interpolated, the mean of the frames that were measured.
    pub bones: f64,
    /// Number of clusters of up to 64 vertices that were skinned, the mean of the frames that were measured.
    pub clusters: f64,
    /// Share of all clusters that were skinned, 0 to 1.
    pub skinned_fraction: f64,
    /// Number of triangles that were drawn, divided by those of all instances in full detail.
    pub triangle_fraction: f64,
    /// What the last frame that was measured drew, level by level; levels that the character lacks are empty.
    pub levels: [DrawnLevel; OBJECT_LEVELS as usize],
    /// How far up to 16 instances, spread over the crowd, were drawn from their place: the largest figures of all frames that
    /// were measured, and their sums of samples and instances.
    pub displacement: Displacement,
}
