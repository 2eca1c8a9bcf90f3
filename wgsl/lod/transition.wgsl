// Transitions between the levels of an object: from the metric of an instance to the decision of a view, and from the decision
// to list entries. `src/lod/transition.rs` is the reference.
import package::wgsl::lod::object::{FADE_PROGRESS, FADE_STEPS, LodObject, MORPH_STEPS, OBJECT_LEVELS, decision_level, decision_mirrored, decision_next, decision_seen, decision_steps, decision_word, fade_word, fading_list, list_entry_word, object_flags_timed, object_flags_transition, solid_list};

// Transitions in the flags word of an object. At once;
const TRANSITION_HARD = 0u;
// vertices move to their partners in the next coarser level;
const TRANSITION_GEOMORPH = 1u;
// both levels, each in its own pixels of a pattern;
const TRANSITION_DITHER = 2u;
// both levels blended (A section 7.3.1);
const TRANSITION_CROSS_FADE = 3u;
// the level opaque, and the next one blended over it (A section 7.3.2);
const TRANSITION_FADE_IN = 4u;
// the level opaque while the next one fades in, then the next one opaque while the level fades out (A section 7.3.3);
const TRANSITION_TWO_PHASE = 5u;
// levels change at once, and instances fade out between two metrics (A section 7.4).
const TRANSITION_ALPHA = 6u;

// No level of the last frame.
const NO_LEVEL = 0xffffffffu;
// No list.
const NO_LIST = 0xffffffffu;

// Smallest metric at which a level is drawn, for an instance whose level in the last frame was `last`, or `NO_LEVEL`.
fn threshold_of(object: LodObject, level: u32, last: u32) -> f32 {
    let threshold = object.thresholds[level >> 2u][level & 3u];
    if last == NO_LEVEL {
        return threshold;
    }
    return threshold * select(object.coarser, object.finer, level <= last);
}

// The coarsest level whose threshold is at most `metric`.
fn level_within(object: LodObject, metric: f32, last: u32) -> u32 {
    var level = 0u;
    for (var coarser = 1u; coarser < min(object.levels, OBJECT_LEVELS); coarser++) {
        if threshold_of(object, coarser, last) <= metric {
            level = coarser;
        }
    }
    return level;
}

// Steps of `most` that a metric has gone from one number to another. `end` is above `begin`.
fn steps_between(metric: f32, begin: f32, end: f32, most: u32) -> u32 {
    return u32(f32(most) * clamp((metric - begin) / (end - begin), 0.0, 1.0) + 0.5);
}

// The level of an instance in the last frame, or `NO_LEVEL`. A fade in time counts as the level that it leads to.
fn last_level(object: LodObject, last: u32) -> u32 {
    if decision_seen(last) == 0u {
        return NO_LEVEL;
    }
    return select(decision_level(last), decision_next(last), decision_steps(last) > 0u && object_flags_timed(object.flags) != 0u);
}

// The decision for a level that does not change.
fn settled(level: u32, mirrored: u32) -> u32 {
    return decision_word(1u, mirrored, level, level, 0u);
}

// A geomorph: the steps towards the next coarser level.
fn morphing(object: LodObject, metric: f32, mirrored: u32) -> u32 {
    let level = level_within(object, metric, NO_LEVEL);
    if level + 1u >= min(object.levels, OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let begin = threshold_of(object, level, NO_LEVEL);
    let steps = steps_between(metric, begin, threshold_of(object, level + 1u, NO_LEVEL), MORPH_STEPS);
    return decision_word(1u, mirrored, level, level, steps);
}

// A fade from a level to the next coarser one while the metric passes the band around the threshold.
fn fading_in_band(object: LodObject, metric: f32, mirrored: u32) -> u32 {
    // The coarsest level whose band is passed: as if the last level were the finest.
    let level = level_within(object, metric, 0u);
    if level + 1u >= min(object.levels, OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let next = level + 1u;
    let begin = threshold_of(object, next, next);
    let steps = steps_between(metric, begin, threshold_of(object, next, 0u), FADE_PROGRESS);
    if steps == FADE_PROGRESS {
        return settled(next, mirrored);
    }
    return decision_word(1u, mirrored, level, select(level, next, steps > 0u), steps);
}

// A fade that runs in time, from the decision of the last frame to the level of this one. It turns back if the level that it
// left is right again; any other level waits until it has ended.
fn fading_in_time(object: LodObject, level: u32, mirrored: u32, last: u32, seconds: f32) -> u32 {
    if decision_seen(last) == 0u {
        return settled(level, mirrored);
    }
    var left = decision_level(last);
    var to = decision_next(last);
    var done = decision_steps(last);
    if done == 0u {
        to = level;
    } else if level == left {
        to = left;
        left = decision_next(last);
        done = FADE_PROGRESS - done;
    }
    if left == to {
        return settled(left, mirrored);
    }
    let steps = done + max(u32(min(object.rate * seconds, f32(FADE_PROGRESS)) + 0.5), 1u);
    if steps >= FADE_PROGRESS {
        return settled(to, mirrored);
    }
    return decision_word(1u, mirrored, left, to, steps);
}

// The metric that a budget's factor, 1 or more, makes of a metric.
fn coarsened(object: LodObject, metric: f32, factor: f32) -> f32 {
    return factor * metric + (factor - 1.0) * object.metric_floor;
}

// The level of the last frame that hysteresis holds, or `NO_LEVEL`: fades in a band and geomorphs depend on this frame alone.
fn held_level(object: LodObject, last: u32) -> u32 {
    let transition = object_flags_transition(object.flags);
    let is_fading = transition >= TRANSITION_DITHER && transition <= TRANSITION_TWO_PHASE;
    let is_momentary = transition == TRANSITION_GEOMORPH || (is_fading && object_flags_timed(object.flags) == 0u);
    return select(last_level(object, last), NO_LEVEL, is_momentary);
}

// Whether an instance has faded out (`TRANSITION_ALPHA`).
fn is_faded_out(object: LodObject, metric: f32) -> bool {
    return object_flags_transition(object.flags) == TRANSITION_ALPHA
        && steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS) == FADE_PROGRESS;
}

// The decision for a visible instance. `factor` coarsens its levels, for a budget; `last` is the view's decision in the last
// frame, 0 if there is none; `ends` ends all fades.
fn transition_decision(object: LodObject, metric: f32, factor: f32, mirrored: u32, last: u32, seconds: f32, ends: bool) -> u32 {
    let transition = object_flags_transition(object.flags);
    let within = coarsened(object, metric, factor);
    if transition == TRANSITION_GEOMORPH {
        return morphing(object, within, mirrored);
    }
    let is_fading = transition >= TRANSITION_DITHER && transition <= TRANSITION_TWO_PHASE && !ends;
    let is_timed = object_flags_timed(object.flags) != 0u;
    if is_fading && !is_timed {
        return fading_in_band(object, within, mirrored);
    }
    let level = level_within(object, within, held_level(object, last));
    if is_fading {
        return fading_in_time(object, level, mirrored, last, seconds);
    }
    if transition != TRANSITION_ALPHA {
        return settled(level, mirrored);
    }
    let steps = steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS);
    return select(decision_word(1u, mirrored, level, level, steps), 0u, steps == FADE_PROGRESS);
}

