//! Bones updated since skinning last followed them, for any number of readers.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::gpu::{Buffer, Gpu, GpuError};

/// Bit mask of the bones whose model matrices were updated: one bit per slot of each instance, in
/// [`Order::words`](super::order::Order::words) words per instance. If a bone's bit is set, so are the bits of all bones below
/// it.
///
/// Kernels set bits, and the bits accumulate until all readers have followed the matrices. A frame may therefore skip skinning.
///
/// Each consumer of the matrices is a reader ([`UpdatedBones::reader`]). Every [`SkinFrame`](crate::skinning::frame::SkinFrame)
/// and [`PagedSkin`](crate::skinning::paged::PagedSkin) is a reader by itself. The reader that is the last to be recorded after
/// an update clears the bits. Until then, a reader that is recorded again sees all bits once more: it does too much work, never
/// too little. Readers that take turns, each skipping the other's frames, never clear the bits. A reader that is never recorded
/// blocks clearing, too: drop it.
///
/// The order of recording counts. Submit encoders in the order in which they were recorded. If an encoder with some of the
/// readers is not submitted while other readers clear the bits, prepare the skinning of its readers anew. Clones share
/// bits and readers.
#[derive(Debug, Clone)]
pub struct UpdatedBones {
    bits: Buffer<u32>,
    readers: Arc<Mutex<Readers>>,
}

/// A reader of updated bones. It counts until it is dropped.
#[derive(Debug)]
pub struct UpdatedBonesReader {
    number: u64,
    updated: UpdatedBones,
}

/// The registered readers, by number.
#[derive(Debug, Default)]
struct Readers {
    next: u64,
    all: BTreeSet<u64>,
    /// Readers that were not recorded since the last update.
    behind: BTreeSet<u64>,
}

impl Readers {
    fn add(&mut self) -> u64 {
        self.next += 1;
        self.all.insert(self.next);
        self.behind.insert(self.next);
        self.next
    }

    fn update(&mut self) {
        self.behind.clone_from(&self.all);
    }

    /// Marks a reader as recorded. Returns whether no reader is behind any more.
    fn read(&mut self, number: u64) -> bool {
        self.behind.remove(&number);
        self.behind.is_empty()
    }

    fn remove(&mut self, number: u64) {
        self.all.remove(&number);
        self.behind.remove(&number);
    }
}

impl UpdatedBones {
    /// Allocates `words` words. No bone is updated at first.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, words: usize) -> Result<Self, GpuError> {
        Ok(Self::over(Buffer::new(gpu, "updated bones", words)?))
    }

    /// Uses the bits in a buffer that nothing else reads or clears.
    pub fn over(bits: Buffer<u32>) -> Self {
        Self { bits, readers: Arc::default() }
    }

    /// Buffer with the bits, to bind. Code that records work which sets bits must then call [`UpdatedBones::update`];
    /// [`CompactJob`](super::compact::CompactJob) does so itself.
    pub fn bits(&self) -> &Buffer<u32> {
        &self.bits
    }

    /// Tells readers that work recorded or written now sets bits. All readers are then behind.
    pub fn update(&self) {
        self.lock().update();
    }

    /// Replaces the first words, and notifies readers.
    ///
    /// # Errors
    /// [`GpuError`], also for more words than there are.
    pub fn write(&self, gpu: &Gpu, words: &[u32]) -> Result<(), GpuError> {
        self.update();
        self.bits.write(gpu, words)
    }

    /// Adds a reader, which has not read the present bits yet.
    pub fn reader(&self) -> UpdatedBonesReader {
        UpdatedBonesReader { number: self.lock().add(), updated: self.clone() }
    }

    /// Ignores poisoning: a thread that panics leaves the set of readers consistent.
    fn lock(&self) -> MutexGuard<'_, Readers> {
        self.readers.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl UpdatedBonesReader {
    /// Reports that the work recorded now reads the bits. Returns whether this work must clear them afterwards, because no
    /// reader is behind any more.
    #[must_use = "the last reader clears the bits"]
    pub fn read(&self) -> bool {
        self.updated.lock().read(self.number)
    }
}

impl Drop for UpdatedBonesReader {
    fn drop(&mut self) {
        self.updated.lock().remove(self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_reader_after_an_update_clears() {
        let mut readers = Readers::default();
        let (a, b) = (readers.add(), readers.add());
        assert!(!readers.read(a) && readers.read(b));
        // Without an update, clearing again loses nothing.
        assert!(readers.read(a));
        readers.update();
        assert!(!readers.read(a));
        // The first reader has read the bits before this update, so it is behind again.
        readers.update();
        assert!(!readers.read(b) && !readers.read(b) && readers.read(a));
        // Readers that take turns never clear.
        for turn in 0..4 {
            readers.update();
            assert!(!readers.read(if turn % 2 == 0 { a } else { b }));
        }
        // A new reader is behind; a dropped reader blocks nobody.
        let c = readers.add();
        readers.update();
        assert!(!readers.read(a) && !readers.read(c));
        readers.remove(b);
        assert!(readers.read(c));
        readers.update();
        assert!(!readers.read(c) && readers.read(a));
    }
}
