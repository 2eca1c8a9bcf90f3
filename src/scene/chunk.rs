//! Chunks of an object: consecutive instances with their own buffers, lists and draws. An object has one chunk, unless the
//! buffers of its instances would exceed the device's largest buffer binding.

use std::ops::Range;

use crate::scene::drawable::Drawable;
use crate::scene::layout::ObjectRange;
use crate::shared::lod::object::{BLOCK, LodObject};

/// A chunk of an object: consecutive instances that are drawn together.
#[derive(Debug)]
pub(crate) struct Chunk {
    /// Range of the chunk's instances in the object's instance array.
    pub slots: Range<usize>,
    /// Index of the chunk among all chunks of the layout.
    pub number: usize,
    pub range: ObjectRange,
    /// The drawables of the chunk, each with one or more parts.
    pub drawables: Vec<Box<dyn Drawable>>,
    /// Per drawable: the chunk in device format, with the range of the drawable's draws. Valid until the next layout.
    pub lods: Vec<LodObject>,
    /// The chunk's parts whose instances are drawn one by one, from back to front.
    pub sorted: Vec<SortedParts>,
}

/// A part of a drawable whose instances are drawn one by one, from back to front.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SortedParts {
    /// Index of the drawable.
    pub drawable: usize,
    /// Index of the part in the drawable.
    pub part: usize,
    /// Index of the part's draw for the chunk's first instance. The draws for the other instances follow in order.
    pub first: u32,
}

impl Chunk {
    /// A chunk that does not belong to a layout yet.
    pub fn new(slots: Range<usize>, drawables: Vec<Box<dyn Drawable>>) -> Self {
        Self {
            slots,
            number: 0,
            range: ObjectRange::default(),
            drawables,
            lods: Vec::new(),
            sorted: Vec::new(),
        }
    }

    /// Number of entries that the chunk takes in the scene's instance buffers: its instances, rounded up to a multiple of
    /// [`BLOCK`].
    pub fn room(&self) -> u32 {
        (self.slots.len() as u32).next_multiple_of(BLOCK)
    }

    /// Converts the index `slot` of an instance in the object to the index in the scene's instance buffers. The instance
    /// must belong to the chunk.
    pub fn place(&self, slot: usize) -> usize {
        self.range.first as usize + slot - self.slots.start
    }
}

/// The intersection of two ranges; `None` if it is empty.
pub(crate) fn common(a: &Range<usize>, b: &Range<usize>) -> Option<Range<usize>> {
    let both = a.start.max(b.start)..a.end.min(b.end);
    (!both.is_empty()).then_some(both)
}

/// Halves a range until every part fits. A part of one element always counts as fitting.
pub(super) fn halved(all: Range<usize>, fits: impl Fn(&Range<usize>) -> bool) -> Vec<Range<usize>> {
    let (mut open, mut done) = (vec![all], Vec::new());
    while let Some(range) = open.pop() {
        if range.len() < 2 || fits(&range) {
            done.push(range);
        } else {
            let middle = range.start + range.len() / 2;
            open.extend([middle..range.end, range.start..middle]);
        }
    }
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_halved_until_they_fit() {
        let weights = [1, 1, 1, 1, 9, 1, 1, 1];
        let fits = |range: &Range<usize>| weights[range.clone()].iter().sum::<u32>() <= 4;
        assert_eq!(halved(0..8, fits), [0..4, 4..5, 5..6, 6..8]);
        assert_eq!(halved(2..5, |_| true), std::iter::once(2..5).collect::<Vec<_>>());
        assert_eq!(halved(0..3, |_| false).len(), 3);
    }

    #[test]
    fn ranges_have_something_in_common_or_nothing() {
        assert_eq!(common(&(0..5), &(3..9)), Some(3..5));
        assert_eq!(common(&(0..5), &(5..9)), None);
        assert_eq!(common(&(2..3), &(0..9)), Some(2..3));
    }
}
