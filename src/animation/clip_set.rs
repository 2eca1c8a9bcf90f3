//! A set of clips of one skeleton, in the layout that crowds play from. The arrays of all clips lie one after another. Tracks
//! with equal key times share a timeline (list of key times). The first timeline of a clip contains the key times of all the
//! clip's tracks.

use std::collections::HashMap;

use crate::InputError;
use crate::asset::clip::{Clip, Interpolation, Track};
#[cfg(feature = "gpu")]
use crate::shared::animation::clip as packed;
pub use crate::shared::animation::clip::{ClipEntry, Timeline};

/// An animation track in a clip set: the values of one bone's translation, rotation or scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SetTrack {
    /// Index of the track's timeline, relative to the clip's first timeline; `None` if the value never changes.
    pub timeline: Option<u32>,
    /// Interpolation of the values between keys.
    pub interpolation: Interpolation,
    /// Index of the track's first value in [`ClipSet::values`]. A constant spline has three values; for such a track, this is the
    /// index of the middle value.
    pub first_value: u32,
}

#[cfg(feature = "gpu")]
impl SetTrack {
    /// The track in the packed 8-byte form that kernels read.
    pub fn packed(&self) -> packed::SetTrack {
        let timeline = self.timeline.unwrap_or(packed::CONSTANT);
        let interpolation = self.interpolation as u32;
        packed::SetTrack { words: [packed::track_word(timeline, interpolation), self.first_value] }
    }
}

/// A set of clips of one skeleton, with shared timelines.
#[derive(Debug, Clone, PartialEq)]
pub struct ClipSet {
    bones: usize,
    clips: Vec<ClipEntry>,
    tracks: Vec<SetTrack>,
    timelines: Vec<Timeline>,
    times: Vec<f32>,
    values: Vec<[f32; 4]>,
}

impl ClipSet {
    /// Builds a set from clips of the same skeleton.
    ///
    /// # Errors
    /// [`InputError`] for an empty list, for clips with different numbers of bones, and for 2²⁸ or more values or times: kernels
    /// address them by `u32` byte offsets.
    pub fn new(clips: &[&Clip]) -> Result<Self, InputError> {
        let Some(first) = clips.first() else {
            return Err(InputError::new("clips.len", 0, "must be at least 1"));
        };
        let (clips_len, tracks_len) = (clips.len(), clips.len() * first.tracks().len());
        let mut set = Self {
            bones: first.bones(),
            clips: Vec::with_capacity(clips_len),
            tracks: Vec::with_capacity(tracks_len),
            timelines: Vec::new(),
            times: Vec::new(),
            values: Vec::new(),
        };
        for (index, clip) in clips.iter().enumerate() {
            let path = format!("clips[{index}].bones");
            InputError::check_same(path, clip.bones(), set.bones, "as the first clip's")?;
            set.add(clip);
        }
        for (field, len) in [("clips.values.len", set.values.len()), ("clips.times.len", set.times.len())] {
            if len >= 1 << 28 {
                return Err(InputError::new(field, len, "must be below 2^28"));
            }
        }
        Ok(set)
    }

    fn add(&mut self, clip: &Clip) {
        let (first_timeline, first_time) = (self.timelines.len(), self.times.len());
        let first_row = self.clips.last().map_or(0, |last| last.first_row + self.rows(last));
        self.times.extend(clip.times());
        let common = self.add_common_timeline(clip, first_time);
        let mut known = HashMap::from([(common, 0)]);
        for track in clip.tracks() {
            let first_value = self.values.len() as u32 + track.first_value;
            let is_constant = track.keys < 2;
            let timeline = (!is_constant).then(|| {
                let timeline =
                    Timeline { first_time: first_time as u32 + track.first_time, keys: track.keys };
                *known.entry(timeline).or_insert_with(|| {
                    self.timelines.push(timeline);
                    (self.timelines.len() - first_timeline - 1) as u32
                })
            });
            let interpolation = track.interpolation;
            let middle = u32::from(is_constant && interpolation == Interpolation::CubicSpline);
            self.tracks.push(SetTrack { timeline, interpolation, first_value: first_value + middle });
        }
        self.values.extend(clip.values());
        self.clips.push(ClipEntry {
            first_timeline: first_timeline as u32,
            timelines: (self.timelines.len() - first_timeline) as u32,
            duration: clip.duration(),
            first_row,
        });
    }

    /// Adds a clip's first timeline: the sorted key times of all its tracks, without duplicates. Gate tables use only this
    /// timeline. In most clips, one of the tracks already has exactly these times.
    fn add_common_timeline(&mut self, clip: &Clip, first_time: usize) -> Timeline {
        let common = all_times(clip);
        let same = moving(clip).find(|track| clip.times_of(track) == common);
        let timeline = Timeline {
            first_time: match same {
                Some(track) => first_time as u32 + track.first_time,
                None => self.times.len() as u32,
            },
            keys: common.len() as u32,
        };
        if same.is_none() {
            self.times.extend(common);
        }
        self.timelines.push(timeline);
        timeline
    }

    /// Time of each row of a clip in gate tables, in seconds: the key times of all the clip's tracks.
    pub fn common_times(&self, clip: &ClipEntry) -> &[f32] {
        let timeline = self.timelines[clip.first_timeline as usize];
        &self.times[timeline.first_time as usize..][..timeline.keys as usize]
    }

