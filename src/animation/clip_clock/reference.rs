//! Clip clocks: the CPU reference of `kernels/animation/clip_clock.wgsl`.

use crate::animation::clip_clock::{BLENDED, ClipClock, UpdateReason};
use crate::animation::clip_set::ClipSet;
use crate::animation::instance::Instance;
use crate::animation::keyframe_cursor::reference::inside_clip;
use crate::animation::layers::AnimationLayer;
use crate::animation::lod::{BoneSampling, Lod};
use crate::asset::keyframe::KeyframeCursor;
use crate::asset::keyframe::keyframe_cursor;
use crate::shared::animation::clip_clock::{CLIP_HASH_FACTOR, TIER_SHIFT};
use crate::shared::animation::gate_state::FRACTION_ONE;

/// Input of [`clip_clocks`]: a crowd at one point in time.
#[derive(Debug, Clone, Copy)]
pub struct PlayedCrowd<'a> {
    /// The clips that the instances play.
    pub set: &'a ClipSet,
    /// The instances; each plays one clip of `set`.
    pub instances: &'a [Instance],
    /// Animation layers above the base, from the lowest to the highest.
    pub layers: &'a [AnimationLayer],
    /// Level of detail of each instance.
    pub lods: &'a [Lod],
    /// Seconds since the instances started.
    pub elapsed: f32,
    /// How far bones may be sampled beyond the time `elapsed`, in seconds; 0 disables sampling ahead.
    pub ahead: f32,
}

/// Clip clock of each instance. `history` has four words per instance. Initialize it with zeros and keep it from frame to frame.
///
/// # Panics
/// If `lods` or `history` has fewer entries than there are instances.
pub fn clip_clocks(crowd: &PlayedCrowd<'_>, history: &mut [[u32; 4]]) -> Vec<ClipClock> {
    let PlayedCrowd { set, instances, layers, lods, elapsed, ahead } = *crowd;
    let of = |(index, instance): (usize, &Instance)| {
        let clip = &set.clips()[instance.clip as usize];
        let inside = |elapsed: f32| {
            inside_clip(instance.wrap(), clip.duration, instance.start + instance.rate * elapsed)
        };
        let (now, later) = (inside(elapsed), inside(elapsed + ahead));
        let at = |time: f32| keyframe_cursor(set.common_times(clip), time);
        let cursor = at(now);
        let later_cursor = if ahead == 0.0 { cursor } else { at(later) };
        let above = clips_above(layers, index);
        let blended = if above != 0 { BLENDED } else { 0 };
        let base = (instance.clip + 1) | lods[index].tier << TIER_SHIFT | blended;
        let known = [base, above, now.to_bits(), later.to_bits()];
        let last = std::mem::replace(&mut history[index], known);
        let sampling = lods[index].sampling;
        let reason = if sampling == BoneSampling::Hidden {
            history[index] = [0; 4];
            UpdateReason::Hidden
        } else if sampling == BoneSampling::Forced || last[..2] != known[..2] {
            UpdateReason::Forced
        } else if blended != 0 {
            UpdateReason::Blended
        } else {
            UpdateReason::Free
        };
        let fraction =
            |cursor: KeyframeCursor| (cursor.fraction.clamp(0.0, 1.0) * FRACTION_ONE as f32) as u32;
        ClipClock {
            ahead_row: clip.first_row + later_cursor.key,
            ahead_fraction: fraction(later_cursor),
            ..ClipClock::new(clip.first_row + cursor.key, fraction(cursor), reason, instance.clip)
        }
    };
    instances.iter().enumerate().map(of).collect()
}

/// Hash of the clips that an instance plays above the base; 0 if there are none.
fn clips_above(layers: &[AnimationLayer], instance: usize) -> u32 {
    layers.iter().fold(0, |clips: u32, layer| {
        let heard = if layer.weights[instance] > 0.0 { layer.instances[instance].clip + 1 } else { 0 };
        clips.wrapping_mul(CLIP_HASH_FACTOR).wrapping_add(heard)
    })
}
