//! The lists of instances that a view draws: for each object and level of detail one of those that are not mirrored and
//! one of those that are, in ascending order, the same on every run.
//!
//! [`select`](super::select) counts the instances of each block in each list. Prefix sums of these counts say where the
//! instances of a block begin, and the order inside a block is that of the instances, so that no order depends on which
//! thread came first. The totals are the numbers of instances of the object's draws.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{ListBuffers, ListPass};

use super::{LodObject, OBJECT_LISTS};

impl LodObject {
    /// The number of words of its lists.
    pub fn list_words(&self) -> u32 {
        OBJECT_LISTS * self.instances
    }

    /// The word at which a list begins in the lists of a view. The list of a level is 2 · level + mirrored.
    pub fn list_begin(&self, list: u32) -> u32 {
        self.first_list + list * self.instances
    }

    /// The index of the draw of a part's list in the draws of a view.
    pub fn draw(&self, part: u32, list: u32) -> u32 {
        self.first_draw + OBJECT_LISTS * part + list
    }
}
