//! The way from an old model's levels to those of a new one.

use crate::lod::transition::{Pace, Transition};

/// Seconds over which the levels of a new model come into use.
const ARRIVAL: f32 = 0.5;

/// Powers of two between the first factor of a threshold and 1.
const RANGE: f32 = 12.0;

/// Least progress in a frame, so that an arrival ends even if no time passes.
const LEAST_STEP: f32 = 1.0 / 32.0;

/// How far the levels of a new model have come into use. The thresholds of its new levels rise from 0 to their values, so no
/// level finer than those of the old model is chosen at first, and then one after the other, as if instances came nearer.
#[derive(Debug, Clone, Default)]
pub(super) struct Arrival {
    /// The progress of the threshold of each level, 0 to 1. It does not decrease from one level to the next. Empty if nothing
    /// arrives; levels beyond the list have arrived.
    progress: Vec<f32>,
    /// The error of the old model's finest level in model units; 0 if nothing arrives.
    pub error: f32,
}

impl Arrival {
    /// Whether levels still come into use.
    pub fn is_running(&self) -> bool {
        !self.progress.is_empty()
    }

    /// Begins with a new model, whose levels have this many triangles. The finest level of the old model had `finest` triangles, and
    /// the error `error` in model units. Thresholds of the old model's levels keep their progress.
    pub fn begin(&mut self, finest: u32, triangles: &[u32], error: f32) {
        let finer = triangles.iter().take_while(|own| **own > finest).count();
        // Between two levels, the finer one loses nothing.
        let same = if triangles.get(finer) == Some(&finest) { finer } else { finer.saturating_sub(1) };
        if same == 0 {
            return;
        }
        self.error = self.error.max(error);
        let kept = std::mem::take(&mut self.progress).into_iter().skip(1);
        self.progress = std::iter::repeat_n(0.0, 1 + same).chain(kept).collect();
    }

    /// Goes on by the time of a frame.
    pub fn advance(&mut self, transition: Transition, seconds: f32) {
        // A fade in time takes its own time from here on.
        let is_timed = matches!(transition.pace(), Some(Pace::Seconds(_)));
        let step = if is_timed { 1.0 } else { (seconds / ARRIVAL).max(LEAST_STEP) };
        self.progress.iter_mut().for_each(|progress| *progress = (*progress + step).min(1.0));
        if self.progress.iter().all(|progress| *progress == 1.0) {
            *self = Self::default();
        }
    }

    /// Thresholds with those of levels that still arrive lowered. Errors grow by a factor from one level to the
    /// next, and so do these factors with time: each level takes about as long.
    pub fn lowered(&self, mut thresholds: Vec<f32>) -> Vec<f32> {
        for (threshold, progress) in thresholds.iter_mut().zip(&self.progress) {
            *threshold *= if *progress > 0.0 { (RANGE * (progress - 1.0)).exp2() } else { 0.0 };
        }
        thresholds
    }
}

#[cfg(test)]
mod tests {
    use super::{ARRIVAL, Arrival};
    use crate::lod::transition::{Pace, Transition};

    #[test]
    fn levels_come_into_use_one_after_the_other() {
        let mut arrival = Arrival::default();
        let all = [0.0, 1.0, 2.0, 4.0, 8.0];
        // The old model had the two coarsest of five levels.
        arrival.begin(100, &[1000, 500, 200, 100, 50], 0.25);
        assert_eq!(arrival.lowered(all.to_vec()), [0.0, 0.0, 0.0, 0.0, 8.0]);
        arrival.advance(Transition::Geomorph, 0.5 * ARRIVAL);
        assert_eq!(arrival.lowered(all.to_vec()), [0.0, 0.015_625, 0.031_25, 0.0625, 8.0]);
        // A still finer model comes meanwhile, with two levels more.
        arrival.begin(1000, &[4000, 2000, 1000, 500, 200, 100, 50], 0.125);
        assert_eq!(arrival.error, 0.25);
        let lowered = arrival.lowered(vec![0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0]);
        assert_eq!(lowered, [0.0, 0.0, 0.0, 0.015_625, 0.031_25, 0.0625, 8.0]);
        // If no time passes, it ends as well.
        let frames = (1..).find(|_| {
            arrival.advance(Transition::Geomorph, 0.0);
            !arrival.is_running()
        });
        assert_eq!(frames, Some(32));
        assert_eq!(arrival.lowered(all.to_vec()), all);
    }

    #[test]
    fn a_level_between_two_is_replaced_by_the_finer_one() {
        let mut arrival = Arrival::default();
        arrival.begin(150, &[1000, 500, 200, 100, 50], 0.25);
        assert_eq!(arrival.lowered(vec![0.0, 1.0, 2.0, 4.0, 8.0]), [0.0, 0.0, 0.0, 4.0, 8.0]);
        let mut arrival = Arrival::default();
        arrival.begin(1000, &[1000, 500], 0.0);
        assert!(!arrival.is_running(), "nothing is finer");
    }

    #[test]
    fn fades_in_time_begin_after_one_frame() {
        let mut arrival = Arrival::default();
        arrival.begin(100, &[400, 100], 0.25);
        arrival.advance(Transition::Dither(Pace::Seconds(2.0)), 0.01);
        assert!(!arrival.is_running());
    }
}