    /// Number of rows of a clip in gate tables: one per time in [`ClipSet::common_times`], and one for the whole clip.
    pub fn rows(&self, clip: &ClipEntry) -> u32 {
        self.timelines[clip.first_timeline as usize].keys + 1
    }

    /// Returns an error unless `clips` are the clips that the set was made from, in the same order. Data computed from other
    /// clips would be assigned to the wrong clips of the set.
    pub(crate) fn check_clips(&self, clips: &[&Clip]) -> Result<(), InputError> {
        InputError::check_same("clips.len", clips.len(), self.clips.len(), "those of the set")?;
        let mut values = self.values.as_slice();
        for (index, (entry, clip)) in self.clips.iter().zip(clips).enumerate() {
            let (own, rest) = values.split_at(clip.values().len().min(values.len()));
            values = rest;
            let is_same = own == clip.values() && entry.duration == clip.duration();
            if !is_same || self.common_times(entry) != all_times(clip) {
                let bound = "must have the keys of the set's clip of this number";
                return Err(InputError::new(format!("clips[{index}]"), clip.name(), bound));
            }
        }
        Ok(())
    }

    /// Whether any track is a cubic spline. Sampling is faster without splines.
    pub fn has_splines(&self) -> bool {
        self.tracks.iter().any(|track| track.interpolation == Interpolation::CubicSpline)
    }

    /// Number of bones of every clip.
    pub fn bones(&self) -> usize {
        self.bones
    }

    /// One entry per clip, in the order of the clips passed to [`ClipSet::new`].
    pub fn clips(&self) -> &[ClipEntry] {
        &self.clips
    }

    /// All tracks: for each clip and bone, a translation, a rotation and a scale track.
    pub fn tracks(&self) -> &[SetTrack] {
        &self.tracks
    }

    /// The timelines of all clips, one clip after another.
    pub fn timelines(&self) -> &[Timeline] {
        &self.timelines
    }

    /// Number of cursors per instance: the largest number of timelines in any clip, at least 1.
    pub fn timelines_a_clip(&self) -> usize {
        self.clips.iter().map(|clip| clip.timelines as usize).max().unwrap_or(0).max(1)
    }

    /// Key times of all clips, in seconds.
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// Key values of all clips.
    pub fn values(&self) -> &[[f32; 4]] {
        &self.values
    }
}

fn moving(clip: &Clip) -> impl Iterator<Item = &Track> {
    clip.tracks().iter().filter(|track| track.keys > 1)
}

/// The clip's start and all key times of its tracks: sorted, without duplicates.
fn all_times(clip: &Clip) -> Vec<f32> {
    let mut common: Vec<f32> = moving(clip).flat_map(|track| clip.times_of(track)).copied().collect();
    common.sort_by(f32::total_cmp);
    common.dedup();
    // The time before the first key needs a row of its own, because there may be a jump at that key.
    if common.first().is_none_or(|first| *first > 0.0) {
        common.insert(0, 0.0);
    }
    common
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::creature;

    #[test]
    fn tracks_find_their_own_times_and_values() {
        let model = creature().expect("valid");
        let clips: Vec<&Clip> = model.clips.iter().collect();
        let set = ClipSet::new(&clips).expect("one skeleton");
        assert_eq!((set.bones(), set.clips().len(), set.tracks().len()), (153, 3, 3 * 153 * 3));
        let is_spline =
            |clip: &Clip| clip.tracks().iter().any(|track| track.interpolation == Interpolation::CubicSpline);
        for clip in &clips {
            assert_eq!(ClipSet::new(&[clip]).expect("valid").has_splines(), is_spline(clip));
        }
        assert_eq!(set.has_splines(), clips.iter().any(|clip| is_spline(clip)));
        for (entry, (clip, tracks)) in set.clips().iter().zip(clips.iter().zip(set.tracks().chunks(3 * 153)))
        {
            assert_eq!(entry.duration, clip.duration());
            // Many tracks share a timeline.
            assert!((2..20).contains(&entry.timelines), "{}", entry.timelines);
            for (track, own) in tracks.iter().zip(clip.tracks()) {
                assert_eq!(track.interpolation, own.interpolation);
                let is_spline = own.interpolation == Interpolation::CubicSpline;
                let middle = if own.keys == 1 && is_spline { 1 } else { 0 };
                let own_value = clip.values()[own.first_value as usize + middle];
                assert_eq!(set.values()[track.first_value as usize], own_value);
                assert_eq!(track.timeline.is_none(), own.keys < 2);
                if let Some(timeline) = track.timeline {
                    let found = set.timelines()[(entry.first_timeline + timeline) as usize];
                    let times = &set.times()[found.first_time as usize..][..found.keys as usize];
                    assert_eq!(times, clip.times_of(own));
                }
            }
        }
    }

    #[test]
    fn clips_of_other_skeletons_are_refused() {
        assert_eq!(ClipSet::new(&[]).expect_err("refused").path, "clips.len");
        let model = creature().expect("valid");
        let one = crate::asset::Skeleton::of_joints(model.skeleton.bones()[..1].to_vec()).expect("valid");
        let other = Clip::new("other", &one, &[Default::default()], 1.0).expect("valid");
        assert_eq!(ClipSet::new(&[&model.clips[0], &other]).expect_err("refused").path, "clips[1].bones");
    }
}
