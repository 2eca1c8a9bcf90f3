// What one character plays.
struct AnimationInstance {
    // Which clip of the set.
    clip: u32,
    // What becomes of times outside the clip: 0 loops, 1 clamps.
    wrap_code: u32,
    // Where in the clip it stands when nothing has elapsed, in seconds.
    start: f32,
    // Clip seconds a second; negative plays backwards.
    rate: f32,
}
