//! Plays a crowd on the CPU, by the references.

use std::time::Instant;

use relievo::asset::Affine;
use relievo::ops::animation::{Gate, Lod};
use relievo::{Error, InputError};

use crate::crowd::Crowd;
use crate::measure::gates::{PATH, frame};
use crate::measure::play::{Play, Played, Timing, of_whole};
use crate::measure::stage::Stage;

/// The crowd under a gate, and the same crowd in full.
pub(crate) struct Cpu<'a> {
    gated: Crowd<'a>,
    full: Crowd<'a>,
    rate: f64,
}

impl<'a> Cpu<'a> {
    /// `off` is the gate of [`GateMode::Off`](crate::measure::gates::GateMode::Off).
    pub(crate) fn new(
        stage: &'a Stage<'_>,
        gate: &'a Gate,
        off: &'a Gate,
        lods: Vec<Lod>,
    ) -> Result<Self, InputError> {
        let crowd = |gate| Crowd::new(&stage.order, &stage.set, gate, PATH, stage.instances.clone());
        let mut gated = crowd(gate)?;
        gated.lods = lods;
        Ok(Self { gated, full: crowd(off)?, rate: stage.options.rate })
    }
}

impl Play for Cpu<'_> {
    fn play(&mut self, number: u32, timing: Timing) -> Result<Played, Error> {
        let (frame, elapsed) = frame(number, self.rate);
        let start = Instant::now();
        let work = self.gated.advance(&frame, elapsed);
        let gated = start.elapsed();
        self.full.advance(&frame, elapsed);
        let full = start.elapsed() - gated;
        let times = [gated, full].map(|time| of_whole(time.as_nanos() as f64));
        Ok(Played {
            interpolated: work.pairs.len(),
            concatenated: work.updated_bones.iter().map(|word| word.count_ones() as usize).sum(),
            times: (timing != Timing::None).then_some(times),
        })
    }

    fn stale(&self) -> &[Affine] {
        &self.gated.model_matrices
    }

    fn fresh(&self) -> &[Affine] {
        &self.full.model_matrices
    }
}
