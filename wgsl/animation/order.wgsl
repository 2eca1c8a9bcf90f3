// What stands in place of a parent where bones are walked, parents first.

// The parent of a root.
const NO_PARENT: u32 = 0xffffffffu;
// The parent's bone is the slot before.
const CONTINUES: u32 = 0xfffffffeu;
