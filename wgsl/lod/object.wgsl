// Objects of a scene: what all instances of one model share.

// The largest number of levels of detail of an object, the finest included.
const OBJECT_LEVELS = 8u;
// The lists of an object in a view: for each level one of the instances that are not mirrored, and one of those that are.
const OBJECT_LISTS = 16u;
// The number of instances in a block. The instances of an object take whole blocks.
const BLOCK = 64u;
// What stands for the object of a block that belongs to none.
const NO_OBJECT = 0xffffffffu;

// Whether an object is visible as a whole, how its levels change (`wgsl/lod/transition.wgsl`), and what chooses them
// (`wgsl/lod/criterion.wgsl`).
// packed ObjectFlags: shown 1, transition 7, criterion 8
// How far an instance has moved from its level to the next coarser one: the level and the steps. 0: no morph.
// packed Morph: level 3, steps 9
// Number of steps from a level to the next one.
const MORPH_STEPS = 511u;
// A view's decision for an instance: 1 + its list, and its morph word. 0: not seen.
// packed Decision: list 8, morph 12
// An entry of a list: the instance, counted from the object's first one, and its morph word.
// packed ListEntry: instance 20, morph 12

// How the instances of an object are selected and listed.
struct LodObject {
    // The index of its first instance, and the number of its instances, multiples of `BLOCK`.
    first: u32,
    instances: u32,
    // Number of levels, 1 to `OBJECT_LEVELS`.
    levels: u32,
    // The word at which its first list begins in the lists of a view. List 2 · level + mirrored begins `instances` words
    // after the one before.
    first_list: u32,
    // The index of its first draw in the draws of a view, and its number of parts. The draws of each part are
    // one for each list.
    first_draw: u32,
    parts: u32,
    // The fraction of the allowed displacement that its levels of detail may use, 0 to 1.
    mesh_fraction: f32,
    // Whether it is visible, its transition and its criterion: an object flags word.
    flags: u32,
    // For each level the metric from which on it is drawn, ascending: the error in the model's units, 0 for level 0. If levels
    // move into each other, the metric from which on each begins to move, which for all but level 0 is also that from which on
    // it is drawn.
    errors: array<vec4<f32>, 2>,
}

// The arguments of an indexed indirect draw.
struct SceneDraw {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
}
