// Where in its clip a time falls.

// 0 is WRAP_LOOP.
const WRAP_CLAMP = 1u;

// After so many turns, f32 knows no place in a clip.
const MOST_TURNS = 16777216.0;

// Seconds since the clip's start, inside the clip. Its start, where a loop's time is so large that it is nowhere.
fn inside_clip(wrap: u32, duration: f32, time: f32) -> f32 {
    if duration <= 0.0 {
        return 0.0;
    }
    if wrap == WRAP_CLAMP {
        return min(max(time, 0.0), duration);
    }
    // NaN is not below.
    if !(abs(time) < MOST_TURNS * duration) {
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
