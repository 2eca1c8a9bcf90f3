//! Transitions between levels of detail. CPU reference of `wgsl/lod/transition.wgsl`.

use super::object::level_within;
use super::{LodObject, OBJECT_LEVELS};
use crate::shared::lod::object::{MORPH_STEPS, decision_word, morph_word, object_flags_transition};
use crate::shared::lod::transition::TRANSITION_GEOMORPH;
#[cfg(feature = "gpu")]
use crate::shared::lod::transition::TRANSITION_HARD;

/// Error allowance for a surface between two levels, as a multiple of the coarser level's error. It comes from
/// measurements and is not a bound (`docs/pixel-bounds.md`).
#[cfg(feature = "gpu")]
const ON_THE_WAY: f32 = 1.2;

/// How an object's instances change from one level of detail to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Transition {
    /// At once, when a coarser level's error is allowed.
    #[default]
    Hard,
    /// By a geomorph: the vertices of a level move towards their partners in the next coarser level
    /// ([`Mesh::partners`](crate::asset::Mesh::partners)).
    ///
    /// The larger the allowed displacement, the further they move, in each view on its own. At the partners' positions
    /// the picture equals that of the coarser level, so the level change itself is invisible.
    ///
    /// A level begins to move when 1.2 times the next level's error is allowed. It arrives when 1.2 times the error of
    /// the level after that is allowed. The factor covers the surface between two levels, whose error may exceed that
    /// of both (figures in `docs/pixel-bounds.md`). The drawn level is therefore one to two levels finer than with
    /// [`Transition::Hard`]. This costs about 1.7 times the triangles, and two loads per vertex.
    ///
    /// Vertex motion is part of velocity ([`Layer::Velocity`](crate::render::Layer::Velocity)). If the level of the
    /// last frame was finer, a vertex was at its own place; if it was coarser, at the place of the vertex that stood in
    /// for it. Where the last level is unknown, the current one counts: for an instance that the view did not show in
    /// the last frame, and for all instances in the first frame after objects were added, removed or grew. An instance
    /// that took the slot of one removed since the last frame counts with the removed instance's level.
    Geomorph,
}

impl Transition {
    /// Both transitions, with their names in scene files and on the command line.
    pub const NAMES: [(&'static str, Self); 2] = [("hard", Self::Hard), ("geomorph", Self::Geomorph)];

    /// Its code in an object's flags.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(self) -> u32 {
        match self {
            Self::Hard => TRANSITION_HARD,
            Self::Geomorph => TRANSITION_GEOMORPH,
        }
    }

    /// Threshold per level: the smallest metric at which the level is drawn. Input: thresholds of the levels without a
    /// transition, ascending from 0.
    ///
    /// With a geomorph, the threshold is where the level begins to move: [`ON_THE_WAY`] times the next level's error.
    /// Level 0 is drawn below its threshold too. For the last level, twice its own error takes the place of the next
    /// level's.
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

/// The morph word of a level: its index and the number of steps out of [`MORPH_STEPS`]; 0 if it has not moved.
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

/// The decision word for a visible instance: 1 + 2 · level + mirrored, and [`morph_within`].
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
