// The order in which bones are walked, parents first, split into chains.

// The place of a bone in the order.
struct Slot {
    // The bone.
    bone: u32,
    // The parent bone, CONTINUES or NO_PARENT.
    parent: u32,
    // Number of slots of the bone and all bones below it, starting with this one.
    subtree: u32,
}

// A run of slots from parent to child.
struct Chain {
    // Index of the first slot.
    first: u32,
    // Number of slots.
    count: u32,
}

// The parent of a root.
const NO_PARENT: u32 = 0xffffffffu;
// The parent's bone is the slot before.
const CONTINUES: u32 = 0xfffffffeu;
