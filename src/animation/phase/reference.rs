//! Where instances stand on their clips' common timelines: twin of `kernels/animation/phase.wgsl`.

use crate::animation::clip_set::ClipSet;
use crate::animation::instance::Instance;
use crate::animation::layers::Layer;
use crate::animation::lod::Lod;
use crate::animation::phase::{BLENDED, Phase, Verdict};
use crate::animation::place::reference::inside_clip;
use crate::asset::keyframe::Place;
use crate::asset::keyframe::place;

/// The phase of each instance. `layers` are those above the base; bones may be sampled `ahead` seconds ahead; `history` is
/// kept from frame to frame, and zero at first.
///
/// # Panics
/// With fewer places, levels or histories than instances.
pub fn phases(
    set: &ClipSet,
    instances: &[Instance],
    layers: &[Layer],
    lods: &[Lod],
    elapsed: f32,
    ahead: f32,
    history: &mut [[u32; 4]],
) -> Vec<Phase> {
    let of = |(index, instance): (usize, &Instance)| {
        let clip = &set.clips()[instance.clip as usize];
        let inside = |elapsed: f32| {
            inside_clip(instance.wrap(), clip.duration, instance.start + instance.rate * elapsed)
        };
        let (now, later) = (inside(elapsed), inside(elapsed + ahead));
        let at = |time: f32| place(set.common_times(clip), time);
        let place = at(now);
        let later_place = if ahead == 0.0 { place } else { at(later) };
        let above = clips_above(layers, index);
        let blended = if above != 0 { BLENDED } else { 0 };
        let known = [(instance.clip + 1) | blended, above, now.to_bits(), later.to_bits()];
        let last = std::mem::replace(&mut history[index], known);
        let flags = lods[index].flags;
        let verdict = if flags & Lod::HIDDEN != 0 {
            history[index] = [0; 4];
            Verdict::Hidden
        } else if flags & Lod::REFRESH != 0 || last[..2] != known[..2] {
            Verdict::Forced
        } else if blended != 0 {
            Verdict::Blended
        } else {
            Verdict::Free
        };
        let fraction = |place: Place| (place.fraction.clamp(0.0, 1.0) * 65536.0) as u32;
        Phase {
            ahead_row: clip.first_row + later_place.key,
            ahead_fraction: fraction(later_place),
            ..Phase::new(clip.first_row + place.key, fraction(place), verdict, instance.clip)
        }
    };
    instances.iter().enumerate().map(of).collect()
}

/// A number of the clips that play above the base; 0 where none does.
fn clips_above(layers: &[Layer], instance: usize) -> u32 {
    layers.iter().fold(0, |clips: u32, layer| {
        let heard = if layer.weights[instance] > 0.0 { layer.instances[instance].clip + 1 } else { 0 };
        clips.wrapping_mul(31).wrapping_add(heard)
    })
}
