//! Instance lists of a view: for each object and level of detail, a list of unmirrored instances and one of mirrored
//! ones, in ascending order, the same on every run.
//!
//! [`select`](super::select) counts the instances of each block in each list. Prefix sums of the counts give the
//! position at which a block begins. Inside a block the order is that of the instances, so no order depends on thread
//! scheduling. The totals are the instance counts of the object's draws.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{ListBuffers, ListPass};

use super::{LodObject, OBJECT_LISTS};

impl LodObject {
    /// Size of the object's lists in words.
    pub fn list_words(&self) -> u32 {
        OBJECT_LISTS * self.instances
    }

    /// First word of a list in a view's list buffer. The list of a level is 2 · level + mirrored.
    pub fn list_begin(&self, list: u32) -> u32 {
        self.first_list + list * self.instances
    }

    /// The index of the draw of a part and list among a view's draws.
    pub fn draw(&self, part: u32, list: u32) -> u32 {
        self.first_draw + OBJECT_LISTS * part + list
    }
}
