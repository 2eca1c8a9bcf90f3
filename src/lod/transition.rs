//! Transitions between levels of detail. CPU reference of `wgsl/lod/transition.wgsl`.

use super::criterion::Criterion;
use super::{LodObject, OBJECT_LEVELS};
use crate::InputError;
use crate::shared::lod::object::{
    FADE_PROGRESS, FADE_STEPS, MORPH_STEPS, decision_level, decision_mirrored, decision_next, decision_seen,
    decision_steps, decision_word, fade_word, list_entry_word, object_flags_timed, object_flags_transition,
};
#[cfg(feature = "gpu")]
use crate::shared::lod::transition::TRANSITION_HARD;
use crate::shared::lod::transition::{
    NO_LEVEL, TRANSITION_ALPHA, TRANSITION_CROSS_FADE, TRANSITION_DITHER, TRANSITION_FADE_IN,
    TRANSITION_GEOMORPH, TRANSITION_TWO_PHASE,
};

/// Error allowance for a surface between two levels, as a multiple of the coarser level's error. It comes from
/// measurements and is not a bound (`docs/pixel-bounds.md`).
#[cfg(feature = "gpu")]
const ON_THE_WAY: f32 = 1.2;

/// How an object's instances change from one level of detail to the next.
///
/// A fade draws an instance twice while its level changes. [`Transition::Dither`] shows its pattern in every layer. All other
/// fades blend: the blended level is drawn in [`Layer::Transparent`](crate::render::Layer::Transparent), after everything opaque.
/// During such a fade, layers other than colour and depth show only the level with the larger weight. Parts with blended
/// materials change at once.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum Transition {
    /// The level changes at once.
    #[default]
    Hard,
    /// The level changes by a geomorph: its vertices move towards their partners in the next coarser level
    /// ([`Mesh::partners`](crate::asset::Mesh::partners)).
    ///
    /// The vertices move further as the metric grows, in each view separately. When they reach their partners' positions, the
    /// picture equals the coarser level, so the level change itself is invisible.
    ///
    /// With [`Criterion::Error`], a level begins to move when 1.2 times the next level's error is allowed. The move ends when 1.2
    /// times the error of the level after the next one is allowed. The factor 1.2 allows for the surface between two levels,
    /// whose error may exceed the errors of both levels (figures in `docs/pixel-bounds.md`). The drawn level is therefore one to
    /// two levels finer than with [`Transition::Hard`]. This costs about 1.7 times the triangles, and two loads per vertex.
    ///
    /// Vertex motion is part of velocity ([`Layer::Velocity`](crate::render::Layer::Velocity)). If the last frame drew a finer
    /// level, a vertex was at its own position in that frame. If the last frame drew a coarser level, a vertex was at the
    /// position of the vertex that replaces it in that level.
    ///
    /// Where the last level is unknown, the current level counts as the last one. This applies to an instance that the view did
    /// not show in the last frame, and to all instances in the first frame after an object was added, removed or enlarged. If an
    /// instance took the slot of an instance that was removed since the last frame, the removed instance's level counts.
    Geomorph,
    /// Both levels are drawn, each in its own pixels of an ordered pattern that stands still. Together they cover every pixel.
    Dither(Pace),
    /// Both levels are blended, with weights λ and 1 − λ (thesis A, section 7.3.1). Opaque surfaces behind them show through.
    CrossFade(Pace),
    /// The old level is opaque. The next level is blended over it with weight 1 − λ, without writing depth (thesis A, section
    /// 7.3.2). At the end of the fade, the old level disappears at once.
    FadeIn(Pace),
    /// First the old level is opaque while the next level fades in over it. Then the next level is opaque while the old level
    /// fades out (thesis A, section 7.3.3). Surfaces behind the instance never show through.
    TwoPhase(Pace),
    /// Levels change at once, and distant instances fade out to nothing (thesis A, section 7.4). Opaque surfaces behind them show
    /// through. The two values have the unit of the object's criterion: distance, fraction of the viewport, or pixels per world
    /// unit. Not available with [`Criterion::Error`].
    Alpha {
        /// The value at which instances begin to fade.
        opaque: f32,
        /// The value at which instances have vanished. It must lie further away than `opaque`.
        gone: f32,
    },
}

