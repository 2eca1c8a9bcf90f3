//! The crowd on the CPU.

use std::time::Instant;

use relievo::animation::Choice;
use relievo::animation::frame::reference::Crowd;
use relievo::animation::{GateTable, Lod};
use relievo::asset::Affine;
use relievo::{Error, InputError};

use super::gates::{Mode, PATH, frame};
use super::play::{Play, Played, Taken, Times, Timing};
use super::stage::Stage;

/// Both crowds.
pub struct References<'a> {
    gated: Crowd<'a>,
    full: Crowd<'a>,
    choice: Choice,
    rate: f64,
}

impl<'a> References<'a> {
    /// `table` is the choice's, `animated_bones` that of [`Mode::Off`].
    pub fn new(
        stage: &'a Stage<'_>,
        table: &'a GateTable,
        animated_bones: &'a GateTable,
        choice: Choice,
        lods: Vec<Lod>,
    ) -> Result<Self, InputError> {
        let crowd = |table| Crowd::new(&stage.order, &stage.set, table, PATH, stage.instances.clone());
        let mut gated = crowd(table)?;
        gated.lods = lods;
        Ok(Self { gated, full: crowd(animated_bones)?, choice, rate: stage.plan.rate })
    }
}

impl Play for References<'_> {
    fn play(&mut self, number: u32, timing: Timing) -> Result<Played, Error> {
        let (frame, elapsed) = frame(number, self.rate);
        let start = Instant::now();
        let work = self.gated.advance(self.choice, &frame, elapsed);
        let gated = start.elapsed();
        self.full.advance(Mode::Off.choice(0.0, 0), &frame, elapsed);
        let full = start.elapsed() - gated;
        let [gated, full] =
            [gated, full].map(|time| Taken { whole: Some(time.as_nanos() as f64), ..Taken::default() });
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
