// Objects of a scene. All instances of one model share an object.
//
// Flags word of an object. `shown`: the object is visible. `never_culled`: its instances are also drawn outside the view
// volume. `timed`: its transition advances with time, not with the metric. `transition` is a constant of
// `wgsl/lod/transition.wgsl`, `criterion` a constant of `wgsl/lod/criterion.wgsl`.
// packed ObjectFlags: shown 1, never_culled 1, timed 1, transition 4, criterion 4
// Metric word of an instance in a view: the bits of its metric without the sign bit, and whether its placement mirrors.
// `UNSEEN_METRIC` means that the view does not see the instance.
// packed Metric: bits 31, mirrored 1
// Decision word of an instance in a view: its level, the level to which it changes (`next`), and the steps of the change. A
// geomorph takes up to `MORPH_STEPS` steps, a fade up to `FADE_PROGRESS`; 0 steps mean no change. The word is 0 if the instance
// is not visible.
// packed Decision: seen 1, mirrored 1, level 3, next 3, steps 16
// Entry of a list: the instance's index in its object, its level, and its steps. The steps are the progress of a geomorph, or a
// fade word.
// packed ListEntry: instance 20, level 3, steps 9
// Fade word: the weight of the instance, up to `FADE_STEPS`. If `rest` is 1, the instance covers the pixels that this weight
// leaves uncovered.
// packed Fade: weight 7, rest 1

// Largest number of levels of detail of an object, the finest included.
const OBJECT_LEVELS = 8u;
// Largest number of lists of an object in a view. Each level has four lists: unmirrored and mirrored instances, each without a
// fade (`solid_list`) and with a fade (`fading_list`).
const OBJECT_LISTS = 32u;
// Number of instances in a block. The instances of each object occupy whole blocks.
const BLOCK = 64u;
// Object index of a block that belongs to no object.
const NO_OBJECT = 0xffffffffu;

// Number of steps of a geomorph from one level to the next.
const MORPH_STEPS = 511u;
// Number of steps of a fade's weight in a list entry.
const FADE_STEPS = 127u;
// Number of steps of a fade in a decision word.
const FADE_PROGRESS = 65535u;

// Number of ranks, the importance classes of a triangle budget.
const RANKS = 8u;
// Rank of an object that a triangle budget never coarsens.
const NO_RANK = 8u;

// Metric word of an instance that the view does not see.
const UNSEEN_METRIC = 0xffffffffu;

// Level-of-detail settings of an object, and the location of its instances, lists and draws.
struct LodObject {
    // Index of the object's first instance in the scene, a multiple of `BLOCK`.
    first: u32,
    // Number of instances of the object, a multiple of `BLOCK`.
    instances: u32,
    // Number of levels of detail, 1 to `OBJECT_LEVELS`.
    levels: u32,
    // Index of the word at which the object's first list begins in a view's lists. Each list takes `instances` words.
    first_list: u32,
    // Index of the object's first draw in a view's draws. Each part of the object has `OBJECT_LISTS` draws.
    first_draw: u32,
    // Number of parts of the object, each with draws of its own.
    parts: u32,
    // Factor of the metric, above 0: the LOD bias. If the metric is the allowed displacement, the factor includes the fraction of
    // the displacement that levels may use.
    metric_scale: f32,
    // Flags word of the object, see `object_flags_word`.
    flags: u32,
    // Threshold per level, ascending: the smallest metric at which the level is drawn. Without a geomorph, the first threshold
    // is 0. With a geomorph, a level begins to move towards the next one at its threshold, so the first threshold is above 0.
    thresholds: array<vec4<f32>, 2>,
    // Factor for the thresholds of the last frame's level and of finer levels. While the metric is between a threshold times
    // `finer` and this threshold times `coarser`, an instance keeps its level (hysteresis), or fades from one level to the
    // next.
    finer: f32,
    // Factor for the thresholds of levels that are coarser than the last frame's level.
    coarser: f32,
    // Steps per second of a fade that runs in time; a whole fade has `FADE_PROGRESS` steps.
    rate: f32,
    // Relative growth of the metric with an instance's speed on screen, per picture height per second; 0 for none.
    motion: f32,
    // Middle of the model's box, or the point to which distances are measured, in model space.
    point: vec3<f32>,
    // Relative growth of the metric with an instance's distance from the picture's middle, per half picture height; 0 for none.
    periphery: f32,
    // Half the size of the model's box along the model's axes.
    half_size: vec3<f32>,
    // Rank of the object in a triangle budget: objects of rank 0 are coarsened first. `NO_RANK` if the budget spares the
    // object.
    rank: u32,
    // Metric at which instances begin to fade out, with `TRANSITION_ALPHA`.
    fade_begin: f32,
    // Metric at which instances have faded out, with `TRANSITION_ALPHA`.
    fade_end: f32,
    // Factor of a term that is added to the metric: `metric_floor` times (a budget's factor minus 1). With this term, the
    // largest factor reaches every level even from a metric of 0.
    metric_floor: f32,
    // Padding, not read.
    unused: u32,
    // Number of triangles per level, in units of the triangle budget.
    triangles: array<vec4<u32>, 2>,
}

// Index of the list of visible instances that are drawn at a level without a fade. `mirrored` is 1 for mirrored instances,
// else 0.
fn solid_list(level: u32, mirrored: u32) -> u32 {
    return 2u * level + mirrored;
}

// Index of the list of visible instances that fade in or out at a level. `mirrored` is 1 for mirrored instances, else 0.
fn fading_list(object: LodObject, level: u32, mirrored: u32) -> u32 {
    return 2u * (object.levels + level) + mirrored;
}

// The arguments of an indexed indirect draw.
struct SceneDraw {
    // Number of indices to draw.
    index_count: u32,
    // Number of instances to draw.
    instance_count: u32,
    // Index in the index buffer of the first index to draw.
    first_index: u32,
    // Number that is added to each index.
    base_vertex: u32,
    // Number of the first instance.
    first_instance: u32,
}
