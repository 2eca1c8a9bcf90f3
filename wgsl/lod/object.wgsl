// Objects of a scene: what all instances of one model share.

// The largest number of levels of detail of an object, the finest included.
const OBJECT_LEVELS = 8u;
// The lists of an object in a view: for each level one of the instances that are not mirrored, and one of those that are.
const OBJECT_LISTS = 16u;
// The number of instances in a block. The instances of an object take whole blocks.
const BLOCK = 64u;
// What stands for the object of a block that belongs to none.
const NO_OBJECT = 0xffffffffu;

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
    // The visibility of the object as a whole: 0 hides it.
    shown: u32,
    // The error of each level in the model's units, ascending from 0.
    errors: array<vec4<f32>, 2>,
}

// The arguments of an indexed indirect draw.
struct SceneDraw {
    indices: u32,
    instances: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
}
