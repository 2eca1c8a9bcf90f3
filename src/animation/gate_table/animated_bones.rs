//! The set of bones that each clip moves.

use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::animation::order::Order;
use crate::asset::clip::{Clip, Interpolation, TransformPart};

/// The bones that each clip of a set moves, by tier of the skeleton ([`Skeleton::with_tier`](crate::asset::Skeleton::with_tier)). The
/// gates [`Gate::Off`](crate::animation::Gate::Off), `Uniform` and `Random` need no other table. The tables of all other gates
/// contain an `AnimatedBones`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnimatedBones {
    bones: usize,
    words: usize,
    clips: usize,
    tiers: usize,
    /// For each tier and clip: the index of the clip's last row in the gate table, then one bit per slot. The bit is set if the
    /// slot's bone belongs to the tier and the clip moves it. After these records, two bit sets per tier follow: all slots of the
    /// tier, and the slots that no gate skips.
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
        let tiers = order.tiers.iter().max().map_or(1, |last| *last as usize + 1);
        let mut records = Vec::with_capacity(tiers * (clips.len() * (words + 1) + 2 * words));
        for tier in 0..tiers as u32 {
            for (entry, clip) in set.clips().iter().zip(clips) {
                records.push(entry.first_row + set.rows(entry) - 1);
                add_bits(&mut records, words, |at| {
                    order.tiers.get(at) == Some(&tier) && moves(clip, order.slots[at].bone as usize)
                });
            }
        }
        for tier in 0..tiers as u32 {
            add_bits(&mut records, words, |at| order.tiers.get(at) == Some(&tier));
            add_bits(&mut records, words, |_| false);
        }
        Ok(Self { bones: order.slots.len(), words, clips: clips.len(), tiers, records })
    }

    /// Marks bones that no gate skips: each is sampled in every frame that shows its instance, if the clip moves it. `is_always`
    /// says whether a slot's bone is one of them.
    pub(crate) fn set_always(&mut self, is_always: impl Fn(usize) -> bool) {
        for tier in 0..self.tiers {
            let first = self.first_set(tier);
            for at in (0..self.bones).filter(|at| is_always(*at)) {
                let bit = self.records[first + at / 32] & 1 << (at % 32);
                self.records[first + self.words + at / 32] |= bit;
            }
        }
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
        self.clips
    }

    /// Number of tiers of the skeleton.
    pub fn tiers(&self) -> usize {
        self.tiers
    }

    /// Bit mask of a clip, with one bit per slot. A bit is set if the slot's bone belongs to tier 0 and the clip moves it.
    ///
    /// # Panics
    /// If the clip set has no clip with this index.
    pub fn of(&self, clip: u32) -> &[u32] {
        self.of_tier(0, clip)
    }

    /// Bit mask of a clip in one tier, with one bit per slot. A bit is set if the slot's bone belongs to the tier and the clip
    /// moves it.
    ///
    /// # Panics
    /// If there is no clip or no tier with this index.
    pub fn of_tier(&self, tier: usize, clip: u32) -> &[u32] {
        &self.record(tier, clip)[1..]
    }

    /// Bit mask of all slots of a tier.
    pub(crate) fn all(&self, tier: usize) -> &[u32] {
        &self.records[self.first_set(tier)..][..self.words]
    }

    /// Bit mask of the slots of a tier that no gate skips.
    pub(crate) fn always(&self, tier: usize) -> &[u32] {
        &self.records[self.first_set(tier) + self.words..][..self.words]
    }

    /// Number of bones of tier 0 that a clip moves.
    ///
    /// # Panics
    /// If the clip set has no clip with this index.
    pub fn count(&self, clip: u32) -> usize {
        self.of(clip).iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Iterates over the slots of a tier whose bones a clip moves, in ascending order.
    pub(crate) fn slots(&self, tier: usize, clip: u32) -> impl Iterator<Item = usize> {
        let bits = self.of_tier(tier, clip).iter().enumerate();
        bits.flat_map(|(word, bits)| bits_of(*bits).map(move |bit| 32 * word + bit))
    }

    /// Returns whether a slot's bone belongs to a tier and a clip moves it.
    pub(crate) fn contains(&self, tier: usize, clip: u32, slot: usize) -> bool {
        self.of_tier(tier, clip)[slot / 32] >> (slot % 32) & 1 != 0
    }

    /// Index of a clip's last row in the gate table.
    pub(crate) fn last_row(&self, clip: u32) -> u32 {
        self.record(0, clip)[0]
    }

    /// The table in the kernels' layout. For each clip: the index of its last row, then one bit per slot.
    #[cfg(feature = "gpu")]
    pub(crate) fn records(&self) -> &[u32] {
        &self.records
    }

    fn record(&self, tier: usize, clip: u32) -> &[u32] {
        &self.records[(tier * self.clips + clip as usize) * (self.words + 1)..][..self.words + 1]
    }

    /// Index in `records` of a tier's two bit sets.
    fn first_set(&self, tier: usize) -> usize {
        self.tiers * self.clips * (self.words + 1) + 2 * tier * self.words
    }
}

/// Appends `words` words of bits. `is_set` gives each bit.
fn add_bits(records: &mut Vec<u32>, words: usize, is_set: impl Fn(usize) -> bool) {
    let word = |word: usize| (0..32).map(|bit| u32::from(is_set(32 * word + bit)) << bit).sum::<u32>();
    records.extend((0..words).map(word));
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
