// Conversion of elapsed time to time inside a clip.

// Wrap code: times outside the clip are clamped to the clip's start or end. With code 0, the clip loops.
const WRAP_CLAMP = 1u;

// Number of loops at and beyond which an f32 cannot resolve a position in a clip.
const MAX_TURNS: f32 = 16777216.0;

// Converts a time in clip seconds, which may be negative, to seconds since the clip's start, 0 to `duration`. A looping clip
// never gives `duration` itself, and gives 0 for times too large to resolve.
fn inside_clip(wrap: u32, duration: f32, time: f32) -> f32 {
    if duration <= 0.0 {
        return 0.0;
    }
    if wrap == WRAP_CLAMP {
        return min(max(time, 0.0), duration);
    }
    // The comparison is false for NaN, so NaN also gives 0.
    if !(abs(time) < MAX_TURNS * duration) {
        return 0.0;
    }
    var inside = time - floor(time / duration) * duration;
    if inside < 0.0 {
        inside += duration;
    }
    if inside >= duration {
        inside -= duration;
    }
    return inside;
}
