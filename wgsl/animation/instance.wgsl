// What one character plays.
struct AnimationInstance {
    clip: u32,
    // 0 loop, 1 clamp
    wrap: u32,
    // Where in the clip it stands when nothing has elapsed, in seconds.
    start: f32,
    // Clip seconds a second.
    rate: f32,
}
