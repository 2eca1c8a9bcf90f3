//! The priority queue of points, ordered by the cost of each point's best collapse.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The best collapse of a point: the neighbour, and the cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Best {
    pub neighbor: u32,
    /// The squared cost; at least 0.
    pub cost: f64,
    /// Whether a cheaper collapse exists that is not legal at the moment.
    pub is_second: bool,
}

/// An entry of the heap: cost, point, and the number of the point's change that made the entry.
type Entry = Reverse<(u64, u32, u32)>;

/// The best collapse of each point, cheapest first. Stale entries are dropped when they reach the top, or when
/// they are in the majority.
pub struct Queue {
    heap: BinaryHeap<Entry>,
    best: Vec<Option<Best>>,
    changes: Vec<u32>,
    /// Number of points that have a best collapse.
    waiting: usize,
}

impl Queue {
    pub fn new(best: Vec<Option<Best>>) -> Self {
        let entries = (0_u32..).zip(&best).filter_map(|(point, best)| Some(entry(point, best.as_ref()?, 0)));
        let heap: BinaryHeap<_> = entries.collect();
        Self { waiting: heap.len(), heap, changes: vec![0; best.len()], best }
    }

    pub fn best(&self, point: u32) -> Option<&Best> {
        self.best[point as usize].as_ref()
    }

    /// Replaces the best collapse of a point.
    pub fn set(&mut self, point: u32, best: Option<Best>) {
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

    /// The cheapest collapse; of equal ones, that of the lower point. The point keeps it as its best, and the
    /// caller must set it again.
    pub fn pop(&mut self) -> Option<(u32, Best)> {
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

/// The bits of non-negative floats have the order of the floats.
fn entry(point: u32, best: &Best, change: u32) -> Entry {
    Reverse((best.cost.to_bits(), point, change))
}
