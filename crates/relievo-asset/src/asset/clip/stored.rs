//! Validation of clips that serde has read.

use serde::Deserialize;

use super::{Clip, LONGEST, Track, TransformPart, check_times};
use crate::InputError;
use crate::asset::transform::{finite, unit};

/// A clip as serde reads it, before validation.
#[derive(Deserialize)]
#[serde(rename = "Clip")]
pub(super) struct StoredClip {
    name: String,
    duration: f32,
    tracks: Vec<Track>,
    times: Vec<f32>,
    values: Vec<[f32; 4]>,
}

impl TryFrom<StoredClip> for Clip {
    type Error = InputError;

    /// Refuses a number of tracks that is not a multiple of three, and tracks that reach beyond the arrays. Also refuses times
    /// that descend or are out of range, values that are not finite, and rotations without a direction.
    fn try_from(stored: StoredClip) -> Result<Self, InputError> {
        let StoredClip { name, duration, tracks, times, values } = stored;
        if !tracks.len().is_multiple_of(TransformPart::ALL.len()) {
            return Err(InputError::new("clip.tracks.len", tracks.len(), "must be three a bone"));
        }
        // Shaders compute byte offsets of values in u32, so a clip has fewer than 2^28 values of 16 bytes.
        if values.len() > (1 << 28) - 1 {
            return Err(InputError::new("clip.values.len", values.len(), "must be below 2^28"));
        }
        for (at, value) in values.iter().enumerate() {
            if !value.iter().all(|part| part.is_finite()) {
                finite(&format!("clip.values[{at}]"), value)?;
            }
        }
        let mut last = 0.0_f32;
        for (at, track) in tracks.iter().enumerate() {
            last = last.max(check_track(at, track, &times, &values)?);
        }
        let bound = || format!("must be in {last}..={LONGEST} seconds, from the last key on");
        InputError::check((last..=LONGEST).contains(&duration), "clip.duration", duration, bound)?;
        Ok(Self { name, duration, tracks, times, values })
    }
}

/// Checks one track. Returns the time of its last key in seconds; 0 for a track at rest.
fn check_track(at: usize, track: &Track, times: &[f32], values: &[[f32; 4]]) -> Result<f32, InputError> {
    let of_track = |first: u32, count: usize, all: usize, field: &str| {
        let (first, end) = (first as usize, first as usize + count);
        if end > all {
            let bound = format!("must leave {count} before {all}, the end of {field}");
            return Err(InputError::new(format!("clip.tracks[{at}].{field}"), first, bound));
        }
        Ok(first..end)
    };
    let keys = track.keys as usize;
    let each = track.interpolation.values_a_key();
    let own_times = of_track(track.first_time, keys, times.len(), "times")?;
    let own_values = of_track(track.first_value, each * keys.max(1), values.len(), "values")?;
    if at % TransformPart::ALL.len() == TransformPart::Rotation as usize {
        for (key, value) in values[own_values].iter().enumerate().filter(|(key, _)| each == 1 || key % 3 == 1)
        {
            unit(&format!("clip.tracks[{at}].values[{key}]"), *value)?;
        }
    }
    if keys == 0 {
        return Ok(0.0);
    }
    check_times(&format!("clip.tracks[{at}].times"), &times[own_times.clone()])?;
    Ok(times[own_times.end - 1])
}
