// Transitions between the levels of an object: from an instance's metric to a view's decision, and from the decision to list
// entries. `src/lod/transition.rs` is the reference.
import package::wgsl::lod::object::{FADE_PROGRESS, FADE_STEPS, LodObject, MORPH_STEPS, OBJECT_LEVELS, decision_level, decision_mirrored, decision_next, decision_seen, decision_steps, decision_word, fade_word, fading_list, list_entry_word, object_flags_timed, object_flags_transition, solid_list};

// Transition: levels change at once. The TRANSITION constants are values of the transition in an object's flags word.
const TRANSITION_HARD = 0u;
// Transition: vertices move to their partners in the next coarser level.
const TRANSITION_GEOMORPH = 1u;
// Transition: both levels are drawn, each in its own pixels of a pattern.
const TRANSITION_DITHER = 2u;
// Transition: both levels are blended (thesis A section 7.3.1).
const TRANSITION_CROSS_FADE = 3u;
// Transition: the current level is opaque, and the next level is blended over it (thesis A section 7.3.2).
const TRANSITION_FADE_IN = 4u;
// Transition in two phases (thesis A section 7.3.3). First the next level fades in over the opaque current level. Then the next
// level is opaque while the current level fades out.
const TRANSITION_TWO_PHASE = 5u;
// Transition: levels change at once, and instances fade out between two metrics (thesis A section 7.4).
const TRANSITION_ALPHA = 6u;

// Level of an instance that had no level in the last frame.
const NO_LEVEL = 0xffffffffu;
// List index of an entry that does not exist.
const NO_LIST = 0xffffffffu;

// Smallest metric at which a level is drawn. `last` is the instance's level in the last frame, or `NO_LEVEL`.
fn threshold_of(object: LodObject, level: u32, last: u32) -> f32 {
    let threshold = object.thresholds[level >> 2u][level & 3u];
    if last == NO_LEVEL {
        return threshold;
    }
    return threshold * select(object.coarser, object.finer, level <= last);
}

// Coarsest level whose threshold is at most `metric`. `last` is the instance's level in the last frame, or `NO_LEVEL`.
fn level_within(object: LodObject, metric: f32, last: u32) -> u32 {
    var level = 0u;
    for (var coarser = 1u; coarser < min(object.levels, OBJECT_LEVELS); coarser++) {
        if threshold_of(object, coarser, last) <= metric {
            level = coarser;
        }
    }
    return level;
}

// Progress of a metric from `begin` to `end`, in steps from 0 to `most`. `end` must be above `begin`.
fn steps_between(metric: f32, begin: f32, end: f32, most: u32) -> u32 {
    return u32(f32(most) * clamp((metric - begin) / (end - begin), 0.0, 1.0) + 0.5);
}

// Level of an instance in the last frame, or `NO_LEVEL`. `last` is the decision word of that frame. A fade in time counts as
// the level to which it leads.
fn last_level(object: LodObject, last: u32) -> u32 {
    if decision_seen(last) == 0u {
        return NO_LEVEL;
    }
    return select(decision_level(last), decision_next(last), decision_steps(last) > 0u && object_flags_timed(object.flags) != 0u);
}

// Decision word for a level that does not change.
fn settled(level: u32, mirrored: u32) -> u32 {
    return decision_word(1u, mirrored, level, level, 0u);
}

// Decision word with a geomorph: the level, and the steps towards the next coarser level.
fn morphing(object: LodObject, metric: f32, mirrored: u32) -> u32 {
    let level = level_within(object, metric, NO_LEVEL);
    if level + 1u >= min(object.levels, OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let begin = threshold_of(object, level, NO_LEVEL);
    let steps = steps_between(metric, begin, threshold_of(object, level + 1u, NO_LEVEL), MORPH_STEPS);
    return decision_word(1u, mirrored, level, level, steps);
}

// Decision word for a fade to the next coarser level while the metric passes the band around the threshold.
fn fading_in_band(object: LodObject, metric: f32, mirrored: u32) -> u32 {
    // The coarsest level whose band the metric has passed. With 0 as the last level, `level_within` uses the upper ends of the
    // bands as thresholds.
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

// Decision word for a fade that runs in time. `last` is the decision word of the last frame, `level` the level for this frame.
// If `level` is the level that the fade left, the fade turns back. Any other new level waits until the fade has ended.
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

// Metric after a budget's factor, 1 or more, has been applied.
fn coarsened(object: LodObject, metric: f32, factor: f32) -> f32 {
    return factor * metric + (factor - 1.0) * object.metric_floor;
}

// Level that hysteresis holds: the instance's level in the last frame. The result is `NO_LEVEL` for geomorphs and for fades in
// a band, because these depend only on this frame.
fn held_level(object: LodObject, last: u32) -> u32 {
    let transition = object_flags_transition(object.flags);
    let is_fading = transition >= TRANSITION_DITHER && transition <= TRANSITION_TWO_PHASE;
    let is_momentary = transition == TRANSITION_GEOMORPH || (is_fading && object_flags_timed(object.flags) == 0u);
    return select(last_level(object, last), NO_LEVEL, is_momentary);
}

// Whether an instance has faded out completely (`TRANSITION_ALPHA`).
fn is_faded_out(object: LodObject, metric: f32) -> bool {
    return object_flags_transition(object.flags) == TRANSITION_ALPHA
        && steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS) == FADE_PROGRESS;
}

// Decision word for a visible instance. `factor` is a budget's factor, which coarsens the levels. `last` is the view's decision
// word in the last frame, 0 if there is none. If `ends` is true, all fades end in this frame.
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

// Finest level that a decision draws.
fn decision_finest(decision: u32) -> u32 {
    return min(decision_level(decision), decision_next(decision));
}

// Up to two list entries of an instance, each with the index of its list.
struct Entries {
    // Index of the first entry's list, or `NO_LIST`.
    first: u32,
    // First list entry.
    first_entry: u32,
    // Index of the second entry's list, or `NO_LIST`.
    second: u32,
    // Second list entry.
    second_entry: u32,
}

// List entries for a decision word. `index` is the instance's index in its object.
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
    // Remaining weight of the current level, and weight of the next level.
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

// Single list entry of an instance that has a draw of its own.
struct SortedEntry {
    // Index of the list.
    list: u32,
    // The list entry.
    word: u32,
}

// List entry of a visible instance that has a draw of its own. The instance may morph or fade out. A fade between two levels is
// replaced by an abrupt change halfway through the fade.
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

// Weight that remains to a level after `steps` steps of a fade, from `FADE_STEPS` down to 0.
fn left_of(steps: u32) -> u32 {
    return FADE_STEPS - (steps * FADE_STEPS + FADE_PROGRESS / 2u) / FADE_PROGRESS;
}
