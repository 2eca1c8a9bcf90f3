//! Instance lists of a view: for each object and level of detail, a list of unmirrored instances and one of mirrored
//! ones, in ascending order, the same on every run. Objects whose transition fades have as many lists again, for instances
//! that fade in or out.
//!
//! [`decide`](super::decide) counts the instances of each block in each list. Prefix sums of the counts give the
//! position at which a block begins. Inside a block the order is that of the instances, so no order depends on thread
//! scheduling. The totals are the instance counts of the object's draws.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{ListBuffers, ListPass};

use super::{LodObject, OBJECT_LISTS};
use crate::shared::lod::object::object_flags_transition;
use crate::shared::lod::transition::TRANSITION_DITHER;

impl LodObject {
    /// Number of the object's lists: 2 per level, and as many for instances that fade.
    pub fn lists(&self) -> u32 {
        if self.fades() { 4 * self.levels } else { 2 * self.levels }
    }

    /// Whether instances may fade in and out.
    pub fn fades(&self) -> bool {
        object_flags_transition(self.flags) >= TRANSITION_DITHER
    }

    /// Size of the object's lists in words.
    pub fn list_words(&self) -> u32 {
        self.lists() * self.instances
    }

    /// First word of a list in a view's list buffer. The list of a level is 2 · level + mirrored; that of its instances that
    /// fade lies 2 · levels behind.
    pub fn list_begin(&self, list: u32) -> u32 {
        self.first_list + list * self.instances
    }

    /// The index of the draw of a part and list among a view's draws.
    pub fn draw(&self, part: u32, list: u32) -> u32 {
        self.first_draw + OBJECT_LISTS * part + list
    }
}
