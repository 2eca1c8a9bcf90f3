//! Copies of clips in which the keys of some tracks are replaced.

use super::{Clip, Keys, Layout, Track, TransformPart};
use crate::InputError;

impl Clip {
    /// Keys of a track in stored form: tangents are multiplied by the duration of their segment in seconds. A track at rest has
    /// no key times and one value.
    #[doc(hidden)]
    pub fn stored_keys(&self, track: &Track) -> Keys {
        let interpolation = track.interpolation;
        let count = interpolation.values_a_key() * track.keys.max(1) as usize;
        let values = &self.values[track.first_value as usize..][..count];
        Keys { times: self.times_of(track).to_vec(), values: values.to_vec(), interpolation }
    }

    /// Copies the clip and replaces the translation and rotation keys of one bone. `None` keeps the old keys. Tangents must be
    /// in stored form: multiplied by the duration of their segment in seconds.
    ///
    /// # Errors
    /// [`InputError`] for rotations without a direction.
    #[doc(hidden)]
    pub fn replaced(
        &self,
        bone: usize,
        translation: Option<Keys>,
        rotation: Option<Keys>,
    ) -> Result<Self, InputError> {
        let rotation = rotation.map(|keys| keys.stored("rotation", true)).transpose()?;
        let mut changed = [(TransformPart::Translation, translation), (TransformPart::Rotation, rotation)];
        let tracks = self.tracks.iter().enumerate().map(|(index, track)| {
            let change = changed.iter_mut().find(|(part, _)| index == 3 * bone + *part as usize);
            let change = change.and_then(|(_, keys)| keys.take());
            change.unwrap_or_else(|| self.stored_keys(track))
        });
        Self::of_stored(&self.name, self.duration, tracks)
    }

    /// Appends the tracks of another clip, for the bones of one more tier of the skeleton
    /// ([`Skeleton::with_tier`](crate::asset::Skeleton::with_tier)). The other clip's duration and name are ignored.
    #[doc(hidden)]
    pub fn with_tier(&self, other: &Self) -> Result<Self, InputError> {
        let tracks =
            |clip: &Self| clip.tracks.iter().map(|track| clip.stored_keys(track)).collect::<Vec<_>>();
        Self::of_stored(&self.name, self.duration, [tracks(self), tracks(other)].concat())
    }

    /// Builds a clip from tracks in stored form, three per bone. A track without times is at rest; its one value is the rest
    /// pose.
    ///
    /// # Errors
    /// [`InputError`] for more values than one buffer can hold.
    #[doc(hidden)]
    pub fn of_stored(
        name: &str,
        duration: f32,
        tracks: impl IntoIterator<Item = Keys>,
    ) -> Result<Self, InputError> {
        let mut layout = Layout::default();
        for keys in tracks {
            let rest = keys.values[0];
            layout.add(Some(keys).filter(|keys| !keys.times.is_empty()), rest);
        }
        layout.finish(name.to_owned(), duration)
    }
}
