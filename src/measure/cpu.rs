//! The crowd on the CPU, by the references.

use std::time::Instant;

use super::gates::{GateMode, PATH, frame};
use super::play::{FrameTimes, Play, Played, Times, Timing};
use super::stage::Stage;
use crate::animation::frame::reference::Crowd;
use crate::animation::{Choice, GateTable, Lod};
use crate::asset::Affine;
use crate::{Error, InputError};

/// The crowd under a gate, and the same in full.
pub(crate) struct Cpu<'a> {
    gated: Crowd<'a>,
    full: Crowd<'a>,
    choice: Choice,
    rate: f64,
}

impl<'a> Cpu<'a> {
    /// `table` is the choice's, `animated_bones` that of [`GateMode::Off`].
    pub(crate) fn new(
        stage: &'a Stage<'_>,
        table: &'a GateTable,
        animated_bones: &'a GateTable,
        choice: Choice,
        lods: Vec<Lod>,
    ) -> Result<Self, InputError> {
        let crowd = |table| Crowd::new(&stage.order, &stage.set, table, PATH, stage.instances.clone());
        let mut gated = crowd(table)?;
        gated.lods = lods;
        Ok(Self { gated, full: crowd(animated_bones)?, choice, rate: stage.options.rate })
    }
}

impl Play for Cpu<'_> {
    fn play(&mut self, number: u32, timing: Timing) -> Result<Played, Error> {
        let (frame, elapsed) = frame(number, self.rate);
        let start = Instant::now();
        let work = self.gated.advance(self.choice, &frame, elapsed);
        let gated = start.elapsed();
        self.full.advance(GateMode::Off.choice(), &frame, elapsed);
        let full = start.elapsed() - gated;
        let [gated, full] = [gated, full].map(|time| FrameTimes::of_whole(time.as_nanos() as f64));
        Ok(Played {
            interpolated: work.pairs.len(),
            concatenated: work.updated_bones.iter().map(|word| word.count_ones() as usize).sum(),
            times: (timing != Timing::None).then_some(Times { gated, full }),
        })
    }

    fn stale(&self) -> &[Affine] {
        &self.gated.model_matrices
    }

    fn fresh(&self) -> &[Affine] {
        &self.full.model_matrices
    }
}
