// Where the parts of a clip lie in a set.
struct ClipEntry {
    // Index of its first timeline.
    first_timeline: u32,
    // Number of its timelines.
    timelines: u32,
    // Duration in seconds.
    duration: f32,
    // Its first row in gate tables, which have one row for each time of its first timeline and one more.
    first_row: u32,
}
