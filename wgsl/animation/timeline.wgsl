// The position of a time among the key times of a timeline.

@group(0) @binding(4) var<storage, read> times: array<f32>;

// The cursor, a key and (as bits) a fraction, on the timeline with the given first time and number of keys. Of
// equal times the last counts.
fn keyframe_cursor(first: u32, keys: u32, time: f32) -> vec2<u32> {
    let last = keys - 1u;
    let start = times[first];
    if time < start {
        return vec2<u32>(0u);
    }
    let end_time = times[first + last];
    if time >= end_time {
        return vec2<u32>(last, 0u);
    }
    // Most clips have evenly spaced keys, so that a first guess is usually right.
    let evenly = (time - start) / (end_time - start) * f32(last);
    var key = min(u32(evenly), last - 1u);
    var before = times[first + key];
    var after = times[first + key + 1u];
    if before > time || after <= time {
        var end = last;
        key = 0u;
        while end - key > 1u {
            let middle = (key + end) / 2u;
            if times[first + middle] <= time {
                key = middle;
            } else {
                end = middle;
            }
        }
        before = times[first + key];
        after = times[first + key + 1u];
    }
    return vec2<u32>(key, bitcast<u32>((time - before) / (after - before)));
}
