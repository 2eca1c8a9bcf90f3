//! Instance lists of a view. Each object has two lists per level of detail: one of unmirrored instances and one of mirrored
//! instances. Instances are in ascending order, the same on every run. Objects whose transition fades have two more lists per
//! level, for instances that fade in or out.
//!
//! [`decide`](super::decide) counts the instances of each block in each list. Prefix sums of the counts give the position at
//! which a block's instances begin in a list. Inside a block, instances keep their order, so the result does not depend on thread
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
    /// Number of the object's lists: 2 per level, and 2 more per level for instances that fade.
    pub fn lists(&self) -> u32 {
        if self.fades() { 4 * self.levels } else { 2 * self.levels }
    }

    /// Whether instances may fade in and out.
    pub fn fades(&self) -> bool {
        object_flags_transition(self.flags) >= TRANSITION_DITHER
    }

    /// Size of all lists of the object, in words.
    pub fn list_words(&self) -> u32 {
        self.lists() * self.instances
    }

    /// Index of a list's first word in a view's list buffer. `list` is 2 · level + mirrored, where mirrored is 0 or 1. For fading
    /// instances, add 2 · [`LodObject::levels`].
    pub fn list_begin(&self, list: u32) -> u32 {
        self.first_list + list * self.instances
    }

    /// Index of a draw among a view's draws, for one part of the object and one list.
    pub fn draw(&self, part: u32, list: u32) -> u32 {
        self.first_draw + OBJECT_LISTS * part + list
    }
}