// The finest level that a decision draws.
fn decision_finest(decision: u32) -> u32 {
    return min(decision_level(decision), decision_next(decision));
}

// The lists of an instance, or `NO_LIST`, and its entries there.
struct Entries {
    first: u32,
    first_entry: u32,
    second: u32,
    second_entry: u32,
}

// The list entries of a decision. `index` is the instance's index in the object.
fn transition_entries(object: LodObject, decision: u32, index: u32) -> Entries {
    if decision_seen(decision) == 0u {
        return Entries(NO_LIST, 0u, NO_LIST, 0u);
    }
    let level = decision_level(decision);
    let next = decision_next(decision);
    let mirrored = decision_mirrored(decision);
    let steps = decision_steps(decision);
    let transition = object_flags_transition(object.flags);
    let solid = solid_list(level, mirrored);
    if steps == 0u {
        return Entries(solid, list_entry_word(index, level, 0u), NO_LIST, 0u);
    }
    // The weight that the level has left, and what the next level has.
    let left = left_of(steps);
    let gained = FADE_STEPS - left;
    let fading = fading_list(object, level, mirrored);
    let next_fading = fading_list(object, next, mirrored);
    switch transition {
        case TRANSITION_DITHER: {
            return Entries(
                fading, list_entry_word(index, level, fade_word(left, 0u)),
                next_fading, list_entry_word(index, next, fade_word(left, 1u)));
        }
        case TRANSITION_CROSS_FADE: {
            return Entries(
                fading, list_entry_word(index, level, fade_word(left, 0u)),
                next_fading, list_entry_word(index, next, fade_word(gained, 0u)));
        }
        case TRANSITION_FADE_IN: {
            return Entries(
                solid, list_entry_word(index, level, 0u),
                next_fading, list_entry_word(index, next, fade_word(gained, 0u)));
        }
        case TRANSITION_TWO_PHASE: {
            if left > gained {
                return Entries(
                    solid, list_entry_word(index, level, 0u),
                    next_fading, list_entry_word(index, next, fade_word(2u * gained, 0u)));
            }
            return Entries(
                solid_list(next, mirrored), list_entry_word(index, next, 0u),
                fading, list_entry_word(index, level, fade_word(2u * left, 0u)));
        }
        case TRANSITION_ALPHA: {
            return Entries(fading, list_entry_word(index, level, fade_word(left, 0u)), NO_LIST, 0u);
        }
        default: {
            return Entries(solid, list_entry_word(index, level, steps), NO_LIST, 0u);
        }
    }
}

// The only entry of an instance that is drawn by itself, and its list.
struct SortedEntry {
    list: u32,
    word: u32,
}

// The entry of a visible instance that is drawn by itself: it changes its level at once, at the middle of a fade, but may
// morph, and fade out.
fn sorted_entry(object: LodObject, decision: u32, index: u32) -> SortedEntry {
    let steps = decision_steps(decision);
    let transition = object_flags_transition(object.flags);
    var level = decision_level(decision);
    var word = 0u;
    if transition == TRANSITION_GEOMORPH {
        word = steps;
    } else if transition == TRANSITION_ALPHA {
        word = fade_word(left_of(steps), 0u);
    } else if 2u * steps > FADE_PROGRESS {
        level = decision_next(decision);
    }
    return SortedEntry(solid_list(level, decision_mirrored(decision)), list_entry_word(index, level, word));
}

// Weight that is left after so many steps of a fade.
fn left_of(steps: u32) -> u32 {
    return FADE_STEPS - (steps * FADE_STEPS + FADE_PROGRESS / 2u) / FADE_PROGRESS;
}
