// From relievo's wgsl/animation/module.wgsl.
// Animation: the types in the kernels' buffers (`AnimationInstance`, `ClipEntry`, `SetTrack`, `KeyframeCursor`, `Slot`, `Lod`,
// `ClipClock`), times inside clips, rotations between keys, and the motion of bones. `build.rs` joins this file and its imports
// into one text, for shaders that are not composed with WESL. Prepend that text to your own code.

// From relievo's wgsl/animation/instance.wgsl.
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

// From relievo's wgsl/animation/clip.wgsl.
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

// Packs a word: Track: timeline 30, interpolation 2.
fn track_word(timeline: u32, interpolation: u32) -> u32 {
    return timeline | (interpolation << 30u);
}

// The 30 bits of a track word from bit 0 on.
fn track_timeline(word: u32) -> u32 {
    return word & 1073741823u;
}

// The 2 bits of a track word from bit 30 on.
fn track_interpolation(word: u32) -> u32 {
    return word >> 30u;
}

// From relievo's wgsl/animation/clock.wgsl.
// Conversion of elapsed time to time inside a clip.

// Wrap code: times outside the clip are clamped to the clip's start or end. With code 0, the clip loops.
const WRAP_CLAMP = 1u;

// Number of loops at and beyond which an f32 cannot resolve a position in a clip.
const MAX_TURNS: f32 = 16777216.0;

// Converts a time in clip seconds, which may be negative, to seconds since the clip's start, 0 to `duration`. A looping clip
// never gives `duration` itself, and gives 0 for times too large to resolve.
fn inside_clip(wrap: u32, duration: f32, time: f32) -> f32 {
    if duration <= 0.0 {
        return 0.0;
    }
    if wrap == WRAP_CLAMP {
        return min(max(time, 0.0), duration);
    }
    // The comparison is false for NaN, so NaN also gives 0.
    if !(abs(time) < MAX_TURNS * duration) {
        return 0.0;
    }
    var inside = time - floor(time / duration) * duration;
    if inside < 0.0 {
        inside += duration;
    }
    if inside >= duration {
        inside -= duration;
    }
    return inside;
}

// From relievo's wgsl/animation/interpolation.wgsl.
// Interpolation of values between keys, in tracks and in morph weights.

// Interpolation: a value stays constant until the next key.
const INTERPOLATION_STEP: u32 = 0u;
// Interpolation along a straight line; rotations take the shortest arc.
const INTERPOLATION_LINEAR: u32 = 1u;
// Interpolation by a cubic Hermite spline: a key has an in-tangent, a value and an out-tangent.
const INTERPOLATION_SPLINE: u32 = 2u;

// From relievo's wgsl/animation/order.wgsl.
// Order in which bones are processed: parents first, split into chains.

// Position of a bone in the order.
struct Slot {
    // Index of the bone.
    bone: u32,
    // Index of the parent bone, CONTINUES or NO_PARENT.
    parent: u32,
    // Number of slots of the bone and all its descendants. These slots are consecutive, and this slot is the first.
    subtree: u32,
}

// Consecutive slots that lead from parent to child.
struct Chain {
    // Index of the first slot.
    first: u32,
    // Number of slots.
    count: u32,
}

// `Slot::parent` of a root bone.
const NO_PARENT: u32 = 0xffffffffu;
// `Slot::parent` of a bone whose parent has the previous slot.
const CONTINUES: u32 = 0xfffffffeu;

// From relievo's wgsl/animation/rotation.wgsl.
// Interpolation of unit quaternions whose dot product is not negative.

// Factor of the last coefficient in `SLERP_U` and `SLERP_V`. It compensates for omitted terms of the polynomial. With this
// value, five terms have the smallest maximum error on halved arcs.
const SLERP_REST: f32 = 1.15;
// Coefficients 1/(i(2i + 1)), for i from 1 to 5, of Eberly's polynomial (Eberly 2011) for cosines from √½ to 1. The last one
// compensates for omitted terms.
const SLERP_U = array<f32, 5>(1.0 / 3.0, 1.0 / 10.0, 1.0 / 21.0, 1.0 / 36.0, SLERP_REST / 55.0);
// Coefficients i/(2i + 1), for i from 1 to 5, of Eberly's polynomial. The last one compensates for omitted terms.
const SLERP_V = array<f32, 5>(1.0 / 3.0, 2.0 / 5.0, 3.0 / 7.0, 4.0 / 9.0, SLERP_REST * 5.0 / 11.0);

