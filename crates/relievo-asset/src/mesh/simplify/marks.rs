//! Marks on points or vertices: numbers that can be cleared quickly.

/// A sparse map from indices to numbers that can be cleared in constant time.
pub(crate) struct Marks {
    current: u32,
    stamps: Vec<u32>,
    values: Vec<u32>,
}

impl Marks {
    pub(crate) fn new(count: usize) -> Self {
        Self { current: 0, stamps: vec![0; count], values: vec![0; count] }
    }

    /// Removes all marks.
    pub(crate) fn clear(&mut self) {
        if self.current == u32::MAX {
            self.stamps.fill(0);
            self.current = 0;
        }
        self.current += 1;
    }

    pub(crate) fn get(&self, at: u32) -> Option<u32> {
        (self.stamps[at as usize] == self.current).then(|| self.values[at as usize])
    }

    pub(crate) fn set(&mut self, at: u32, value: u32) {
        self.stamps[at as usize] = self.current;
        self.values[at as usize] = value;
    }

    /// Marks an index with 0. Returns whether it had no mark before.
    pub(crate) fn insert(&mut self, at: u32) -> bool {
        let is_new = self.get(at).is_none();
        self.set(at, 0);
        is_new
    }
}
