// Objects of a scene. All instances of one model share an object.

// The largest number of levels of detail of an object, the finest included.
const OBJECT_LEVELS = 8u;
// Number of lists of an object in a view: per level, one of instances that are not mirrored and one of mirrored instances.
const OBJECT_LISTS = 16u;
// Number of instances in a block. Each object takes whole blocks.
const BLOCK = 64u;
// Object index of a block that belongs to no object.
const NO_OBJECT = 0xffffffffu;

// Flags of an object: whether it is visible as a whole, its transition (`wgsl/lod/transition.wgsl`), and its criterion
// (`wgsl/lod/criterion.wgsl`).
// packed ObjectFlags: shown 1, transition 7, criterion 8
// Morph word: the level of an instance, and its steps towards the next coarser level. 0: no morph.
// packed Morph: level 3, steps 9
// Number of steps from one level to the next.
const MORPH_STEPS = 511u;
// A view's decision for a visible instance: 1 + its list, and its morph word. 0: not visible.
// packed Decision: list 8, morph 12
// An entry of a list: the instance's index, counted from the object's first one, and its morph word.
// packed ListEntry: instance 20, morph 12

// How the instances of an object are selected and listed.
struct LodObject {
    // Index of its first instance, and number of its instances. Both are multiples of `BLOCK`.
    first: u32,
    instances: u32,
    // Number of levels, 1 to `OBJECT_LEVELS`.
    levels: u32,
    // Index of the word at which its first list begins in the lists of a view. Each list takes `instances` words. The list of a
    // level has the index 2 · level + mirrored.
    first_list: u32,
    // Index of its first draw in the draws of a view, and its number of parts. Each part has one draw per list.
    first_draw: u32,
    parts: u32,
    // Fraction of the allowed displacement that its levels of detail may use, 0 to 1.
    mesh_fraction: f32,
    // Flags word: visibility, transition and criterion.
    flags: u32,
    // Threshold per level, ascending: the smallest metric at which the level is drawn. It is the error in model units, 0 for
    // level 0. With a geomorph, it is the metric at which the level begins to move towards the next one. Except for level 0,
    // the level is also drawn from there on.
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
