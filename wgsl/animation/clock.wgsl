// Where in its clip a time falls.

struct Clock {
    // Seconds since the clip's start, inside the clip.
    inside: f32,
    // How often the clip began again before; negative before its first start.
    turns: i32,
}

// 0 is WRAP_LOOP.
const WRAP_CLAMP = 1u;
const MOST_TURNS = 1e9;

fn clock(wrap: u32, duration: f32, time: f32) -> Clock {
    if duration <= 0.0 {
        return Clock(0.0, 0);
    }
    if wrap == WRAP_CLAMP {
        return Clock(min(max(time, 0.0), duration), 0);
    }
    var turns = floor(time / duration);
    var inside = time - turns * duration;
    if inside < 0.0 {
        inside += duration;
        turns -= 1.0;
    }
    if inside >= duration {
        inside -= duration;
        turns += 1.0;
    }
    return Clock(inside, i32(clamp(turns, -MOST_TURNS, MOST_TURNS)));
}
