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
