//! Which point goes next: the one whose best collapse is cheapest.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// What a point had best become.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Best {
    pub neighbor: u32,
    /// Not below 0.
    pub cost: f64,
    /// Whether something cheaper is not legal as things are.
    pub is_second: bool,
}

/// An entry of the heap: cost, point, and the point's change that made it.
type Entry = Reverse<(u64, u32, u32)>;

/// Each point's best collapse, cheapest first. Entries that no longer hold are left out when their turn comes, or when
/// they are most of all.
pub struct Queue {
    heap: BinaryHeap<Entry>,
    best: Vec<Option<Best>>,
    changes: Vec<u32>,
    /// How many points have a best.
    waiting: usize,
}

impl Queue {
    pub fn new(best: Vec<Option<Best>>) -> Self {
        let entries = (0_u32..).zip(&best).filter_map(|(point, best)| Some(entry(point, best.as_ref()?, 0)));
        let heap: BinaryHeap<_> = entries.collect();
        Self { waiting: heap.len(), heap, changes: vec![0; best.len()], best }
    }

    pub(crate) fn best(&self, point: u32) -> Option<&Best> {
        self.best[point as usize].as_ref()
    }

    /// Takes the place of what it was.
    pub(crate) fn set(&mut self, point: u32, best: Option<Best>) {
        let before = &mut self.best[point as usize];
        self.waiting = self.waiting + usize::from(best.is_some()) - usize::from(before.is_some());
        *before = best;
        let change = &mut self.changes[point as usize];
        *change = change.wrapping_add(1);
        if let Some(best) = &best {
            self.heap.push(entry(point, best, *change));
        }
        if self.heap.len() > 2 * self.waiting + 64 {
            let Self { heap, best, changes, .. } = self;
            heap.retain(|entry| holds(entry, best, changes));
        }
    }

    /// The cheapest, the lower point first of two. It stays the point's best, and has to be set again.
    pub(crate) fn pop(&mut self) -> Option<(u32, Best)> {
        while let Some(entry) = self.heap.pop() {
            let Reverse((_, point, _)) = entry;
            if holds(&entry, &self.best, &self.changes)
                && let Some(best) = self.best[point as usize]
            {
                return Some((point, best));
            }
        }
        None
    }
}

fn holds(&Reverse((_, point, change)): &Entry, best: &[Option<Best>], changes: &[u32]) -> bool {
    changes[point as usize] == change && best[point as usize].is_some()
}

/// Numbers that are not negative are ordered as their bits are.
fn entry(point: u32, best: &Best, change: u32) -> Entry {
    Reverse((best.cost.to_bits(), point, change))
}