/// How fast a fade runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// The fade depends on the metric: it takes place in a band around each threshold. The number is the band's width to either
    /// side as a fraction of the threshold, above 0 and below 1. With [`Criterion::Error`], the band begins at the threshold and
    /// is twice as wide, so that no level is drawn before it is allowed.
    Band(f32),
    /// The fade takes this many seconds, above 0. It starts when the criterion asks for another level. Until it ends, the old
    /// level is still drawn, even if the criterion no longer permits that level.
    Seconds(f32),
}

impl Default for Pace {
    /// A band of a tenth of the threshold to either side, like thesis A's band [90, 110].
    fn default() -> Self {
        Self::Band(0.1)
    }
}

impl Transition {
    /// Transitions that need no numbers, with their names in scene files and on the command line. Fades have the default pace.
    pub const NAMES: [(&'static str, Self); 6] = [
        ("hard", Self::Hard),
        ("geomorph", Self::Geomorph),
        ("dither", Self::Dither(Pace::Band(0.1))),
        ("cross_fade", Self::CrossFade(Pace::Band(0.1))),
        ("fade_in", Self::FadeIn(Pace::Band(0.1))),
        ("two_phase", Self::TwoPhase(Pace::Band(0.1))),
    ];

    /// The transition's code in an object's flags word.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(self) -> u32 {
        match self {
            Self::Hard => TRANSITION_HARD,
            Self::Geomorph => TRANSITION_GEOMORPH,
            Self::Dither(_) => TRANSITION_DITHER,
            Self::CrossFade(_) => TRANSITION_CROSS_FADE,
            Self::FadeIn(_) => TRANSITION_FADE_IN,
            Self::TwoPhase(_) => TRANSITION_TWO_PHASE,
            Self::Alpha { .. } => TRANSITION_ALPHA,
        }
    }

    /// Pace of a fade between levels; `None` for other transitions.
    pub fn pace(self) -> Option<Pace> {
        match self {
            Self::Dither(pace) | Self::CrossFade(pace) | Self::FadeIn(pace) | Self::TwoPhase(pace) => {
                Some(pace)
            }
            Self::Hard | Self::Geomorph | Self::Alpha { .. } => None,
        }
    }

    /// Whether instances may fade. Fading instances need lists of their own.
    #[cfg(feature = "gpu")]
    pub(crate) fn fades(self) -> bool {
        !matches!(self, Self::Hard | Self::Geomorph)
    }

    /// Checks the numbers of the transition, for an object with this criterion.
    ///
    /// # Errors
    /// [`InputError`] for a pace outside its range, and for [`Transition::Alpha`] with [`Criterion::Error`] or with
    /// `gone` not further away than `opaque`.
    pub fn validate(self, criterion: &Criterion) -> Result<(), InputError> {
        match self.pace() {
            Some(Pace::Band(band)) if !(band > 0.0 && band < 1.0) => {
                return Err(InputError::new("transition.band", band, "must be above 0 and below 1"));
            }
            Some(Pace::Seconds(seconds)) if !(seconds > 0.0 && seconds.is_finite()) => {
                return Err(InputError::new("transition.seconds", seconds, "must be finite, and above 0"));
            }
            _ => {}
        }
        let Self::Alpha { opaque, gone } = self else { return Ok(()) };
        let metrics = [opaque, gone].map(|value| criterion.metric_of(value));
        let [Some(begin), Some(end)] = metrics else {
            let bound = "needs a criterion with distances, sizes or magnifications";
            return Err(InputError::new("transition", "alpha", bound));
        };
        if !(begin >= 0.0 && begin.is_finite()) {
            return Err(InputError::new("transition.opaque", opaque, "must be finite, and above 0"));
        }
        if end > begin && end.is_finite() {
            return Ok(());
        }
        Err(InputError::new("transition.gone", gone, format!("must be further away than opaque, {opaque}")))
    }

    /// Threshold per level: the smallest metric at which the level is drawn. `thresholds` are the levels' thresholds without a
    /// transition, ascending from 0.
    ///
    /// With a geomorph, a level begins to move at its threshold: [`ON_THE_WAY`] times the next level's error. Level 0 is also
    /// drawn below its threshold. The last level has no next level; twice its own error is used instead.
    #[cfg(feature = "gpu")]
    pub(crate) fn begins(self, thresholds: &[f32]) -> Vec<f32> {
        match (self, thresholds.last()) {
            (Self::Geomorph, Some(last)) => {
                let next = thresholds.iter().skip(1).copied().chain([2.0 * last]);
                next.map(|threshold| (ON_THE_WAY * threshold).min(f32::MAX)).collect()
            }
            _ => thresholds.to_vec(),
        }
    }
}

