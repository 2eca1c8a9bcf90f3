//! How levels of detail change. The CPU reference of `wgsl/lod/transition.wgsl`.

use super::object::level_within;
use super::{LodObject, OBJECT_LEVELS};
use crate::shared::lod::object::{MORPH_STEPS, decision_word, morph_word, object_flags_transition};
use crate::shared::lod::transition::TRANSITION_GEOMORPH;
#[cfg(feature = "gpu")]
use crate::shared::lod::transition::TRANSITION_HARD;

/// How far the surface between two levels may be off, as a multiple of the coarser one's error: an allowance from
/// measurements, not a bound (`docs/pixel-bounds.md`).
#[cfg(feature = "gpu")]
const ON_THE_WAY: f32 = 1.2;

/// How the levels of detail of an object's instances change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Transition {
    /// At once, as soon as a coarser level's error is allowed.
    #[default]
    Hard,
    /// By a geomorph: the vertices of a level move to their partners in the next coarser one
    /// ([`Mesh::partners`](crate::asset::Mesh::partners)), the further the more is allowed, in each view by itself. Once they
    /// are there, the picture is the coarser level's, and stays so where levels change.
    ///
    /// A level begins to move where 1.2 times the error of the coarser one is allowed, and has arrived where 1.2 times the error
    /// of the one after it is. The factor is for the surface between two levels, which may be further off than either:
    /// `docs/pixel-bounds.md` has how far. So the level that is drawn is finer by one to two than with [`Transition::Hard`]: it
    /// costs about 1.7 times the triangles, and of each vertex two are loaded. The motion of vertices is part of their velocities ([`Layer::Velocity`](crate::render::Layer::Velocity)):
    /// where the level of the last frame was another one, a vertex was at its own place if that level was finer, and at that of
    /// the vertex which stood for it if it was coarser. An instance that the view did not show in the last frame counts as if
    /// its level had been as it is, and so do all in the first frame after objects were added, removed or grew. One that takes the place of another, which was
    /// removed since the last frame, counts as if it had had that one's level.
    Geomorph,
}

impl Transition {
    /// Both, by the names that scene files and the command line have for them.
    pub const NAMES: [(&'static str, Self); 2] = [("hard", Self::Hard), ("geomorph", Self::Geomorph)];

    /// Its code in an object's flags.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(self) -> u32 {
        match self {
            Self::Hard => TRANSITION_HARD,
            Self::Geomorph => TRANSITION_GEOMORPH,
        }
    }

    /// From the thresholds of an object's levels, ascending from 0: the metric from which on each level is drawn. With a
    /// geomorph it begins to move there, [`ON_THE_WAY`] times the error of the next one, and level 0, which is drawn before,
    /// too. The last level then begins at twice as much.
    #[cfg(feature = "gpu")]
    pub(crate) fn begins(self, errors: &[f32]) -> Vec<f32> {
        match (self, errors.last()) {
            (Self::Geomorph, Some(last)) => {
                let next = errors.iter().skip(1).copied().chain([2.0 * last]);
                next.map(|error| ON_THE_WAY * error).collect()
            }
            _ => errors.to_vec(),
        }
    }
}

/// The morph word of a level of an object: the level and how many of [`MORPH_STEPS`]; 0 where it has not moved.
pub fn morph_within(object: &LodObject, level: u32, metric: f32) -> u32 {
    let errors = object.errors.as_flattened();
    let begin = errors[level as usize];
    if object_flags_transition(object.flags) != TRANSITION_GEOMORPH
        || level + 1 >= object.levels.min(OBJECT_LEVELS)
        || metric <= begin
    {
        return 0;
    }
    let way = ((metric - begin) / (errors[level as usize + 1] - begin)).min(1.0);
    let steps = (MORPH_STEPS as f32 * way + 0.5) as u32;
    if steps > 0 { morph_word(level, steps) } else { 0 }
}

/// The decision for an instance that a view sees: 1 + 2 · level + mirrored, and [`morph_within`].
pub fn decision(object: &LodObject, is_mirrored: bool, metric: f32) -> u32 {
    let level = level_within(object.levels, &object.errors, metric);
    decision_word(1 + 2 * level + u32::from(is_mirrored), morph_within(object, level, metric))
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;

    #[test]
    fn a_level_moves_once_the_next_one_is_allowed() {
        let errors = [0.0, 0.1, 0.2, 0.4];
        assert_eq!(Transition::Hard.begins(&errors), errors);
        assert_eq!(Transition::Geomorph.begins(&errors), [0.1, 0.2, 0.4, 0.8].map(|error| 1.2 * error));
        assert_eq!([Transition::Hard, Transition::Geomorph].map(Transition::code), [0, 1]);
    }
}
