//! The set of bones that each clip moves.

use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::order::Order;
use crate::asset::clip::{Clip, Interpolation, TransformPart};

/// The bones that each clip of a set moves. The gates [`Gate::Off`](crate::animation::Gate::Off), `Uniform` and `Random` need no
/// other table. The tables of all other gates contain an `AnimatedBones`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnimatedBones {
    bones: usize,
    words: usize,
    /// For each clip: the index of its last row in the gate table, then one bit per slot. The bit is set if the clip moves the
    /// slot's bone.
    records: Vec<u32>,
}

impl AnimatedBones {
    /// Finds, for each clip, the bones whose translation, rotation or scale changes during the clip.
    ///
    /// # Errors
    /// [`InputError`] if `clips` are not the clips of `set`, and if `order` and `set` differ in their number of bones.
    pub fn new(order: &Order, set: &ClipSet, clips: &[&Clip]) -> Result<Self, InputError> {
        set.check_clips(clips)?;
        InputError::check_same("skeleton.len", order.slots.len(), set.bones(), "as the clips'")?;
        let words = order.words();
        let mut records = Vec::with_capacity(clips.len() * (words + 1));
        for (entry, clip) in set.clips().iter().zip(clips) {
            records.push(entry.first_row + set.rows(entry) - 1);
            let first = records.len();
            records.resize(first + words, 0);
            for (at, slot) in order.slots.iter().enumerate() {
                records[first + at / 32] |= u32::from(moves(clip, slot.bone as usize)) << (at % 32);
            }
        }
        Ok(Self { bones: order.slots.len(), words, records })
    }

    /// Number of bones of the skeleton.
    pub fn bones(&self) -> usize {
        self.bones
    }

    /// Number of 32-bit words per instance that hold one bit per bone.
    pub fn words(&self) -> usize {
        self.words
    }

    /// Number of clips in the clip set.
    pub fn clips(&self) -> usize {
        self.records.len() / (self.words + 1)
    }

    /// Bit mask of a clip, with one bit per slot. A bit is set if the clip moves the slot's bone.
    ///
    /// # Panics
    /// If the clip set has no clip with this index.
    pub fn of(&self, clip: u32) -> &[u32] {
        &self.record(clip)[1..]
    }

    /// Number of bones that a clip moves.
    ///
    /// # Panics
    /// If the clip set has no clip with this index.
    pub fn count(&self, clip: u32) -> usize {
        self.of(clip).iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Iterates over the slots whose bones a clip moves, in ascending order.
    pub(crate) fn slots(&self, clip: u32) -> impl Iterator<Item = usize> {
        let bits = self.of(clip).iter().enumerate();
        bits.flat_map(|(word, bits)| bits_of(*bits).map(move |bit| 32 * word + bit))
    }

    /// Returns whether a clip moves the bone of a slot.
    pub(crate) fn contains(&self, clip: u32, slot: usize) -> bool {
        self.of(clip)[slot / 32] >> (slot % 32) & 1 != 0
    }

    /// Index of a clip's last row in the gate table.
    pub(crate) fn last_row(&self, clip: u32) -> u32 {
        self.record(clip)[0]
    }

    /// The table in the kernels' layout. For each clip: the index of its last row, then one bit per slot.
    #[cfg(feature = "gpu")]
    pub(crate) fn records(&self) -> &[u32] {
        &self.records
    }

    fn record(&self, clip: u32) -> &[u32] {
        &self.records[clip as usize * (self.words + 1)..][..self.words + 1]
    }
}

/// Iterates over the indices of the set bits of a word, in ascending order.
pub(crate) fn bits_of(word: u32) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(word), |rest| Some(rest & rest.wrapping_sub(1)))
        .take_while(|rest| *rest != 0)
        .map(|rest| rest.trailing_zeros() as usize)
}

/// Whether a clip changes the translation, rotation or scale of a bone.
fn moves(clip: &Clip, bone: usize) -> bool {
    TransformPart::ALL.iter().any(|part| {
        let track = clip.track(bone, *part);
        let is_spline = track.interpolation == Interpolation::CubicSpline;
        let each = if is_spline { 3 } else { 1 };
        let keys = track.keys as usize;
        let values = &clip.values()[track.first_value as usize..][..each * keys];
        let same = |value: [f32; 4], other: [f32; 4]| {
            value == other || *part == TransformPart::Rotation && value == other.map(|component| -component)
        };
        keys > 1
            && values.chunks_exact(each).enumerate().any(|(at, key)| {
                if !is_spline {
                    return !same(key[0], clip.key(track, 0));
                }
                // The in-tangent of the first key and the out-tangent of the last key have no effect.
                let bends = |tangent: [f32; 4], is_used: bool| is_used && tangent != [0.0; 4];
                key[1] != clip.key(track, 0) || bends(key[0], at > 0) || bends(key[2], at + 1 < keys)
            })
    })
}
