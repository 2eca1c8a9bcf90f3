//! Where instances stand on their clips' common timelines: twin of `kernels/animation/phase.wgsl`.

use super::place::{inside_clip, place};
use crate::animation::clip_set::ClipSet;
use crate::animation::layers::Layer;
use crate::animation::lod::Lod;
use crate::animation::phase::{BLENDED, Phase, Verdict};
use crate::animation::place::Instance;

/// The phase of each instance. `layers` are those above the base; `history` is kept from frame to frame, and zero at first.
///
/// # Panics
/// With fewer places, levels or histories than instances.
pub fn phases(
    set: &ClipSet,
    instances: &[Instance],
    layers: &[Layer],
    lods: &[Lod],
    elapsed: f32,
    history: &mut [[u32; 4]],
) -> Vec<Phase> {
    let of = |(index, instance): (usize, &Instance)| {
        let clip = &set.clips()[instance.clip as usize];
        let time = instance.start + instance.rate * elapsed;
        let inside = inside_clip(instance.wrap(), clip.duration, time);
        let place = place(set.common_times(clip), inside);
        let above = clips_above(layers, index);
        let blended = if above != 0 { BLENDED } else { 0 };
        let known = [(instance.clip + 1) | blended, above, inside.to_bits(), 0];
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
        let fraction = (place.fraction.clamp(0.0, 1.0) * 65536.0) as u32;
        Phase::new(clip.first_row + place.key, fraction, verdict, instance.clip)
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