// sin(t theta) / sin(theta), for two values of t at once. `less_one` is cos(theta) - 1.
fn slerp_weights(t: vec2<f32>, less_one: f32) -> vec2<f32> {
    let square = t * t;
    var sum = 1.0 + (SLERP_U[4] * square - SLERP_V[4]) * less_one;
    sum = 1.0 + (SLERP_U[3] * square - SLERP_V[3]) * less_one * sum;
    sum = 1.0 + (SLERP_U[2] * square - SLERP_V[2]) * less_one * sum;
    sum = 1.0 + (SLERP_U[1] * square - SLERP_V[1]) * less_one * sum;
    sum = 1.0 + (SLERP_U[0] * square - SLERP_V[0]) * less_one * sum;
    return t * sum;
}

// Spherical interpolation of unit quaternions (x, y, z, w) at constant speed on the shortest arc, for `t` from 0 to 1. The dot
// product of `a` and `b` must not be negative. The arc is halved: the polynomial runs from the nearer end to the unit
// quaternion in the middle. The error is within 1e-6.
fn slerp(a: vec4<f32>, b: vec4<f32>, t: f32) -> vec4<f32> {
    let cosine = dot(a, b);
    let inverse = inverseSqrt(2.0 + 2.0 * cosine);
    let less_one = (1.0 + cosine) * inverse - 1.0;
    let is_first = t < 0.5;
    let way = select(2.0 - 2.0 * t, 2.0 * t, is_first);
    let weights = slerp_weights(vec2<f32>(way, 1.0 - way), less_one);
    let of_middle = weights.x * inverse;
    let of_nearer = weights.y + of_middle;
    return select(b, a, is_first) * of_nearer + select(a, b, is_first) * of_middle;
}

// The quaternion scaled to length 1. Its length must not be 0.
fn unit_quaternion(q: vec4<f32>) -> vec4<f32> {
    return q * inverseSqrt(dot(q, q));
}

// From relievo's wgsl/animation/gate_state.wgsl.
// Per-instance state that gates read.
//
// Progress word of `ClipClock::fraction_and_reason`: the fraction of the interval to the next row, and the update reason.
// packed Progress: fraction 20, reason 12

// Level of detail of an instance, as gates read it.
struct Lod {
    // Level of detail by distance, Ω: 0 to [`OMEGA_ONE`]. At [`OMEGA_ONE`], no update is skipped. See [`Range::omega`].
    omega: u32,
    // Motion that a gate may miss, in units of the gate's table. See [`Projection::allowed`].
    allowed: u32,
    // Weight of this instance's motion relative to other instances, 0 to FULL_WEIGHT, proportional to the instance's size on
    // screen.
    weight: u32,
    // Flags word: LOD_HIDDEN, LOD_FORCED or 0, and the skeleton tier. An instance with both flags counts as hidden and is not
    // sampled.
    flags: u32,
}

// Word of `Lod.flags`: the LOD flags, and the index of the skeleton tier whose bones are sampled. Tier 0 is the whole skeleton.
// packed LodFlags: bits 8, tier 8

// Flag of an instance that is not in view. The instance costs nothing, and is sampled in full when it comes back into view.
const LOD_HIDDEN: u32 = 1u;
// Flag of an instance that is sampled in full this frame, whatever the gate says.
const LOD_FORCED: u32 = 2u;
// Value of `Lod::omega` at full detail.
const OMEGA_ONE: u32 = 65536u;
// Value of `Lod::weight` for an instance that counts in full.
const FULL_WEIGHT: u32 = 65535u;

// Position of an instance in its clip, on the clip's common timeline (its first one).
struct ClipClock {
    // Index of a row in the gate's table: the clip's first row, plus the index of the last key at or before the current time.
    row: u32,
    // Progress word: the fraction of the interval to the next row, 0 to FRACTION_ONE, and the [`UpdateReason`].
    fraction_and_reason: u32,
    // Index of the clip in its set.
    clip: u32,
    // Row at the look-ahead time: a later time, for which bones may already be sampled in this frame. It equals `row` if there
    // is no look-ahead time.
    ahead_row: u32,
    // Fraction of the interval from the look-ahead row to the next row, 0 to FRACTION_ONE.
    ahead_fraction: u32,
}

