// Search of a time among the key times of a timeline.
import package::wgsl::animation::clip::{KeyframeCursor, Timeline};

// Key times of all timelines, in seconds.
@group(0) @binding(4) var<storage, read> times: array<f32>;

// Cursor of a time on a timeline. Among equal key times, the last one counts.
fn keyframe_cursor(timeline: Timeline, time: f32) -> KeyframeCursor {
    let first = timeline.first_time;
    let last = timeline.keys - 1u;
    let start = times[first];
    if time < start {
        return KeyframeCursor(0u, 0.0);
    }
    let end_time = times[first + last];
    if time >= end_time {
        return KeyframeCursor(last, 0.0);
    }
    // Most clips have evenly spaced keys, so a first guess is usually right.
    let evenly = (time - start) / (end_time - start) * f32(last);
    var key = min(u32(evenly), last - 1u);
    var before = times[first + key];
    var after = times[first + key + 1u];
    if before > time || after <= time {
        var end = last;
        key = 0u;
        while end - key > 1u {
            let middle = (key + end) / 2u;
            if times[first + middle] <= time {
                key = middle;
            } else {
                end = middle;
            }
        }
        before = times[first + key];
        after = times[first + key + 1u];
    }
    return KeyframeCursor(key, (time - before) / (after - before));
}
