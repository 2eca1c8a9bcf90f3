// Where in its clip a time falls.

// Stays at the clip's start and end. 0 loops.
const WRAP_CLAMP = 1u;

// After so many turns, f32 knows no place in a clip.
const MAX_TURNS = 16777216.0;

// Seconds since the clip's start, 0 to `duration`, of a time in clip seconds, which may be negative; a loop never reaches
// its end. Its start, where a loop's time is so large that it is nowhere.
fn inside_clip(wrap: u32, duration: f32, time: f32) -> f32 {
    if duration <= 0.0 {
        return 0.0;
    }
    if wrap == WRAP_CLAMP {
        return min(max(time, 0.0), duration);
    }
    // NaN is not below.
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
