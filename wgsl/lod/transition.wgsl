// Transitions between the levels of an object: from the metric of an instance to the decision of a view.
// `src/lod/transition.rs` is the reference.
import package::wgsl::lod::object::{LodObject, MORPH_STEPS, OBJECT_LEVELS, decision_word, morph_word, object_flags_transition};

// Transitions in the flags word of an object.
const TRANSITION_HARD = 0u;
// Vertices move to their partners in the next coarser level.
const TRANSITION_GEOMORPH = 1u;

// Smallest metric at which a level is drawn.
fn threshold_of(object: LodObject, level: u32) -> f32 {
    return object.errors[level >> 2u][level & 3u];
}

// The coarsest level whose threshold is at most `metric`.
fn level_within(object: LodObject, metric: f32) -> u32 {
    var level = 0u;
    for (var coarser = 1u; coarser < min(object.levels, OBJECT_LEVELS); coarser++) {
        if threshold_of(object, coarser) <= metric {
            level = coarser;
        }
    }
    return level;
}

// The morph word of an instance at `level`; 0 if it does not morph.
fn morph_within(object: LodObject, level: u32, metric: f32) -> u32 {
    if object_flags_transition(object.flags) != TRANSITION_GEOMORPH || level + 1u >= min(object.levels, OBJECT_LEVELS) {
        return 0u;
    }
    let begin = threshold_of(object, level);
    if metric <= begin {
        return 0u;
    }
    // The next level's threshold is above `metric`.
    let way = min((metric - begin) / (threshold_of(object, level + 1u) - begin), 1.0);
    let steps = u32(f32(MORPH_STEPS) * way + 0.5);
    return select(0u, morph_word(level, steps), steps > 0u);
}

// The decision for a visible instance. The lists of instances that are not mirrored and of mirrored ones alternate.
fn transition_decision(object: LodObject, is_mirrored: bool, metric: f32) -> u32 {
    let level = level_within(object, metric);
    return decision_word(1u + 2u * level + u32(is_mirrored), morph_within(object, level, metric));
}
