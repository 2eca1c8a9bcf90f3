//! Clips that instances of characters play.

use crate::animation::{Instance, Wrap};

/// The clip that an instance plays, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Playing {
    pub clip: u32,
    pub wrap: Wrap,
    pub start: f64,
    pub rate: f32,
}

impl Playing {
    /// The first clip, from time 0 on.
    pub const REST: Self = Self { clip: 0, wrap: Wrap::Loop, start: 0.0, rate: 1.0 };

    /// The play state in device format, with a start relative to `epoch`. For a looping clip of `duration` seconds, the start is
    /// moved by whole repetitions, so that it stays close to the epoch.
    pub fn on_device(&self, duration: f64, epoch: f64) -> Instance {
        let mut start = self.start - epoch;
        let period = duration / f64::from(self.rate.abs());
        if self.wrap == Wrap::Loop && period > 0.0 && period.is_finite() {
            start %= period;
        }
        // The device computes start + rate · elapsed inside the clip.
        Instance::new(self.clip, self.wrap, (-start * f64::from(self.rate)) as f32, self.rate)
    }
}
