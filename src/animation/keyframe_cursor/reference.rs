//! Keyframe cursors: the CPU reference of `kernels/animation/keyframe_cursor.wgsl`.

use crate::animation::clip_set::ClipSet;
use crate::animation::instance::Instance;
use crate::animation::instance::Wrap;
use crate::asset::keyframe::{KeyframeCursor, keyframe_cursor};
use crate::shared::animation::clock::MAX_TURNS;

/// Maps a time in seconds to a time inside a clip of `duration` seconds. The result is 0 for a loop whose time is too large to
/// resolve. The function performs the operations of `wgsl/animation/clock.wgsl` in the order of that file. [`Wrap::inside`] is
/// more exact for large times.
pub fn inside_clip(wrap: Wrap, duration: f32, time: f32) -> f32 {
    if duration <= 0.0 {
        return 0.0;
    }
    if wrap == Wrap::Clamp {
        return time.max(0.0).min(duration);
    }
    // The comparison is false for NaN, which thus gives 0.
    let is_somewhere = time.abs() < MAX_TURNS * duration;
    if !is_somewhere {
        return 0.0;
    }
    let mut inside = time - (time / duration).floor() * duration;
    if inside < 0.0 {
        inside += duration;
    }
    if inside >= duration {
        inside -= duration;
    }
    inside
}

/// Cursor of each instance on each timeline of its clip, [`ClipSet::timelines_a_clip`] per instance. A clip with fewer timelines
/// leaves its last cursors unused. This function sets unused cursors to the start; the kernel leaves them unchanged.
pub fn cursors(set: &ClipSet, instances: &[Instance], elapsed: f32) -> Vec<KeyframeCursor> {
    let mut cursors = vec![KeyframeCursor::default(); instances.len() * set.timelines_a_clip()];
    cursors_into(set, instances, elapsed, &mut cursors);
    cursors
}

/// Computes the same as [`cursors`], but into an existing slice, without allocation.
///
/// # Panics
/// If an instance's clip is not in the set.
pub fn cursors_into(set: &ClipSet, instances: &[Instance], elapsed: f32, cursors: &mut [KeyframeCursor]) {
    for (instance, cursors) in instances.iter().zip(cursors.chunks_mut(set.timelines_a_clip())) {
        let clip = &set.clips()[instance.clip as usize];
        let time = inside_clip(instance.wrap(), clip.duration, instance.start + instance.rate * elapsed);
        let timelines = &set.timelines()[clip.first_timeline as usize..][..clip.timelines as usize];
        let (used, rest) = cursors.split_at_mut(timelines.len());
        for (timeline, found) in timelines.iter().zip(used) {
            *found =
                keyframe_cursor(&set.times()[timeline.first_time as usize..][..timeline.keys as usize], time);
        }
        rest.fill(KeyframeCursor::default());
    }
}
