// A clip's place in a set.
struct ClipEntry {
    // Of its timelines, each a run of key times; how many. The first is the common one.
    first_timeline: u32,
    timelines: u32,
    // Seconds.
    duration: f32,
    // Of its table of gates.
    first_row: u32,
}
