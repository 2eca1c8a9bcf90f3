//! Clips that instances of characters play.

use crate::animation::{Instance, Wrap};

/// The clip that an instance plays, with its wrap mode, start and rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Playing {
    pub clip: u32,
    pub wrap: Wrap,
    pub start: f64,
    pub rate: f32,
}

impl Playing {
    /// The first clip of the model, which loops from scene time 0 on.
    pub const REST: Self = Self { clip: 0, wrap: Wrap::Loop, start: 0.0, rate: 1.0 };

    /// The play state in device format, with a start relative to `epoch`. `duration` is the clip's duration; all times
    /// are in seconds. The start of a looping clip is moved by whole repetitions, so that it stays close to the epoch.
    pub fn on_device(&self, duration: f64, epoch: f64) -> Instance {
        let mut start = self.start - epoch;
        let period = duration / f64::from(self.rate.abs());
        if self.wrap == Wrap::Loop && period > 0.0 && period.is_finite() {
            start %= period;
        }
        // The device computes the time in the clip as start + rate · elapsed, so the start is converted to clip time.
        Instance::new(self.clip, self.wrap, (-start * f64::from(self.rate)) as f32, self.rate)
    }
}
