//! Finds the position of a time among key times.

/// A position between two keys of a timeline. The default is the first key, with a fraction of 0. `wgsl/animation/clip.wgsl` has
/// the same struct.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct KeyframeCursor {
    /// Index of the last key at or before the time, counted from the timeline's first key; 0 before the first key.
    pub key: u32,
    /// Fraction of the interval from `key` to the next key, 0 to below 1. The fraction is 0 before the first key and after the
    /// last.
    pub fraction: f32,
}

/// Finds the last key at or before `time`, and the position of `time` between this key and the next, as a fraction from 0 to 1.
/// All times are in seconds. Before the first key and after the last, the fraction is 0.
pub fn keyframe_cursor(times: &[f32], time: f32) -> KeyframeCursor {
    let last = times.len().saturating_sub(1);
    if last == 0 || time < times[0] {
        return KeyframeCursor { key: 0, fraction: 0.0 };
    }
    if time >= times[last] {
        return KeyframeCursor { key: last as u32, fraction: 0.0 };
    }
    // Most clips have evenly spaced keys, so this first guess is usually right.
    let evenly = (time - times[0]) / (times[last] - times[0]) * last as f32;
    let mut key = (evenly as usize).min(last - 1);
    if times[key] > time || times[key + 1] <= time {
        let mut end = last;
        key = 0;
        while end - key > 1 {
            let middle = (key + end) / 2;
            if times[middle] <= time {
                key = middle;
            } else {
                end = middle;
            }
        }
    }
    KeyframeCursor { key: key as u32, fraction: (time - times[key]) / (times[key + 1] - times[key]) }
}

/// Path between two rotation keys, for tracks with linear interpolation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum RotationPath {
    /// Constant angular speed along the arc, as glTF requires.
    #[default]
    Slerp = 0,
    /// Linear interpolation along the chord, then normalization. Cheaper, with an error of 0.005 to 0.014 rad on ordinary
    /// clips.
    Nlerp = 1,
}
