// A clip's place in a set.
struct ClipEntry {
    // Its first timeline.
    first_timeline: u32,
    // How many it has.
    timelines: u32,
    // Seconds.
    duration: f32,
    // Its first row in tables that have one for each time of its first timeline, and one more.
    first_row: u32,
}
