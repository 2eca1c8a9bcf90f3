// The tables of a set of clips, and positions in time.
//
// Track word: the timeline, counted from the clip's first, or CONSTANT; and INTERPOLATION_STEP, INTERPOLATION_LINEAR or
// INTERPOLATION_SPLINE.
// packed Track: timeline 30, interpolation 2

// Location of a clip's data in a set of clips.
struct ClipEntry {
    // Index of its first timeline.
    first_timeline: u32,
    // Number of its timelines.
    timelines: u32,
    // Duration in seconds.
    duration: f32,
    // Index of its first row in gate tables. A clip has one row per time of its first timeline, and one more.
    first_row: u32,
}

// A list of key times that tracks share.
struct Timeline {
    // Index of the first time.
    first_time: u32,
    // Number of times, at least 1.
    keys: u32,
}

// A position between two keys of a timeline.
struct KeyframeCursor {
    // The key before the time.
    key: u32,
    // The fraction of the way from that key to the next, 0 to below 1; 0 before the first key and after the last.
    fraction: f32,
}

// The cursor in these two words. Sampling loads both in one memory operation, which decides its speed on CPUs. The members of a
// struct would take one operation each.
fn cursor_of_words(words: vec2<u32>) -> KeyframeCursor {
    return KeyframeCursor(words.x, bitcast<f32>(words.y));
}

// A track of a set, in two words that one memory operation loads; see timeline_of, interpolation_of and
// first_value_of.
struct SetTrack {
    // x: a track word. y: the index of the first value; for a constant spline, of the middle one of its three.
    words: vec2<u32>,
}

// The timeline of a track whose value never changes.
const CONSTANT: u32 = 0x3fffffffu;

// The timeline of a track, counted from the clip's first, or CONSTANT.
fn timeline_of(track: SetTrack) -> u32 {
    return track_timeline(track.words.x);
}

// Interpolation between a track's keys: INTERPOLATION_STEP or another.
fn interpolation_of(track: SetTrack) -> u32 {
    return track_interpolation(track.words.x);
}

// The index of a track's first value; for a constant spline, of the middle one of its three.
fn first_value_of(track: SetTrack) -> u32 {
    return track.words.y;
}
