//! Chunks of an object: consecutive instances with their own buffers, lists and draws. An object has one chunk, unless its
//! instances need more than a binding of the device.

use std::ops::Range;

use crate::scene::drawable::Drawable;
use crate::scene::layout::ObjectRange;
use crate::shared::lod::object::{BLOCK, LodObject};

/// A chunk of an object.
#[derive(Debug)]
pub(crate) struct Chunk {
    /// Indices of its instances within the object.
    pub slots: Range<usize>,
    /// Its index among the chunks of the layout.
    pub number: usize,
    pub range: ObjectRange,
    /// The drawables, part by part.
    pub drawables: Vec<Box<dyn Drawable>>,
    /// Per drawable: the chunk in kernel format with the draws of the drawable's parts, in the layout it was prepared for.
    pub lods: Vec<LodObject>,
    /// Its parts with sorted draws.
    pub sorted: Vec<SortedParts>,
}

/// A part of an object with sorted draws.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SortedParts {
    /// Index of the drawable.
    pub drawable: usize,
    /// Index of the part in the drawable.
    pub part: usize,
    /// Index of the first instance's draw.
    pub first: u32,
}

impl Chunk {
    /// A chunk that is not in a layout yet.
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

    /// Number of instances reserved in the scene's instance buffers: whole blocks.
    pub fn room(&self) -> u32 {
        (self.slots.len() as u32).next_multiple_of(BLOCK)
    }

    /// Index of one of its instances in the scene's instance buffers.
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
