//! What the last frames cost and drew, for plots.

use std::collections::VecDeque;

/// Number of frames that plots show.
pub const FRAMES: usize = 300;

/// Names of the stages of a frame, in the order of [`Sample::stages`].
pub const STAGES: [&str; 5] = ["select", "gate", "sample", "local to model", "skin"];

/// What a frame cost and drew.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sample {
    /// Milliseconds from one frame to the next.
    pub frame: f64,
    /// Milliseconds of the host for recording.
    pub record: f64,
    /// Milliseconds from the submission until the device was done; `None` while it is not known.
    pub device: Option<f64>,
    /// Milliseconds of each stage on the device; `None` without timestamps.
    pub stages: Option<[f64; 5]>,
    /// Triangles drawn.
    pub triangles: f64,
    /// Bones interpolated.
    pub bones: f64,
    /// Pixels by which anything may be off; `None` without a bound.
    pub bound: Option<f64>,
    /// The largest displacement of a bone of the chosen character that was found, in pixels.
    pub displacement: Option<f64>,
    /// Bytes that arrived since the viewer began.
    pub bytes: f64,
    /// The mean level of detail of each object's instances in view.
    pub levels: Vec<f64>,
}

/// The last frames.
#[derive(Debug, Default)]
pub struct History {
    frames: VecDeque<Sample>,
    /// Number of the first frame.
    first: u64,
}

impl History {
    /// Adds a frame, and forgets the oldest one beyond the number that is kept.
    pub fn add(&mut self, sample: Sample) {
        if self.frames.len() == FRAMES {
            self.frames.pop_front();
            self.first += 1;
        }
        self.frames.push_back(sample);
    }

    /// The newest frame.
    pub fn last(&self) -> Option<&Sample> {
        self.frames.back()
    }

    /// The newest frame, to add what is found later.
    pub fn last_mut(&mut self) -> Option<&mut Sample> {
        self.frames.back_mut()
    }

    /// Points of a plot: number of the frame, and a value of it. Frames without the value are left out.
    pub fn points(&self, value: impl Fn(&Sample) -> Option<f64>) -> Vec<[f64; 2]> {
        let numbered = (self.first..).zip(&self.frames);
        numbered.filter_map(|(number, sample)| Some([number as f64, value(sample)?])).collect()
    }

    /// The median of a value over the last `count` frames.
    pub fn median(&self, count: usize, value: impl Fn(&Sample) -> Option<f64>) -> Option<f64> {
        let mut all: Vec<f64> = self.frames.iter().rev().take(count).filter_map(value).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_frames_are_kept_with_their_numbers() {
        let mut history = History::default();
        for at in 0..FRAMES as u64 + 10 {
            history.add(Sample { triangles: at as f64, ..Sample::default() });
        }
        let points = history.points(|sample| Some(sample.triangles));
        assert_eq!((points.len(), points[0], points[FRAMES - 1]), (FRAMES, [10.0, 10.0], [309.0, 309.0]));
        assert_eq!(history.median(5, |sample| Some(sample.triangles)), Some(307.0));
        assert_eq!(history.median(5, |sample| sample.bound), None);
        assert!(history.points(|sample| sample.device).is_empty());
    }
}
