// The clip that a character plays, and how the character plays it.
struct AnimationInstance {
    // Index of the clip in the set.
    clip: u32,
    // Treatment of times outside the clip: 0 loops, 1 clamps.
    wrap_code: u32,
    // Time inside the clip at elapsed time 0, in seconds.
    start: f32,
    // Playback rate in clip seconds per second; negative plays backwards.
    rate: f32,
}
