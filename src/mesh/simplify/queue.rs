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

/// Each point's best collapse, cheapest first. Entries that no longer hold are left out when their turn comes.
pub struct Queue {
    heap: BinaryHeap<Reverse<(u64, u32, u32)>>,
    best: Vec<Option<Best>>,
    changes: Vec<u32>,
}

impl Queue {
    pub fn new(best: Vec<Option<Best>>) -> Self {
        let entries = (0_u32..).zip(&best).filter_map(|(point, best)| Some(entry(point, best.as_ref()?, 0)));
        Self { heap: entries.collect(), changes: vec![0; best.len()], best }
    }

    pub fn best(&self, point: u32) -> Option<&Best> {
        self.best[point as usize].as_ref()
    }

    /// Takes the place of what it was.
    pub fn set(&mut self, point: u32, best: Option<Best>) {
        let changes = &mut self.changes[point as usize];
        *changes = changes.wrapping_add(1);
        if let Some(best) = &best {
            self.heap.push(entry(point, best, *changes));
        }
        self.best[point as usize] = best;
    }

    /// The cheapest, the lower point first of two; it stays a point's best.
    pub fn pop(&mut self) -> Option<(u32, Best)> {
        while let Some(Reverse((_, point, change))) = self.heap.pop() {
            if self.changes[point as usize] == change
                && let Some(best) = self.best[point as usize]
            {
                return Some((point, best));
            }
        }
        None
    }
}

/// Numbers that are not negative are ordered as their bits are.
fn entry(point: u32, best: &Best, change: u32) -> Reverse<(u64, u32, u32)> {
    Reverse((best.cost.to_bits(), point, change))
}
