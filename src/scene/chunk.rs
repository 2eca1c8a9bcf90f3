//! Chunks of an object: consecutive instances that lie in buffers of their own and are listed and drawn together. An object
//! has one chunk, unless what its instances need exceeds a binding of the device.

use std::ops::Range;

use crate::scene::drawable::Drawable;
use crate::scene::layout::ObjectRange;
use crate::shared::lod::object::{BLOCK, LodObject};

/// A chunk of an object.
#[derive(Debug)]
pub(crate) struct Chunk {
    /// The indices in the object of its instances.
    pub slots: Range<usize>,
    /// Its number among the chunks of the layout.
    pub number: usize,
    pub range: ObjectRange,
    /// What is drawn, part by part.
    pub drawables: Vec<Box<dyn Drawable>>,
    /// For each drawable, the chunk as kernels see it, with the draws of the drawable's parts, in the layout for which it
    /// was prepared.
    pub lods: Vec<LodObject>,
    /// Its parts that are drawn instance by instance.
    pub sorted: Vec<SortedParts>,
}

/// A part of an object that is drawn instance by instance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SortedParts {
    /// The drawable, and the part of it.
    pub drawable: usize,
    pub part: usize,
    /// The index of the draw of the first instance.
    pub first: u32,
}

impl Chunk {
    /// A chunk that no layout has yet.
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

    /// Number of instances for which it has room in the buffers of all instances: whole blocks.
    pub fn room(&self) -> u32 {
        (self.slots.len() as u32).next_multiple_of(BLOCK)
    }

    /// The index in the buffers of all instances of one of its instances.
    pub fn place(&self, slot: usize) -> usize {
        self.range.first as usize + slot - self.slots.start
    }
}

/// What two ranges have in common, if that is anything.
pub(crate) fn common(a: &Range<usize>, b: &Range<usize>) -> Option<Range<usize>> {
    let both = a.start.max(b.start)..a.end.min(b.end);
    (!both.is_empty()).then_some(both)
}

/// A range in halves until each part fits; a part of one element fits always.
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
