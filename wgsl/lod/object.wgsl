// Objects of a scene. All instances of one model share an object.

// The largest number of levels of detail of an object, the finest included.
const OBJECT_LEVELS = 8u;
// The largest number of lists of an object in a view: per level, one of instances that are not mirrored and one of mirrored
// instances, and the same again for instances that fade (`fading_list`).
const OBJECT_LISTS = 32u;
// Number of instances in a block. Each object takes whole blocks.
const BLOCK = 64u;
// Object index of a block that belongs to no object.
const NO_OBJECT = 0xffffffffu;

// Flags of an object: whether it is visible as a whole; whether its instances are drawn outside the view volume too; whether
// its transition runs in time; its transition (`wgsl/lod/transition.wgsl`); its criterion (`wgsl/lod/criterion.wgsl`).
// packed ObjectFlags: shown 1, never_culled 1, timed 1, transition 4, criterion 4
// Metric word of an instance in a view: its metric without the sign bit, and whether its placement mirrors. `UNSEEN_METRIC`:
// not visible.
// packed Metric: bits 31, mirrored 1
// A view's decision for a visible instance: its level, the level that it changes to, and the steps of the change. A geomorph
// takes up to `MORPH_STEPS`, a fade up to `FADE_PROGRESS`; 0: no change. The word is 0 if the instance is not visible.
// packed Decision: seen 1, mirrored 1, level 3, next 3, steps 16
// An entry of a list: the instance's index, counted from the object's first one, its level, and its steps: those of a geomorph,
// or a fade word.
// packed ListEntry: instance 20, level 3, steps 9
// Fade word: the weight of the instance, up to `FADE_STEPS`, and whether it covers the pixels that this weight leaves.
// packed Fade: weight 7, rest 1
// Number of steps from one level to the next, of a geomorph.
const MORPH_STEPS = 511u;
// Number of steps of a fade's weight, in a list entry.
const FADE_STEPS = 127u;
// Number of steps of a fade, in a decision.
const FADE_PROGRESS = 65535u;

// Number of ranks.
const RANKS = 8u;
// Rank of an object that the budget spares.
const NO_RANK = 8u;

// Metric word of an instance that the view does not see.
const UNSEEN_METRIC = 0xffffffffu;

// How the instances of an object are selected and listed.
struct LodObject {
    // Index of its first instance, and number of its instances. Both are multiples of `BLOCK`.
    first: u32,
    instances: u32,
    // Number of levels, 1 to `OBJECT_LEVELS`.
    levels: u32,
    // Index of the word at which its first list begins in the lists of a view. Each list takes `instances` words.
    first_list: u32,
    // Index of its first draw in the draws of a view, and its number of parts. Each part has `OBJECT_LISTS` draws.
    first_draw: u32,
    parts: u32,
    // Factor of its metric, above 0: the LOD bias and, for errors, the fraction of the allowed displacement that levels may use.
    metric_scale: f32,
    // Flags word.
    flags: u32,
    // Threshold per level, ascending: the smallest metric at which the level is drawn. The first is 0. With a geomorph, it is
    // the metric at which the level begins to move towards the next one, and except for level 0, the level is drawn from there
    // on.
    thresholds: array<vec4<f32>, 2>,
    // Factors of the thresholds: of the levels up to the last frame's level, and of coarser ones. Between the two an instance
    // keeps its level (hysteresis), or fades from one level to the next.
    finer: f32,
    coarser: f32,
    // Steps per second of a fade that runs in time.
    rate: f32,
    // Strength of the perceptual factors of the metric: of motion in the picture, and of the distance from the picture's middle.
    motion: f32,
    // Middle of its box, or the point that distances are measured to, in model space.
    point: vec3<f32>,
    periphery: f32,
    // Half the size of its box along the model's axes.
    half_size: vec3<f32>,
    // Its rank among the objects that share a budget: 0 for the least important ones; `NO_RANK` if the budget spares it.
    rank: u32,
    // Metrics between which its instances fade out, with `TRANSITION_ALPHA`.
    fade_begin: f32,
    fade_end: f32,
    // Added to the metric in proportion to a budget's factor, so that the largest factor reaches every level, even from 0.
    metric_floor: f32,
    unused: u32,
    // Number of triangles per level, in units of the budget.
    triangles: array<vec4<u32>, 2>,
}

// The index of the list of visible instances at a level.
fn solid_list(level: u32, mirrored: u32) -> u32 {
    return 2u * level + mirrored;
}

// The index of the list of visible instances at a level that fade in or out.
fn fading_list(object: LodObject, level: u32, mirrored: u32) -> u32 {
    return 2u * (object.levels + level) + mirrored;
}

// The arguments of an indexed indirect draw.
struct SceneDraw {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
}