/// Smallest metric at which a level is drawn. `last` is the instance's level in the last frame, or [`NO_LEVEL`].
pub fn threshold_of(object: &LodObject, level: u32, last: u32) -> f32 {
    let factor = match last {
        NO_LEVEL => 1.0,
        last if level <= last => object.finer,
        _ => object.coarser,
    };
    object.thresholds.as_flattened()[level as usize] * factor
}

/// Coarsest level whose threshold is at most `metric`. `last` is the instance's level in the last frame, or [`NO_LEVEL`].
pub fn level_within(object: &LodObject, metric: f32, last: u32) -> u32 {
    let fits = |level: &u32| threshold_of(object, *level, last) <= metric;
    (1..object.levels.min(OBJECT_LEVELS)).rev().find(fits).unwrap_or(0)
}

fn steps_between(metric: f32, begin: f32, end: f32, most: u32) -> u32 {
    (most as f32 * ((metric - begin) / (end - begin)).clamp(0.0, 1.0) + 0.5) as u32
}

/// Level of an instance in the last frame, or [`NO_LEVEL`]. During a timed fade, this is the level to which the fade leads.
/// `last` is the last frame's decision.
pub fn last_level(object: &LodObject, last: u32) -> u32 {
    match (decision_seen(last), decision_steps(last) > 0 && object_flags_timed(object.flags) != 0) {
        (0, _) => NO_LEVEL,
        (_, true) => decision_next(last),
        (_, false) => decision_level(last),
    }
}

fn settled(level: u32, mirrored: u32) -> u32 {
    decision_word(1, mirrored, level, level, 0)
}

fn morphing(object: &LodObject, metric: f32, mirrored: u32) -> u32 {
    let level = level_within(object, metric, NO_LEVEL);
    if level + 1 >= object.levels.min(OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let [begin, end] = [level, level + 1].map(|level| threshold_of(object, level, NO_LEVEL));
    decision_word(1, mirrored, level, level, steps_between(metric, begin, end, MORPH_STEPS))
}

fn fading_in_band(object: &LodObject, metric: f32, mirrored: u32) -> u32 {
    let level = level_within(object, metric, 0);
    let next = level + 1;
    if next >= object.levels.min(OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let [begin, end] = [next, 0].map(|last| threshold_of(object, next, last));
    match steps_between(metric, begin, end, FADE_PROGRESS) {
        0 => settled(level, mirrored),
        FADE_PROGRESS => settled(next, mirrored),
        steps => decision_word(1, mirrored, level, next, steps),
    }
}

fn fading_in_time(object: &LodObject, level: u32, mirrored: u32, last: u32, seconds: f32) -> u32 {
    if decision_seen(last) == 0 {
        return settled(level, mirrored);
    }
    let (mut from, mut to, mut done) = (decision_level(last), decision_next(last), decision_steps(last));
    if done == 0 {
        to = level;
    } else if level == from {
        (from, to, done) = (to, from, FADE_PROGRESS - done);
    }
    if from == to {
        return settled(from, mirrored);
    }
    let steps = done + (((object.rate * seconds).min(FADE_PROGRESS as f32) + 0.5) as u32).max(1);
    match steps >= FADE_PROGRESS {
        true => settled(to, mirrored),
        false => decision_word(1, mirrored, from, to, steps),
    }
}

/// Inputs of a decision besides the object and the metric.
#[derive(Debug, Clone, Copy)]
pub struct Circumstances {
    /// The budget's factor for the metric, 1 or more.
    pub factor: f32,
    /// Whether the instance's placement mirrors.
    pub is_mirrored: bool,
    /// The view's decision in its last frame; 0 if there is none.
    pub last: u32,
    /// Seconds since the view's last frame.
    pub seconds: f32,
    /// Whether all fades end in this frame, because their triangles exceed a budget.
    pub ends_fades: bool,
}

/// A metric after a budget has scaled it. `factor` is 1 or more.
pub fn coarsened(object: &LodObject, metric: f32, factor: f32) -> f32 {
    factor * metric + (factor - 1.0) * object.metric_floor
}

/// Level that hysteresis holds: the instance's level in the last frame, or [`NO_LEVEL`] if there is none. Geomorphs and fades in
/// a band do not depend on the last frame and always get [`NO_LEVEL`].
pub fn held_level(object: &LodObject, last: u32) -> u32 {
    let is_timed = object_flags_timed(object.flags) != 0;
    match object_flags_transition(object.flags) {
        TRANSITION_GEOMORPH => NO_LEVEL,
        TRANSITION_DITHER..=TRANSITION_TWO_PHASE if !is_timed => NO_LEVEL,
        _ => last_level(object, last),
    }
}

/// Whether an instance has faded out completely ([`Transition::Alpha`]).
pub fn is_faded_out(object: &LodObject, metric: f32) -> bool {
    object_flags_transition(object.flags) == TRANSITION_ALPHA
        && steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS) == FADE_PROGRESS
}

/// The decision word for a visible instance: level, next level and steps of the change.
pub fn decision(object: &LodObject, metric: f32, circumstances: &Circumstances) -> u32 {
    let Circumstances { factor, is_mirrored, last, seconds, ends_fades } = *circumstances;
    let mirrored = u32::from(is_mirrored);
    let transition = object_flags_transition(object.flags);
    let within = coarsened(object, metric, factor);
    if transition == TRANSITION_GEOMORPH {
        return morphing(object, within, mirrored);
    }
    let is_fading = (TRANSITION_DITHER..=TRANSITION_TWO_PHASE).contains(&transition) && !ends_fades;
    let is_timed = object_flags_timed(object.flags) != 0;
    if is_fading && !is_timed {
        return fading_in_band(object, within, mirrored);
    }
    let level = level_within(object, within, held_level(object, last));
    if is_fading {
        return fading_in_time(object, level, mirrored, last, seconds);
    }
    if transition != TRANSITION_ALPHA {
        return settled(level, mirrored);
    }
    match steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS) {
        FADE_PROGRESS => 0,
        steps => decision_word(1, mirrored, level, level, steps),
    }
}

