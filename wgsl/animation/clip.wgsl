// Tables of a set of animation clips, and positions in time.
//
// Track word: the track's timeline, counted from the clip's first timeline, or CONSTANT; and its interpolation
// (INTERPOLATION_STEP, INTERPOLATION_LINEAR or INTERPOLATION_SPLINE).
// packed Track: timeline 30, interpolation 2

// Location of a clip's data in a set of clips.
struct ClipEntry {
    // Index of the clip's first timeline.
    first_timeline: u32,
    // Number of the clip's timelines.
    timelines: u32,
    // Duration of the clip in seconds.
    duration: f32,
    // Index of the clip's first row in gate tables. A clip has one row per time of its first timeline, and one row for the
    // whole clip.
    first_row: u32,
}

// A list of key times that several tracks share.
struct Timeline {
    // Index of the timeline's first key time.
    first_time: u32,
    // Number of key times, at least 1.
    keys: u32,
}

// A position between two keys of a timeline.
struct KeyframeCursor {
    // Index of the last key at or before the time, counted from the timeline's first key; 0 before the first key.
    key: u32,
    // Fraction of the interval from `key` to the next key, 0 to below 1. The fraction is 0 before the first key and after the
    // last.
    fraction: f32,
}

// Cursor that is stored in two words. Sampling loads both words in one memory operation. The members of a struct would take one
// operation each, and on CPUs, the number of memory operations decides the speed of sampling.
fn cursor_of_words(words: vec2<u32>) -> KeyframeCursor {
    return KeyframeCursor(words.x, bitcast<f32>(words.y));
}

// A track of a set of clips, in two words that one memory operation loads. Read the track with `timeline_of`,
// `interpolation_of` and `first_value_of`.
struct SetTrack {
    // x: the track word. y: the index of the track's first value. If the track is a constant spline, it has three values, and y
    // is the index of the middle one.
    words: vec2<u32>,
}

// Timeline number of a track whose value never changes.
const CONSTANT: u32 = 0x3fffffffu;

// Timeline of a track, counted from the clip's first timeline, or CONSTANT.
fn timeline_of(track: SetTrack) -> u32 {
    return track_timeline(track.words.x);
}

// Interpolation between a track's keys: one of the INTERPOLATION constants.
fn interpolation_of(track: SetTrack) -> u32 {
    return track_interpolation(track.words.x);
}

// Index of a track's first value. A constant spline has three values; the result is the index of the middle one.
fn first_value_of(track: SetTrack) -> u32 {
    return track.words.y;
}
