//! The levels of detail of a character.

use relievo::ops::skinning::Merged;
use serde::Serialize;

/// A level of detail of a character, all meshes together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LevelReport {
    /// Number of triangles of the level.
    pub triangles: usize,
    /// The largest distance between the level and the model itself, in metres of the model.
    pub error_metres: f32,
}

impl LevelReport {
    /// The levels of merged meshes, beginning with the model itself.
    pub(crate) fn of(merged: &Merged) -> Vec<Self> {
        let triangles = |level: usize| {
            let parts = merged.parts.iter().filter_map(|part| part.indices.get(level));
            parts.map(|range| range.len() / 3).sum()
        };
        let errors = std::iter::once(0.0).chain(merged.errors.iter().copied());
        errors.enumerate().map(|(at, error_metres)| Self { triangles: triangles(at), error_metres }).collect()
    }
}