/// Finest level that a decision draws.
pub fn finest_of(decision: u32) -> u32 {
    decision_level(decision).min(decision_next(decision))
}

/// List entries of a decision, at most two. Each is the index of a list, and the word to write there. `index` is the instance's
/// index in the object.
pub fn entries(object: &LodObject, decision: u32, index: u32) -> Vec<(u32, u32)> {
    if decision_seen(decision) == 0 {
        return Vec::new();
    }
    let (level, next, steps) = (decision_level(decision), decision_next(decision), decision_steps(decision));
    let mirrored = decision_mirrored(decision);
    let solid = |level: u32, steps: u32| (2 * level + mirrored, list_entry_word(index, level, steps));
    let fading = |level: u32, weight: u32, rest: u32| {
        let word = list_entry_word(index, level, fade_word(weight, rest));
        (2 * (object.levels + level) + mirrored, word)
    };
    if steps == 0 {
        return vec![solid(level, 0)];
    }
    let left = left_of(steps);
    let gained = FADE_STEPS - left;
    match object_flags_transition(object.flags) {
        TRANSITION_DITHER => vec![fading(level, left, 0), fading(next, left, 1)],
        TRANSITION_CROSS_FADE => vec![fading(level, left, 0), fading(next, gained, 0)],
        TRANSITION_FADE_IN => vec![solid(level, 0), fading(next, gained, 0)],
        TRANSITION_TWO_PHASE if left > gained => vec![solid(level, 0), fading(next, 2 * gained, 0)],
        TRANSITION_TWO_PHASE => vec![solid(next, 0), fading(level, 2 * left, 0)],
        TRANSITION_ALPHA => vec![fading(level, left, 0)],
        _ => vec![solid(level, steps)],
    }
}

/// List index and entry word of a visible instance that has its own draw (sorted transparency).
pub fn sorted_entry(object: &LodObject, decision: u32, index: u32) -> (u32, u32) {
    let steps = decision_steps(decision);
    let (level, word) = match object_flags_transition(object.flags) {
        TRANSITION_GEOMORPH => (decision_level(decision), steps),
        TRANSITION_ALPHA => (decision_level(decision), fade_word(left_of(steps), 0)),
        _ if 2 * steps > FADE_PROGRESS => (decision_next(decision), 0),
        _ => (decision_level(decision), 0),
    };
    (2 * level + decision_mirrored(decision), list_entry_word(index, level, word))
}

fn left_of(steps: u32) -> u32 {
    FADE_STEPS - (steps * FADE_STEPS + FADE_PROGRESS / 2) / FADE_PROGRESS
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
