// A clip's place in a set.

struct ClipEntry {
    first_timeline: u32,
    timelines: u32,
    duration: f32,
    // Of its table of gates.
    first_row: u32,
}
