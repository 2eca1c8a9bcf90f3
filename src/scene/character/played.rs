//! Clips that the instances of a character play.

use std::ops::Range;

use super::{Character, Runtime};
use crate::animation::Frame;
use crate::gpu::{Staged, Upload as _};
use crate::scene::chunk::common;
use crate::scene::placement::Play;
use crate::scene::playing::Playing;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::{Error, InputError};

/// Largest time in seconds between the scene's time and the epoch, which is the origin of the device's `f32` times. Beyond
/// it, the epoch moves to the scene's time, because large `f32` times lose precision.
const EPOCH: f64 = 128.0;

impl Character {
    /// Sets the clip that an instance plays. Returns a sphere around the instance, in model space.
    pub fn play(&mut self, index: u32, play: &Play<'_>) -> Result<BoundingSphere, InputError> {
        play.validate()?;
        let clip = self.clip(play.clip)?;
        self.plays[index as usize] =
            Playing { clip: clip as u32, wrap: play.wrap, start: play.start, rate: play.rate };
        self.changed.add(index, self.plays.len());
        Ok(self.sphere_as_played(index))
    }

    /// Resets an instance to the first clip. Returns the instance's bounding sphere.
    pub fn play_first(&mut self, index: u32) -> BoundingSphere {
        self.plays[index as usize] = Playing::REST;
        self.changed.add(index, self.plays.len());
        self.clear_layers(index);
        self.spheres[0]
    }

    pub(super) fn clip(&self, name: &str) -> Result<usize, InputError> {
        let clip = self
            .merged
            .model
            .clip(name)
            .map_err(|error| InputError { path: "play.clip".to_owned(), ..error })?;
        Ok(self.merged.model.clips.iter().position(|other| std::ptr::eq(other, clip)).unwrap_or(0))
    }

    /// Stages the frame's time and the changed clips of instances for upload.
    pub(super) fn stage_played(&mut self, staged: &mut Staged, frame: &Frame, now: f64) -> Result<(), Error> {
        if (now - self.epoch).abs() > EPOCH {
            self.epoch = now;
            self.changed.all(self.plays.len());
            self.layers.iter_mut().for_each(|layer| layer.changed.all(self.plays.len()));
        }
        for [from, to] in self.changed.take(self.plays.len()) {
            self.stage_plays(staged, &(from..to))?;
        }
        self.stage_layers(staged, now)?;
        let elapsed = (now - self.epoch) as f32;
        for runtime in &self.runtimes {
            runtime.frame.set_through(staged, frame, elapsed)?;
            for weights in &runtime.weights {
                weights.set_through(staged, elapsed)?;
            }
        }
        Ok(())
    }

    fn stage_plays(&self, staged: &mut Staged, run: &Range<usize>) -> Result<(), Error> {
        let clips = &self.merged.model.clips;
        let duration = |play: &Playing| f64::from(clips[play.clip as usize].duration());
        for Runtime { slots, crowd, .. } in &self.runtimes {
            let Some(own) = common(run, slots) else { continue };
            let plays = self.plays[own.clone()].iter();
            let plays = plays.map(|play| play.on_device(duration(play), self.epoch));
            staged.elements(&crowd.instances, own.start - slots.start, &plays.collect::<Vec<_>>())?;
        }
        Ok(())
    }
}
