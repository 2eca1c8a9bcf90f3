//! Places tracks one after another in the flat arrays of a clip.

use super::{Clip, Interpolation, Keys, Track};
use crate::InputError;

/// A clip under construction.
#[derive(Default)]
pub(super) struct Layout {
    tracks: Vec<Track>,
    times: Vec<f32>,
    values: Vec<[f32; 4]>,
    // Maps the bits of each stored list of key times to the index of the list's first time in `times`.
    known: std::collections::HashMap<Vec<u32>, usize>,
    last: f32,
}

impl Layout {
    /// Appends a track with its keys, or with the single value `rest` if there are no keys. Tracks with equal key times share
    /// one list.
    pub(super) fn add(&mut self, keys: Option<Keys>, rest: [f32; 4]) {
        let at_rest = Keys { times: vec![], values: vec![rest], interpolation: Interpolation::Step };
        let keys = keys.unwrap_or(at_rest);
        let bits = keys.times.iter().map(|time| time.to_bits()).collect();
        let first_time = *self.known.entry(bits).or_insert_with(|| {
            self.times.extend(&keys.times);
            self.times.len() - keys.times.len()
        });
        self.last = keys.times.last().copied().unwrap_or(0.0).max(self.last);
        self.tracks.push(Track {
            first_time: first_time as u32,
            first_value: self.values.len() as u32,
            keys: keys.times.len() as u32,
            interpolation: keys.interpolation,
        });
        self.values.extend(keys.values);
    }

    /// Finishes the clip. It lasts `duration` seconds, or until the last key if that is later.
    ///
    /// # Errors
    /// [`InputError`] for more values than one buffer can hold.
    pub(super) fn finish(self, name: String, duration: f32) -> Result<Clip, InputError> {
        // Shaders compute byte offsets of values in u32, so a clip has fewer than 2^28 values of 16 bytes.
        if self.values.len() > (1 << 28) - 1 {
            return Err(InputError::new("clip.values.len", self.values.len(), "must be below 2^28"));
        }
        let Self { mut tracks, mut times, mut values, last, .. } = self;
        tracks.shrink_to_fit();
        times.shrink_to_fit();
        values.shrink_to_fit();
        Ok(Clip { name, duration: duration.max(last), tracks, times, values })
    }
}
