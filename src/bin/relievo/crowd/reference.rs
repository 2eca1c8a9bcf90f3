//! The crowd on the CPU.

use std::time::Instant;

use relievo::animation::frame::reference::Crowd;
use relievo::animation::{Gate, Lod};
use relievo::asset::Affine;
use relievo::{Error, InputError};

use super::gates::{PATH, frame};
use super::play::{Play, Played, Taken, Times, Timing};
use super::stage::Stage;

/// Both crowds.
pub struct References<'a> {
    gated: Crowd<'a>,
    full: Crowd<'a>,
    rate: f64,
}

impl<'a> References<'a> {
    /// `off` is the gate of [`Mode::Off`](super::gates::Mode::Off).
    pub fn new(
        stage: &'a Stage<'_>,
        gate: &'a Gate,
        off: &'a Gate,
        lods: Vec<Lod>,
    ) -> Result<Self, InputError> {
        let crowd = |gate| Crowd::new(&stage.order, &stage.set, gate, PATH, stage.instances.clone());
        let mut gated = crowd(gate)?;
        gated.lods = lods;
        Ok(Self { gated, full: crowd(off)?, rate: stage.plan.rate })
    }
}

impl Play for References<'_> {
    fn play(&mut self, number: u32, timing: Timing) -> Result<Played, Error> {
        let (frame, elapsed) = frame(number, self.rate);
        let start = Instant::now();
        let work = self.gated.advance(&frame, elapsed);
        let gated = start.elapsed();
        self.full.advance(&frame, elapsed);
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