// The fraction 1 in fixed point: the whole interval from one row to the next.
const FRACTION_ONE: u32 = 65536u;

// Update reason: the gate decides which bones are sampled.
const UPDATE_REASON_FREE: u32 = 0u;
// Update reason: no bone is sampled.
const UPDATE_REASON_HIDDEN: u32 = 1u;
// Update reason: all bones are sampled.
const UPDATE_REASON_FORCED: u32 = 2u;
// Update reason: layers are blended over the clip.
const UPDATE_REASON_BLENDED: u32 = 3u;

// Update reason of an instance: one of the UPDATE_REASON constants.
fn update_reason_of(clip_clock: ClipClock) -> u32 {
    return progress_reason(clip_clock.fraction_and_reason);
}

// Whether the pose at the look-ahead time differs from the current one.
fn is_ahead(clip_clock: ClipClock) -> bool {
    return clip_clock.ahead_row != clip_clock.row || clip_clock.ahead_fraction != fraction_of(clip_clock);
}

// Fraction of the interval to the next row, 0 to FRACTION_ONE.
fn fraction_of(clip_clock: ClipClock) -> u32 {
    return progress_fraction(clip_clock.fraction_and_reason);
}

// Flag in the word of a pair, which stands for one bone of one instance: the bone is sampled at the look-ahead time.
const PAIR_AHEAD: u32 = 0x80000000u;

// Packs a word: Progress: fraction 20, reason 12.
fn progress_word(fraction: u32, reason: u32) -> u32 {
    return fraction | (reason << 20u);
}

// The 20 bits of a progress word from bit 0 on.
fn progress_fraction(word: u32) -> u32 {
    return word & 1048575u;
}

// The 12 bits of a progress word from bit 20 on.
fn progress_reason(word: u32) -> u32 {
    return word >> 20u;
}

// Packs a word: LodFlags: bits 8, tier 8.
fn lod_flags_word(bits: u32, tier: u32) -> u32 {
    return bits | (tier << 8u);
}

// The 8 bits of a lod_flags word from bit 0 on.
fn lod_flags_bits(word: u32) -> u32 {
    return word & 255u;
}

// The 8 bits of a lod_flags word from bit 8 on.
fn lod_flags_tier(word: u32) -> u32 {
    return (word >> 8u) & 255u;
}

// From relievo's wgsl/animation/motion.wgsl.
// Accumulated motion of bones along their clips, in units of the gate's table.

// value * fraction / 65536, computed without overflow. `fraction` is at most 65536.
fn scale_by_fraction(value: u32, fraction: u32) -> u32 {
    return (value >> 16u) * fraction + (((value & 0xffffu) * (fraction & 0xffffu)) >> 16u)
        + (value & 0xffffu) * (fraction >> 16u);
}

// Accumulated motion at a time between two rows. `row` has the motion at the first row (x) and the increase up to the next row
// (y). `fraction` is the position between the rows, 0 to 65536.
fn motion_at(row: vec2<u32>, fraction: u32) -> u32 {
    return row.x + scale_by_fraction(row.y, fraction);
}

// Difference of two accumulated motions: the direct one or the one across the clip's end, whichever is smaller. `period` is the
// motion over the whole clip.
fn motion_between(now: u32, last: u32, period: u32) -> u32 {
    let direct = max(now, last) - min(now, last);
    return min(direct, max(period, direct) - direct);
}

// From relievo's wgsl/dispatch.wgsl.
// `value`, which all threads have, as a value of a thread. Driver workaround: where uniforms alone decide a branch or a loop's end,
// lavapipe compiles the kernel again in each submission (docs/drivers.md). `thread` is any index of the thread, below 2³² - 1.
fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 0xffffffffu);
}

// Size of a dispatch in workgroups along x, y and z, with at least `groups` workgroups in total. A row along x has at most
// `most` workgroups (maxComputeWorkgroupsPerDimension, at least 1). If `groups` is 0, the size along y is 0. Workgroup (x, y)
// has the index y * (size along x) + x. Workgroups with the index `groups` or higher have nothing to do.
fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}
